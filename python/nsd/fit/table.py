"""Evaluations of a problem: each runs the command once, and is a line of a table as soon as it has ended.

The points of a batch follow from the lines of earlier batches in the order of their numbers, so that a run that goes on
after a kill, or with another number of processes, makes the same table. What the evaluations cost is in a table of its own.
"""
from __future__ import annotations

import concurrent.futures
import json
import math
import os
import signal
import subprocess
import tempfile
import threading
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .problem import Invalid, Problem

ANSWER = 1 << 20  # bytes that a command may write


@dataclass
class Row:
    evaluation: int
    seed: int
    values: list[float]
    measures: list[float]  # nan: it failed
    failed: str = ""
    cpu: float = 0  # s, of this process' evaluations


class Table:
    def __init__(self, path: str, problem: Problem):
        """Reads what there is; raises Invalid."""
        self.path, self.times, self.problem = path, os.path.join(os.path.dirname(path), "times.tsv"), problem
        self.rows: dict[int, Row] = {}
        self.head = f"# nsd-fit 1 {problem.digest}\n"
        self.columns = ["evaluation", "seed", *(p.name for p in problem.parameters), *(t.name for t in problem.targets), "failed"]
        self._lock = threading.Lock()
        self._read()

    def _text(self, row: Row) -> str:
        return "\t".join([str(row.evaluation), str(row.seed), *map(repr, row.values), *map(repr, row.measures), row.failed])

    def _read(self) -> None:
        try:
            with open(self.path, encoding="utf-8") as f:
                text = f.read()
        except FileNotFoundError:
            return
        except (OSError, UnicodeDecodeError) as e:
            raise Invalid(f"{self.path}: {e}", 66) from None
        lines = text.split("\n")[:-1]  # a line without an end was being written
        if lines[:1] != [self.head.strip()] or (len(lines) > 1 and lines[1] != "\t".join(self.columns)):
            raise Invalid(f"{self.path}: a table of another problem: name another folder with -o, or remove it")
        for k, line in enumerate(lines[2:], 3):
            row = self._parse(line)
            if row is None or row.evaluation in self.rows:
                raise Invalid(f"{self.path}: line {k} is damaged")
            self.rows[row.evaluation] = row

    def _parse(self, line: str) -> Row | None:
        field, d, t = line.split("\t"), len(self.problem.parameters), len(self.problem.targets)
        if len(field) != len(self.columns):
            return None
        try:
            row = Row(int(field[0]), int(field[1]), [float(x) for x in field[2:2 + d]], [float(x) for x in field[2 + d:2 + d + t]], field[-1])
        except ValueError:
            return None
        good = row.evaluation >= 0 and all(map(math.isfinite, row.values)) and bool(row.failed) != all(map(math.isfinite, row.measures))
        return row if good else None

    def write(self) -> None:
        """All lines in the order of their numbers, in place of the file."""
        text = self.head + "\t".join(self.columns) + "\n" + "".join(self._text(self.rows[k]) + "\n" for k in sorted(self.rows))
        replace(self.path, text)

    def add(self, row: Row) -> None:
        with self._lock:
            self.rows[row.evaluation] = row
            with open(self.path, "a", encoding="utf-8") as f:
                f.write(self._text(row) + "\n")
                f.flush()
                os.fsync(f.fileno())
            with open(self.times, "a", encoding="utf-8") as f:
                f.write(f"{row.evaluation}\t{row.cpu:.3f}\n")

    def cpu(self) -> float:
        """s: of all evaluations, also those of a run that was killed."""
        try:
            with open(self.times, encoding="utf-8") as f:
                return sum(float(line.split("\t")[1]) for line in f if line.endswith("\n"))
        except (OSError, ValueError, IndexError):
            return 0.0

    def good(self, n: int) -> tuple[np.ndarray, np.ndarray]:
        """Values and measures of the first n evaluations, but for those that failed."""
        rows = [self.rows[k] for k in range(n) if k in self.rows and not self.rows[k].failed]
        return np.array([r.values for r in rows]), np.array([r.measures for r in rows])


def replace(path: str, text: str) -> None:
    new = path + ".new"
    with open(new, "w", encoding="utf-8") as f:
        f.write(text)
        f.flush()
        os.fsync(f.fileno())
    os.replace(new, path)


class Runner:
    """Runs commands, a number of them at a time."""

    def __init__(self, problem: Problem, jobs: int, seconds: float | None):
        self.problem, self.jobs, self.seconds = problem, jobs, seconds
        self._running: set[subprocess.Popen[bytes]] = set()
        self._stopped = False

    def stop(self) -> None:
        self._stopped = True
        for p in list(self._running):
            kill(p)

    def run(self, points: dict[int, list[float]], done: Callable[[Row], None]) -> None:
        """Evaluates the points, number: values; done() has each as soon as it is there."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            waiting = [pool.submit(self._one, k, values) for k, values in points.items()]
            for each in concurrent.futures.as_completed(waiting):
                row = each.result()
                if row is not None and not self._stopped:
                    done(row)

    def _one(self, k: int, values: list[float]) -> Row | None:
        if self._stopped:
            return None
        problem, seed = self.problem, self.problem.seed + k
        with tempfile.TemporaryDirectory(prefix="nsd-fit.") as work:
            with open(os.path.join(work, "scene.json"), "w", encoding="utf-8") as f:
                json.dump(problem.scene_with(values, seed), f, indent=1)
            environment = dict(os.environ, NSD_FIT_WORK=work, NSD_FIT_SEED=str(seed), NSD_FIT_EVALUATION=str(k))
            with open(f.name, "rb") as scene, tempfile.TemporaryFile() as answer, tempfile.TemporaryFile() as errors:
                p = subprocess.Popen(["bash", "-o", "pipefail", "-c", problem.command], stdin=scene, stdout=answer, stderr=errors,
                                     cwd=problem.folder, env=environment, start_new_session=True)
                self._running.add(p)
                late = threading.Timer(self.seconds or 1e7, kill, [p])
                late.daemon = True
                late.start()
                _, status, usage = os.wait4(p.pid, 0)
                p.returncode = os.waitstatus_to_exitcode(status)
                was_late = not late.is_alive()
                late.cancel()
                self._running.discard(p)
                answer.seek(0)
                errors.seek(0)
                text, said = answer.read(ANSWER + 1), errors.read(ANSWER).decode(errors="replace")
        cpu, t = usage.ru_utime + usage.ru_stime, len(problem.targets)
        try:
            if was_late:
                raise Invalid(f"not done after {self.seconds:g} s")
            if p.returncode:
                lines = [" ".join(line.split())[:200] for line in said.strip().split("\n")]
                raise Invalid(f"status {p.returncode}: {' ... '.join(dict.fromkeys([lines[0], lines[-1]]))}".rstrip(": "))
            return Row(k, seed, values, measures_of(text, problem), "", cpu)
        except Invalid as e:
            return Row(k, seed, values, [math.nan] * t, str(e).replace("\t", " "), cpu)


def kill(p: subprocess.Popen[bytes]) -> None:
    try:
        os.killpg(p.pid, signal.SIGKILL)
    except OSError:
        pass


def measures_of(text: bytes, problem: Problem) -> list[float]:
    """From an object with a number for each target, or of one target the number."""
    try:
        answer = json.loads(text[:ANSWER])
    except (ValueError, RecursionError):
        raise Invalid("the command writes no JSON object") from None
    names = [t.name for t in problem.targets]
    if not isinstance(answer, dict):
        if len(names) > 1:
            raise Invalid("the command writes no JSON object")
        answer = {names[0]: answer}
    found = []
    for name in names:
        x = answer.get(name)
        if isinstance(x, bool) or not isinstance(x, (int, float)) or not math.isfinite(x):
            raise Invalid(f"the command writes no number '{name}'")
        found.append(float(x))
    return found
