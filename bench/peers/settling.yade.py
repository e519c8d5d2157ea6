# settling.yade.py MODULUS DT STEPS EVERY, by yade -n -x: the balls of start.npz fall in a square box without a lid.
# Hertz-Mindlin, restitution 0.5, friction 0.5; every EVERY steps frameSTEP.npy, and a line of frames.txt behind it.
import json
import math
import sys

import numpy as np
from yade import *

modulus, dt, steps, every = float(sys.argv[1]), float(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
start = np.load("start.npz")
O.materials.append(FrictMat(young=modulus, poisson=0.3, density=2500, frictionAngle=math.atan(0.5), label="bead"))
grains = O.bodies.append([sphere(tuple(x), r, material="bead") for x, r in zip(start["x"].tolist(), start["radius"].tolist())])
side = float(start["side"])
for axis, place, sense in ((0, 0, 1), (0, side, -1), (1, 0, 1), (1, side, -1), (2, 0, 1)):
    O.bodies.append(wall(place, axis, sense=sense, material="bead"))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=0.0005),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
                    [Ip2_FrictMat_FrictMat_MindlinPhys(en=0.5, es=0.5)], [Law2_ScGeom_MindlinPhys_Mindlin()]),
    NewtonIntegrator(gravity=(0, 0, -9.81), damping=0),
]
O.dt = dt
with open("frames.txt", "w") as lines:
    while True:
        np.save("frame%d.npy" % O.iter, np.array([list(O.bodies[k].state.pos) + list(O.bodies[k].state.vel) for k in grains]))
        lines.write(json.dumps({"step": O.iter}) + "\n")
        lines.flush()
        if O.iter >= steps:
            break
        O.run(min(every, steps - O.iter), True)
