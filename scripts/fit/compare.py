#!/usr/bin/python3
"""compare.py FOLDER [EVALUATIONS]: other optimisers on the problems of known.sh, on the error that nsd-fit uses.

CMA-ES (python3-cmaes) and NLopt's BOBYQA (python3-nlopt) minimise sum ((measure - value)/scatter)^2 of drums, each with a seed of its own.
A row for each: problem, optimiser, evaluations, and how far mu and mu_r are from the known values, in parts of their ranges.
"""
import json
import os
import subprocess
import sys

import numpy as np
from cmaes import CMA

import nlopt

folder, most = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 38
known = [line.split("\t") for line in open(os.path.join(folder, "known.tsv"), encoding="utf-8")]
LOW, HIGH = np.array([0.1, 0.0]), np.array([0.9, 0.5])


class Error:
    def __init__(self, k):
        self.problem = json.load(open(os.path.join(folder, f"{k}.json"), encoding="utf-8"))
        result = json.load(open(os.path.join(folder, f"{k}.fit/result.json"), encoding="utf-8"))
        self.targets = {name: (t["value"], t["scatter"]) for name, t in result["targets"].items()}
        self.scene = json.load(open(self.problem["scene"], encoding="utf-8"))
        self.seed, self.made = 50000 + 1000 * k, 0

    def __call__(self, unit):
        mu, mu_r = LOW + np.clip(unit, 0, 1) * (HIGH - LOW)
        self.made += 1
        scene = dict(self.scene, mu=float(mu), rolling={"mu_r_ratio": float(mu_r)}, seed=self.seed + self.made)
        said = subprocess.run(self.problem["command"], input=json.dumps(scene), text=True, capture_output=True, shell=True, check=True)
        measured = json.loads(said.stdout)
        return sum(((measured[name] - value) / scatter) ** 2 for name, (value, scatter) in self.targets.items())


def by_cmaes(error):
    """The mean of the better half of the last generation"""
    search, made = CMA(mean=np.full(2, 0.5), sigma=0.25, bounds=np.array([[0, 1], [0, 1]]), seed=1), []
    while error.made + search.population_size <= most:
        made = [(x, error(x)) for x in (search.ask() for _ in range(search.population_size))]
        search.tell(made)
    made.sort(key=lambda each: each[1])
    return np.mean([x for x, _ in made[: len(made) // 2]], axis=0)


def by_bobyqa(error):
    search = nlopt.opt(nlopt.LN_BOBYQA, 2)
    search.set_min_objective(lambda x, _: error(x))
    search.set_lower_bounds([0, 0])
    search.set_upper_bounds([1, 1])
    search.set_initial_step(0.25)
    search.set_maxeval(most)
    search.set_xtol_abs(1e-3)
    return search.optimize([0.5, 0.5])


for row in known[: int(os.environ.get("PROBLEMS", "4"))]:
    k, right = int(row[0]), (np.array([float(row[1]), float(row[5])]) - LOW) / (HIGH - LOW)
    found = (np.array([float(row[2]), float(row[6])]) - LOW) / (HIGH - LOW)
    print(k, "gaussian-process", row[9], *np.round(found - right, 3), sep="\t", flush=True)
    for name, search in (("cma-es", by_cmaes), ("bobyqa", by_bobyqa)):
        error = Error(k)
        off = search(error) - right
        print(k, name, error.made, *np.round(off, 3), sep="\t", flush=True)
