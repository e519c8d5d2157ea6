#!/usr/bin/python3
"""forces.py TRUTH OTHER...: contact by contact, each other one beside the truth; files of forces.sh, .json of nsd-info -c whose
name ends in the time step, or .txt of reference/dem.c. A row of a Markdown table each."""
import json
import os
import sys

import numpy as np

NONE = 0, np.zeros(3)


def of_nsd(path):
    """F_n and the vector F_t on b, N, of each pair"""
    dt, found = float(os.path.basename(path)[:-5].split("_dt_")[1]), {}
    with open(path, encoding="ascii") as file:
        for row in map(json.loads, file):
            if "r" in row:
                t1, t2 = np.array(row["t1"]), np.array(row["t2"])
                found[tuple(row["body"])] = row["r"][0] / dt, (row["r"][1] * t1 + row["r"][2] * t2) / dt
    return found


def of_dem(path):
    found = {}
    with open(path, encoding="ascii") as file:
        for row in file:
            i, j, *f = row.split()
            across = np.array(f[1:], float)
            pair = (int(j), int(i)) if int(j) < 0 else (int(i), int(j))
            found[pair] = float(f[0]), -across if int(j) < 0 else across
    return found


def read(path):
    return of_nsd(path) if path.endswith(".json") else of_dem(path)


def explained(x, truth):
    return 1 - ((x - truth) ** 2).sum() / ((truth - truth.mean(axis=0)) ** 2).sum()


truth = read(sys.argv[1])
mean = np.mean([f[0] for f in truth.values()])
for path in sys.argv[2:]:
    other = read(path)
    pairs = sorted(set(truth) | set(other))
    n, t = ([[np.array(f.get(p, NONE)[k]) / mean for p in pairs] for f in (other, truth)] for k in (0, 1))
    (n, n0), (t, t0) = map(np.array, n), map(np.array, t)
    loaded, loaded0 = n > 1e-6, n0 > 1e-6
    row = [os.path.basename(path).rsplit(".", 1)[0].replace("_", " "), loaded.sum(), (loaded & loaded0).sum(),
           f"{np.corrcoef(n, n0)[0, 1]:.3f}", f"{np.corrcoef(t.ravel(), t0.ravel())[0, 1]:.3f}", f"{explained(n, n0):.3f}",
           f"{explained(t, t0):.3f}", f"{np.sqrt(((n - n0) ** 2).mean()):.2f}"]  # fmt: skip
    print("|", " | ".join(map(str, row)), "|")
