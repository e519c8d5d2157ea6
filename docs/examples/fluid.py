#!/usr/bin/python3
"""Glass balls in water. One sinks: drag by Schiller and Naumann, and buoyancy. A bed of them is lifted by water that rises
through it: drag by Ergun's equation. Prints the velocities that were found beside the expected ones, m/s."""
import json

import nsd
import numpy as np

water, viscosity, glass, g = 1000.0, 1e-3, 2500.0, 9.81  # kg/m^3, Pa s, kg/m^3, m/s^2
d = 1e-3  # m


def root(f, lo, hi):
    """Where f, which rises, is 0."""
    for _ in range(100):
        middle = 0.5 * (lo + hi)
        lo, hi = (middle, hi) if f(middle) < 0 else (lo, middle)
    return lo


def sinking():
    volume = np.pi / 6 * d**3
    drag = lambda v: 3 * np.pi * viscosity * d * (1 + 0.15 * (water * v * d / viscosity) ** 0.687)  # N s/m
    with nsd.Run.from_scene({"dt": 2e-4, "density": glass, "bodies": [{"x": [0, 0, 0], "radius": d / 2}]}) as run:
        v = run.velocity
        for _ in run.steps(5000):
            run.force = -drag(np.linalg.norm(v)) * v + [0, 0, water * volume * g]
        return -v[0, 2], root(lambda u: drag(u) * u - (glass - water) * volume * g, 0, 10)


def ergun(u, void):
    """Pa/m: the pressure that water loses at the superficial velocity u (m/s) through balls with this share of voids."""
    solid = 1 - void
    return 150 * viscosity * solid**2 / (void**3 * d**2) * u + 1.75 * water * solid / (void**3 * d) * u * abs(u)


def bed():
    side, n = 6e-3, 250  # m: of a column that repeats across
    scene = {"dt": 2e-4, "density": glass, "mu": 0.3, "seed": 2, "gravity": [0, 0, -g],
             "cell": {"lengths": [side, side, 1], "repeats": [True, True, False]},
             "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1]}],
             "bodies": [{"count": n, "radius": d / 2, "box": {"x": [0, side], "y": [0, side], "z": [0, None]}}]}
    with nsd.Run.from_scene(scene) as run:
        volume, x, v = np.pi / 6 * d**3, run.position, run.velocity
        weight = n * volume * (glass - water) * g  # N, in water

        def push(u):  # each ball by the velocity of the water past it; the bed's voids by how high it is
            height = 2 * (x[:, 2].mean())
            void = 1 - n * volume / (side**2 * height)
            past = u - void * v[:, 2]
            run.force[:, 2] = water * volume * g + volume / (1 - void) * np.array(ergun(past.mean(), void) * past / past.mean())
            return void

        for _ in run.steps(1500):
            run.force = -1e-4 * v + [0, 0, water * volume * g]  # it settles
        void = push(1e-9)
        expected = root(lambda u: ergun(u, void) - (1 - void) * (glass - water) * g, 0, 1)
        rise, carried = np.linspace(0.3, 1.5, 3000) * expected, []
        for u in rise:
            push(u)
            run.step()
            carried.append(-run.wall_force[0, 2] / weight)
        mean = np.convolve(carried, np.ones(50) / 50, "valid")  # the floor carries what the water leaves
        return rise[49 + np.argmax(mean < 0.02)], expected


for name, (found, expected) in ("terminal", sinking()), ("fluidised", bed()):
    print(json.dumps({"case": name, "velocity": float(found), "expected": float(expected)}))
