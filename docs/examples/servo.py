#!/usr/bin/python3
"""Grains under a piston of 0.1 g. In one run the piston has a load of 20 mN in the scene; in the other this program holds the
force that the grains push back with at 20 mN, by a servo that integrates what is missing. Prints the stresses, Pa, that
the floor and the piston then have."""
import json

import nsd
import numpy as np

side, target, mass = 5e-3, 0.02, 1e-4  # m, N, kg
scene = {"dt": 1e-4, "density": 2500, "mu": 0.3, "seed": 4,
         "bodies": [{"count": 48, "radius": {"uniform": [4e-4, 5e-4]},
                     "box": {"x": [0, side], "y": [0, side], "z": [0, 4e-3]}}],
         "walls": [{"box": {"x": [0, side], "y": [0, side], "z": [0, None]}},
                   {"point": [0, 0, 4e-3], "normal": [0, 0, -1], "load": {"along": [0, 0, 1], "mass": mass}}]}
floor, piston = 4, 5


def stresses(run, servo):
    force, seen = -target / 2, []
    for step in run.steps(4000):
        missing = target - run.wall_force[piston, 2]
        if servo:
            force -= 0.02 * missing  # N: it lags behind, and does not ring
            run.push_wall(piston, force)
        if step > 3000:
            seen.append([-run.wall_force[floor, 2], run.wall_force[piston, 2]])
    return np.mean(seen, axis=0) / side**2


with nsd.Run.from_scene(scene) as run:
    by_program = stresses(run, True)
scene["walls"][1]["load"]["force"] = -target
with nsd.Run.from_scene(scene) as run:
    built_in = stresses(run, False)
for name, found, expected in zip(("floor", "piston"), by_program, built_in):
    print(json.dumps({"case": name, "stress": found, "expected": expected}))
