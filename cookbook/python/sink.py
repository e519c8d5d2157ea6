"""Balls sink in a fluid whose drag is c v: the mean speed against the closed solution."""
import math

import nsd

C = 2e-4  # N s/m

with nsd.Run.from_scene("scene.json") as run:
    mass = run.mass[0]
    for step in run.steps(until=0.5):
        run.force[:] = -C * run.velocity
        if step % 100 == 0:
            exact = mass * 9.81 / C * (1 - math.exp(-C * run.time / mass))
            print("%.3f\t%.6f\t%.6f" % (run.time, -run.velocity[:, 2].mean(), exact))
    run.save("sunk.h5")
