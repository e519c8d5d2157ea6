"""The command line of nsd-fit."""
from __future__ import annotations

import argparse
import os
import re
import signal
import sys
import time
from typing import NoReturn

from .problem import Invalid, Problem, read
from .table import Row, Runner, Table

STEADY = 0.1  # of its width: how far an interval's ends may move from batch to batch
LEAST_GOOD = 0.5  # of a batch


HELP = """usage: nsd-fit [OPTION ...] PROBLEM.json

Finds the parameters of a scene with which a command repeats measurements: it runs the
command for sets of parameters, keeps each in a table, and ends with the best values, their
90 % intervals and what the targets cannot determine. The same command line continues a run
that was stopped.

  -j, --jobs N                  run N evaluations at a time [number of processors]
  -n, --evaluations N           stop after N evaluations [of PROBLEM.json, or 60 per parameter]
  -o, --output FOLDER           write into FOLDER, and continue the run in it [PROBLEM.fit]
      --timeout S               end an evaluation after S seconds of real time [never]
      --quiet                   write no progress

      --help                    print this text
      --version                 print the version

Examples:
  nsd-fit -j 2 drum.json && jq .parameters drum.fit/result.json

The manual: man nsd-fit, man 7 nsd
"""


def completion(shell: str) -> str:
    """For bash or zsh, made from HELP."""
    found = re.findall(r"^ {2}(?:-(\w), |    )--([a-z]+)(?: ([A-Z]+))? +(.*)$", HELP, re.M)
    if shell == "bash":
        words = " ".join(f"--{name}" for _, name, _, _ in found)
        return ("# bash completion of nsd-fit, made by nsd-fit --completion bash\n_nsd_fit()\n{\n"
                f"    local word=${{COMP_WORDS[COMP_CWORD]}} words=' {words}'\n    COMPREPLY=()\n    [[ $word = -* ]] || return\n"
                "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n}\ncomplete -o default -F _nsd_fit nsd-fit\n")
    rows = []
    for letter, name, value, text in found:
        action = ":folder:_files -/" if value == "FOLDER" else f":{value}:" if value else ""
        text = re.sub(r" *\[.*\]", "", text)
        rows += [f"    '-{letter}[{text}]{action}' \\\n"] if letter else []
        rows.append(f"    '--{name}{'=' if value else ''}[{text}]{action}' \\\n")
    return ("#compdef nsd-fit\n# zsh completion, made by nsd-fit --completion zsh\n_arguments -s -S \\\n" + "".join(rows)
            + "    '*:file:_files'\n")


class Options(argparse.ArgumentParser):
    def format_help(self) -> str:
        return HELP

    def error(self, message: str) -> NoReturn:
        print(f"nsd-fit: {message}\nusage: nsd-fit [OPTION ...] PROBLEM.json, see nsd-fit --help", file=sys.stderr)
        sys.exit(64)


def read_options(version: str) -> argparse.Namespace:
    p = Options(prog="nsd-fit", add_help=False, allow_abbrev=False)
    p.add_argument("problem")
    p.add_argument("-j", "--jobs", type=int, default=len(os.sched_getaffinity(0)))
    p.add_argument("-n", "--evaluations", type=int)
    p.add_argument("-o", "--output")
    p.add_argument("--timeout", type=float)
    p.add_argument("--quiet", action="store_true")
    p.add_argument("--help", action="help")
    p.add_argument("--version", action="version", version=f"nsd-fit {version}")
    a = p.parse_args()
    if not 1 <= a.jobs <= 4096:
        p.error("--jobs: not from 1 to 4096")
    if a.evaluations is not None and not 2 <= a.evaluations <= 100000:
        p.error("--evaluations: not from 2 to 100000")
    if a.timeout is not None and not 0 < a.timeout < 1e7:
        p.error("--timeout: not above 0 and below 1e7 s")
    return a


def points_of(problem: Problem, table: Table, first: int, n: int, start: int) -> dict[int, list[float]]:
    """Those with the numbers first .. first + n - 1. The first `start` are Sobol points."""
    from . import report, surrogate
    d = len(problem.parameters)
    if first < start:
        x = surrogate.sobol(d, start, problem.seed)[first:first + n]
    else:
        model, known, _, _ = report.fitted(problem, table, first)
        x = surrogate.next_points(surrogate.posterior(model, d), known, n, problem.seed + first)
    return {first + k: [p.value(u) for p, u in zip(problem.parameters, row)] for k, row in enumerate(x)}


class Progress:
    def __init__(self, quiet: bool, most: int, done: int):
        self.quiet, self.most, self.before, self.began = quiet, most, done, time.monotonic()

    def show(self, table: Table, row: Row) -> None:
        if self.quiet:
            return
        done = len(table.rows)
        left = (time.monotonic() - self.began) / max(done - self.before, 1) * (self.most - done)
        said = row.failed or ", ".join(f"{t.name} {x:.4g}" for t, x in zip(table.problem.targets, row.measures))
        values = ", ".join(f"{p.name} {x:.4g}" for p, x in zip(table.problem.parameters, row.values))
        print(f"nsd-fit: {done} of at most {self.most}: {values}: {said}; at most {duration(left)} left", file=sys.stderr)


def duration(s: float) -> str:
    return f"{s:.0f} s" if s < 100 else f"{s / 60:.0f} min" if s < 6000 else f"{s / 3600:.1f} h"


def failures(table: Table, points: dict[int, list[float]]) -> int:
    return sum(bool(table.rows[k].failed) for k in points if k in table.rows)


def steady(before: dict, now: dict, problem: Problem) -> bool:
    """Is the gain of a batch below the scatter of the seeds, and have the intervals stayed?"""
    scatter = sum(2 * (t["scatter"] / t["error"]) ** 2 + abs(t["found"] - t["value"]) * 2 * t["scatter"] / t["error"] ** 2
                  for t in now["targets"].values())
    if before["error"] - now["error"] > scatter:
        return False
    for p in problem.parameters:
        (a, b), (c, d) = ([p.unit(x) for x in r["parameters"][p.name]["interval90"]] for r in (before, now))
        if max(abs(a - c), abs(b - d)) > STEADY * max(d - c, 0.02):
            return False
    return True


def fit(problem: Problem, folder: str, a: argparse.Namespace) -> int:
    from . import report, surrogate
    table = Table(os.path.join(folder, "table.tsv"), problem)
    table.write()
    d, most = len(problem.parameters), a.evaluations or problem.evaluations
    start = min(max(6 * (d + 1), problem.batch), most)
    runner, progress = Runner(problem, a.jobs, a.timeout), Progress(a.quiet, most, len(table.rows))

    def stop(number: int, _: object) -> NoReturn:
        runner.stop()
        os._exit(128 + number)  # the table has each evaluation that has ended
    for s in signal.SIGINT, signal.SIGTERM, signal.SIGHUP:
        signal.signal(s, stop)

    def done(row: Row) -> None:
        table.add(row)
        progress.show(table, row)
        if failures(table, points) >= LEAST_GOOD * len(points):
            runner.stop()

    n, results, calm, points = 0, [], 0, {}
    while n < most and calm < 2:
        size = start if n == 0 else min(problem.batch, most - n)
        points = points_of(problem, table, n, size, start)
        for k in points:  # those of a table that was cut short
            if k in table.rows and table.rows[k].values != points[k]:
                raise Invalid(f"{table.path}: evaluation {k} has other parameters than this version of nsd-fit chooses")
        runner.run({k: v for k, v in points.items() if k not in table.rows}, done)
        if failures(table, points) >= LEAST_GOOD * size:
            why = next(table.rows[k].failed for k in points if k in table.rows and table.rows[k].failed)
            raise Invalid(f"half of {size} evaluations failed, the first one: {why}", 1)
        n += size
        model, _, values, measures = report.fitted(problem, table, n)
        p = surrogate.posterior(model, d)
        results.append(report.judge(problem, model, p, table, n))
        calm = calm + 1 if len(results) > 1 and steady(results[-2], results[-1], problem) else 0
    for k in [k for k in table.rows if k >= n]:
        del table.rows[k]
    table.write()
    result = dict(results[-1], finished=calm >= 2)
    if not result["finished"]:
        result["remarks"].append(f"the intervals still change after {n} evaluations: -n allows more")
    trouble = report.plot(folder, problem, model, result, values, measures)
    if trouble:
        print(f"nsd-fit: {trouble}", file=sys.stderr)
    report.keep(folder, problem, result)
    sys.stdout.write(report.lines(result))
    sys.stdout.flush()
    return 0 if result["finished"] else 1


def main(version: str) -> int:
    if sys.argv[1:2] == ["--completion"] and sys.argv[2:] in (["bash"], ["zsh"]):
        sys.stdout.write(completion(sys.argv[2]))
        return 0
    a = read_options(version)
    try:
        import scipy.stats  # noqa: F401
        import sklearn.gaussian_process  # noqa: F401
    except ImportError as e:
        print(f"nsd-fit: {e}: install python3-sklearn and python3-scipy", file=sys.stderr)
        return 69
    try:
        problem = read(a.problem)
        folder = os.path.abspath(a.output or os.path.splitext(a.problem)[0] + ".fit")
        os.makedirs(folder, exist_ok=True)
        return fit(problem, folder, a)
    except Invalid as e:
        print(f"nsd-fit: {e}", file=sys.stderr)
        return e.status
    except OSError as e:
        print(f"nsd-fit: {e}", file=sys.stderr)
        return 74
