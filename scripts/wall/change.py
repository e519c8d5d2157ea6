#!/usr/bin/python3
"""change.py A B: two solutions of the same contacts (lines of nsd-info -c): the largest difference of a component of their forces
over the mean normal force, and the root mean square."""
import json
import sys

import numpy as np


def forces(path):
    with open(path, encoding="ascii") as file:
        return np.array([row["r"] for row in map(json.loads, file) if "r" in row])


a, b = map(forces, sys.argv[1:])
mean = a[:, 0].mean()
print(f"{np.abs(a - b).max() / mean:.1e}\t{np.sqrt(((a - b) ** 2).mean()) / mean:.1e}".replace("e-0", "e-"))
