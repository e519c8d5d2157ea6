#!/usr/bin/python3
"""Friction fitted to an angle of repose. A pile of three flat bricks lies on a slab that is tilted until the pile gives way;
scipy looks for the friction between bricks with which that happens at the measured angle. The answer is known: tan(angle), for
the slab holds more. Prints both."""
import json

import nsd
import numpy as np
from scipy.optimize import brentq

measured = 25.0  # degrees
size, height = 1.0, 0.2  # m
scene = {"dt": 1e-3, "mu": 0.9, "shapes": {"brick": {"box": [size, size, height]}},
         "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1]}],
         "bodies": [{"x": [0, 0, height * (k + 0.5)], "shape": "brick", "size": 1} for k in range(3)]}


def repose(mu):
    """Degrees: at which a brick slides on another, when the slab is tilted by 2.5 degrees a second"""
    with nsd.Run.from_scene(scene) as run:
        run.set(small_steps=0)  # one solve per step: friction holds from the first one on, and does not build up in some
        run.friction("ball", "ball", mu)  # "ball" is the kind of grains
        v = run.velocity
        for angle in np.arange(15, 45, 0.05):
            a = np.radians(angle)
            run.gravity([9.81 * np.sin(a), 0, -9.81 * np.cos(a)])
            run.step(20)
            if np.abs(v[:, 0]).max() > 1e-3:
                return angle
    return 45.0


mu = brentq(lambda mu: repose(mu) - measured, 0.1, 0.8, xtol=1e-3)
print(json.dumps({"case": "pile", "mu": mu, "expected": np.tan(np.radians(measured))}))
