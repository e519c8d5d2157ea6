#!/usr/bin/python3
"""Flat rocks slide down a slope that is less steep than their friction, each with its own speed, until all of them rest: then
this program stops the run. Prints how far each has come, m, beside v^2/(2 g (mu cos a - sin a))."""
import json

import nsd
import numpy as np

slope, mu, g = np.radians(20), 0.6, 9.81
speeds = [1.0, 1.5, 2.0, 3.0]  # m/s
scene = {"dt": 1e-3, "density": 2600, "mu": mu, "gravity": [g * np.sin(slope), 0, -g * np.cos(slope)],
         "shapes": {"rock": {"box": [1.0, 0.8, 0.2]}},
         "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1]}],
         "bodies": [{"x": [0, 2 * k, 0.05], "shape": "rock", "size": 0.5, "v": [v, 0, 0]} for k, v in enumerate(speeds)]}
scene["bodies"] = [dict(b, x=[0, b["x"][1], 0.05 * (1 + 1e-9)]) for b in scene["bodies"]]

with nsd.Run.from_scene(scene) as run:
    begin, x, v = run.position.copy(), run.position, run.velocity
    for step in run:
        if np.abs(v).max() < 1e-6:
            break
        if run.time > 60:
            raise SystemExit("the rocks do not come to rest")
    for k, speed in enumerate(speeds):
        expected = speed**2 / (2 * g * (mu * np.cos(slope) - np.sin(slope)))
        print(json.dumps({"case": speed, "way": x[k, 0] - begin[k, 0], "expected": expected, "time": run.time}))
