"""Values with their intervals, what the targets cannot determine, and the plot."""
from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
from typing import Any

import numpy as np

from .problem import Problem, standard
from .surrogate import Posterior, Surrogate
from .table import Table, replace

UNDETERMINED = 0.7  # of the range: an interval of a uniform density has 0.9
TOGETHER = 0.4  # width of one parameter where another is known, over its width


def together(p: Posterior, i: int, j: int) -> float:
    """The width of parameter i where j is known, over its width: the deviation from its mean in classes of j"""
    mean = np.average(p.x[:, i], weights=p.weight)
    whole = np.average((p.x[:, i] - mean) ** 2, weights=p.weight)
    edges = [p.quantile(j, q) for q in np.linspace(0, 1, 21)[1:-1]]
    classes, inner = np.searchsorted(edges, p.x[:, j]), 0.0
    for c in range(20):
        w, x, y = p.weight[classes == c], p.x[classes == c, i], p.x[classes == c, j]
        if w.sum() <= 0 or len(w) < 4:
            continue
        slope = np.polyfit(y, x, 1, w=np.sqrt(w)) if np.ptp(y) > 0 else [0, np.average(x, weights=w)]
        inner += float((w * (x - np.polyval(slope, y)) ** 2).sum())
    return math.sqrt(inner / whole) if whole > 0 else 1.0


def alternatives(p: Posterior, names: list[str]) -> list[int]:
    """Samples that fit as well as the best one within the errors, far from each other, the best one first"""
    near = np.flatnonzero((p.misfit <= p.misfit.min() + 1) & (p.weight > 1e-3 * p.weight.max()))
    chosen = [p.best()]
    for _ in range(3):
        if len(near) == 0:
            break
        distance = np.min([np.linalg.norm(p.x[near] - p.x[c], axis=1) for c in chosen], axis=0)
        if distance.max() < 0.2 * math.sqrt(len(names)):
            break
        chosen.append(int(near[np.argmax(distance)]))
    return chosen


def judge(problem: Problem, model: Surrogate, p: Posterior, table: Table, n: int) -> dict[str, Any]:
    """All that result.json has."""
    names = [q.name for q in problem.parameters]
    best = p.x[p.best()]
    found: dict[str, Any] = {}
    remarks = []
    for j, q in enumerate(problem.parameters):
        low, high = p.interval(j)
        found[q.name] = {"value": q.value(best[j]), "interval90": [q.value(low), q.value(high)], "range": [q.low, q.high]}
        if high - low > UNDETERMINED:
            remarks.append(f"{q.name} is not determined by the targets: its interval is {100 * (high - low):.0f} % of its range")
        elif best[j] < 0.01 or best[j] > 0.99:
            remarks.append(f"{q.name} is at the end of its range, {found[q.name]['value']:g}")
    for j in range(len(names)):
        for i in range(j):
            wide = max(p.interval(k)[1] - p.interval(k)[0] for k in (i, j)) > 0.2
            if wide and max(together(p, i, j), together(p, j, i)) < TOGETHER:
                remarks.append(f"{names[i]} and {names[j]} are determined only together: the targets cannot tell one from the other")
    others = alternatives(p, names)
    if len(others) > 1:
        remarks.append(f"{len(others)} sets of parameters that are far apart fit equally well")
    misfit, targets = float(p.misfit.min()), len(problem.targets)
    if misfit > targets + 3 * math.sqrt(2 * targets):
        remarks.append(f"no parameters in their ranges reach the targets: the error is {misfit:.3g}, and {targets} is expected")
    rows = table.rows
    failed = sum(bool(rows[k].failed) for k in rows)
    if failed:
        remarks.append(f"{failed} of {len(rows)} evaluations failed")
    mean, _ = model.predict(best[None, :])
    return {
        "evaluations": n, "failed": failed, "cpu_hours": round(table.cpu() / 3600, 4),
        "error": misfit, "parameters": found,
        "targets": {t.name: {"value": t.value, "error": model.error_of(k), "found": float(mean[0, k]), "scatter": model.scatter[k]}
                    for k, t in enumerate(problem.targets)},
        "equally_good": [{q.name: q.value(p.x[c, j]) for j, q in enumerate(problem.parameters)} for c in others],
        "remarks": remarks,
    }


def lines(result: dict[str, Any]) -> str:
    """For people"""
    width = max(map(len, [*result["parameters"], *result["targets"], "parameter"]))
    out = [f"{'parameter':{width}}  {'value':>12}  90 % interval"]
    for name, q in result["parameters"].items():
        out.append(f"{name:{width}}  {q['value']:12.5g}  {q['interval90'][0]:.5g} to {q['interval90'][1]:.5g}")
    out.append(f"{'target':{width}}  {'measured':>12}  {'fitted':>12}  {'error':>10}  {'seeds':>10}")
    for name, t in result["targets"].items():
        out.append(f"{name:{width}}  {t['value']:12.5g}  {t['found']:12.5g}  {t['error']:10.3g}  {t['scatter']:10.3g}")
    out += [f"{k + 1}: " + ", ".join(f"{name} {x:.5g}" for name, x in each.items()) for k, each in enumerate(result["equally_good"])
            if len(result["equally_good"]) > 1]
    return "\n".join(out + [f"nsd-fit: {remark}" for remark in result["remarks"]]) + "\n"


def plot(folder: str, problem: Problem, model: Surrogate, result: dict[str, Any], values: np.ndarray, measures: np.ndarray) -> str | None:
    """errors.svg, by gnuplot; why there is none"""
    if not shutil.which("gnuplot"):
        return "no gnuplot, so no errors.svg"
    data = os.path.join(folder, "errors.tsv")
    misfit = model.misfit(measures)
    replace(data, "".join("\t".join(map(repr, [*map(float, row), float(e)])) + "\n" for row, e in zip(values, misfit)))
    d = len(problem.parameters)
    columns = min(d, 3)
    script = [f"set terminal svg size {360 * columns},{300 * -(-d // columns)} font 'sans,12' background 'white'",
              f"set output '{os.path.join(folder, 'errors.svg')}'", f"set multiplot layout {-(-d // columns)},{columns}",
              "unset key", "set logscale y", "set ylabel 'error'", "set format y '%g'"]
    for j, q in enumerate(problem.parameters):
        low, high = result["parameters"][q.name]["interval90"]
        script += [f"set xlabel '{q.name}' noenhanced", f"set xrange [{q.low}:{q.high}]",
                   "set logscale x" if q.log else "unset logscale x",
                   f"set object 1 rectangle from {low},graph 0 to {high},graph 1 behind fillcolor '#cfe3f5' fillstyle solid noborder",
                   f"set title '90 %: {low:.4g} to {high:.4g}'",
                   f"plot '{data}' using {j + 1}:{d + 1} with points pointtype 7 pointsize 0.4 linecolor '#1f4e79'"]
    done = subprocess.run(["gnuplot"], input="\n".join(script) + "\n", text=True, capture_output=True, check=False)
    return f"gnuplot: {done.stderr.strip()[:200]}" if done.returncode else None


def keep(folder: str, problem: Problem, result: dict[str, Any]) -> None:
    """result.json, and scene.json with the best values"""
    replace(os.path.join(folder, "result.json"), json.dumps(result, indent=1) + "\n")
    best = [q["value"] for q in result["parameters"].values()]
    replace(os.path.join(folder, "scene.json"), json.dumps(problem.scene_with(best, None), indent=1) + "\n")


def fitted(problem: Problem, table: Table, n: int) -> tuple[Surrogate, np.ndarray, np.ndarray, np.ndarray]:
    values, measures = table.good(n)
    x = standard(problem, values)
    return Surrogate(problem, x, measures), x, values, measures
