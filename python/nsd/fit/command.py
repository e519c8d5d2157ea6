"""A run of nsd-fit: batches of evaluations until the intervals stay."""
from __future__ import annotations

import argparse
import os
import signal
import sys
import time
from typing import NoReturn

import numpy as np

from . import report, surrogate
from .problem import Invalid, Problem, read
from .table import Row, Runner, Table

STEADY = 0.1  # of its width: how far an interval's ends may move from batch to batch
LEAST_GOOD = 0.5  # of a batch
REPEATS = 4  # of the middle of the ranges, with other seeds: else a process could follow the scatter as if it were an effect


def points_of(problem: Problem, table: Table, first: int, n: int) -> dict[int, list[float]]:
    """Those with the numbers first .. first + n - 1, a batch. The first batch has Sobol points and repeats."""
    d = len(problem.parameters)
    if first == 0:
        middle = np.full((REPEATS if n > 2 * REPEATS else 0, d), 0.5)
        x = np.concatenate([surrogate.sobol(d, n - len(middle), problem.seed), middle])
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
    table = Table(os.path.join(folder, "table.tsv"), problem)
    table.write()
    d, most = len(problem.parameters), a.evaluations or problem.evaluations
    start = min(max(6 * (d + 1) + REPEATS, problem.batch), problem.evaluations)
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
        batch = points_of(problem, table, n, start if n == 0 else problem.batch)
        points = {k: batch[k] for k in batch if k < most}  # -n may end a batch, and does not change it
        for k in points:  # those of a table that was cut short
            if k in table.rows and table.rows[k].values != points[k]:
                raise Invalid(f"{table.path}: evaluation {k} has other parameters than this version of nsd-fit chooses")
        runner.run({k: v for k, v in points.items() if k not in table.rows}, done)
        if failures(table, points) >= LEAST_GOOD * len(points):
            why = next(table.rows[k].failed for k in points if k in table.rows and table.rows[k].failed)
            raise Invalid(f"half of {len(points)} evaluations failed, the first one: {why}", 1)
        n += len(points)
        model, _, values, measures = report.fitted(problem, table, n)
        p = surrogate.posterior(model, d)
        results.append(report.judge(problem, model, p, table, n))
        calm = calm + 1 if len(results) > 1 and steady(results[-2], results[-1], problem) else 0
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


def main(a: argparse.Namespace) -> int:
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
