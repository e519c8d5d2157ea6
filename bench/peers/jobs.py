"""The jobs of make peers, a table: how the start is made, what is run, what is observed.

Starts that others have made, if the folder NSD_STARTS (../shared/benchmarks) has them, are further jobs, NAME-given.

A job's scenes are nsd's (nsd-gen(1)); liggghts.py translates the scene that is run, so that both codes have the same
walls, materials and, from the same document, the same balls. Drums lie along x: LIGGGHTS 3.8 swaps two components of a
ycylinder that rotates.
"""
import gzip
import math
import os
import random
from dataclasses import dataclass, replace
from typing import Callable

GRAINS = {"uniform": [1.5e-3, 2.5e-3]}  # m, of the first four jobs
MEAN_VOLUME = 4 / 3 * math.pi * (2e-3) ** 3 * 1.0625  # m^3, of these
BEAD = {"density": 2500, "mu": 0.5, "e_n": 0.5, "gravity": [0, 0, -9.81]}
# Dosta et al., Comput. Phys. Commun. 296 (2024) 109066: M1 and M2 between steel walls
DOSTA = {
    "gravity": [0, 0, -9.8],
    "materials": {"M1": {"density": 2500}, "M2": {"density": 2000}, "steel": {"density": 7200}},
    "pairs": [{"pair": list(pair), "mu": mu, "e_n": e} for *pair, mu, e in (
        ("M1", "M1", 0.3, 0.5), ("M1", "M2", 0.2, 0.45), ("M2", "M2", 0.4, 0.4), ("M1", "wall", 0.2, 0.4),
        ("M2", "wall", 0.2, 0.4), ("M1", "steel", 0.2, 0.4), ("M2", "steel", 0.2, 0.4))],
}


@dataclass
class Job:
    title: str
    balls: tuple  # number of balls: as published, QUICK
    dt: tuple  # s: of nsd
    settle: float  # s, for which the start falls
    span: tuple  # s of the run: full, QUICK
    observe: str  # a function of observe.py
    label: str  # of the plot's axis
    scenes: Callable  # N, seed -> the scene of the start, what the run's scene has instead, numbers for observe
    modulus: tuple = (5e6, 1e8)  # Pa, of LIGGGHTS: soft, stiff
    yade: bool = False
    start_dt: float = 1e-3  # s: with which the start is made
    skin: float = None  # m: of LIGGGHTS' lists of neighbours, where a quarter of a diameter is dear
    given: str = None  # file of a start that others have made, in the folder NSD_STARTS


def drum(count, seed):
    """Half full, periodic along its axis; its radius grows with the number of balls up to a length of 0.03 m."""
    length = 0.03 if count <= 11250 else 0.0533
    radius = 0.08 * math.sqrt(count / 5000 * 0.03 / length)
    half = 0.7 * radius
    cylinder = {"point": [0, 0, 0], "axis": [1, 0, 0], "radius": radius}
    start = {**BEAD, "seed": seed,
             "cell": {"lengths": [length, 2.2 * radius, 2.2 * radius], "origin": [0, -1.1 * radius, -1.1 * radius],
                      "repeats": [True, False, False]},
             "walls": [{"cylinder": cylinder}],
             "bodies": [{"random": {"count": count}, "radius": GRAINS,
                         "box": {"x": [0, length], "y": [-half, half], "z": [-half, half]}}]}
    speed = 1.57 * math.sqrt(0.08 / radius)  # rad/s: the same Froude number
    run = {"walls": [{"cylinder": cylinder, "drives": [{"about": [0, 0, 0], "axis": [1, 0, 0], "speed": speed}]}]}
    return start, run, {"radius": radius}


def silo(count, seed):
    radius, orifice = 0.04, 0.015
    side = 0.69 * radius
    height = count * MEAN_VOLUME / 0.42 / (2 * side) ** 2
    walls = [{"cylinder": {"point": [0, 0, 0], "axis": [0, 0, 1], "radius": radius}},
             {"disc": {"center": [0, 0, 0], "normal": [0, 0, 1], "radius": radius + 1e-3, "hole": orifice}}]
    plug = {"disc": {"center": [0, 0, 0], "normal": [0, 0, 1], "radius": orifice}}
    start = {**BEAD, "seed": seed, "walls": walls + [plug],
             "bodies": [{"random": {"count": count}, "radius": GRAINS,
                         "box": {"x": [-side, side], "y": [-side, side], "z": [0, height]}}]}
    run = {"walls": walls, "remove": [{"below": {"point": [0, 0, -0.02], "normal": [0, 0, 1]}}]}
    return start, run, {}


def settling(count, seed):
    side = (count * MEAN_VOLUME / 0.25 / 3) ** (1 / 3)
    start = {**BEAD, "seed": seed, "walls": [{"box": {"x": [0, side], "y": [0, side], "z": [0, None]}}],
             "bodies": [{"random": {"count": count}, "radius": GRAINS,
                         "box": {"x": [0, side], "y": [0, side], "z": [0, 3 * side]}}]}
    return start, {}, {"side": side}


def dosta_drum(count, seed):
    """8000 balls of 4 mm below 30 000 of 2 mm; with fewer the drum is smaller."""
    scale = (count / 38000) ** (1 / 3)
    radius, length = 0.1 * scale, 0.06 * scale
    axis = {"about": [0, 0, 0], "axis": [1, 0, 0], "speed": 2 / math.sqrt(scale)}
    shapes = [{"cylinder": {"point": [0, 0, 0], "axis": [1, 0, 0], "radius": radius}},
              {"point": [0, 0, 0], "normal": [1, 0, 0]}, {"point": [length, 0, 0], "normal": [-1, 0, 0]}]
    large = round(count * 8 / 38)

    def group(number, kind, r, low, high):
        return {"random": {"count": number}, "radius": r, "material": kind,
                "box": {"x": [0, length], "y": [-0.8 * radius, 0.8 * radius], "z": [low * radius, high * radius]}}

    start = {**DOSTA, "seed": seed, "walls": shapes,
             "bodies": [group(large, "M2", 2e-3, -0.58, 0.1), group(count - large, "M1", 1e-3, 0.12, 0.59)]}
    return start, {"walls": [{**shape, "drives": [axis]} for shape in shapes]}, {}


def dosta_silo(count, seed):
    """Balls of 4 mm in a cylinder over a cone; the paper's large orifice. They begin on a lattice that fills both."""
    low, high, orifice, radius = -0.0554222, 0.0145778, 0.03, 0.1
    walls = [{"cone": {"point": [0, 0, low], "axis": [0, 0, 1], "radii": [orifice, radius], "length": high - low}},
             {"cylinder": {"point": [0, 0, high], "axis": [0, 0, 1], "radius": radius, "length": 0.6}}]
    plug = {"disc": {"center": [0, 0, low], "normal": [0, 0, 1], "radius": orifice + 2e-3}}
    chance, rows, z, ball, edge = random.Random(seed), [], low + 2.1e-3, 2e-3, 4.2e-3
    while len(rows) < count:
        wide = min(radius, orifice + (z - low) / (high - low) * (radius - orifice)) - ball * math.sqrt(2) - 1e-4
        cells = int(wide / edge) + 1
        for i in range(-cells, cells + 1):
            for j in range(-cells, cells + 1):
                if math.hypot(i, j) * edge + 1.5e-4 <= wide and len(rows) < count:
                    rows.append([i * edge + chance.uniform(-1e-4, 1e-4), j * edge + chance.uniform(-1e-4, 1e-4), z])
        z += edge
    start = {**DOSTA, "seed": seed, "walls": walls + [plug],
             "table": "# x y z r material\n" + "".join("%.6f %.6f %.6f 0.002 M1\n" % tuple(row) for row in rows),
             "bodies": [{"file": "TABLE"}]}
    return start, {"walls": walls, "remove": [{"below": {"point": [0, 0, low - 0.02], "normal": [0, 0, 1]}}]}, \
        {"orifice": low, "count": count}


def penetration(count, seed):
    """A steel ball of 20 mm into 2 mm beads, as after the paper's flight from 0.06 m with 5 m/s; with fewer beads the box is
    narrower."""
    scale = min(1, max(0.5, math.sqrt(count / 25000)))
    x, y, floor = 0.049 * scale, 0.03 * scale, -0.0902431
    height = count * 4.18879e-9 / 0.3 / (4 * x * y)
    start = {**DOSTA, "seed": seed, "walls": [{"box": {"x": [-x, x], "y": [-y, y], "z": [floor, None]}}],
             "bodies": [{"random": {"count": count}, "radius": 1e-3, "material": "M1",
                         "box": {"x": [-x, x], "y": [-y, y], "z": [floor, floor + height]}}]}
    top = floor + count * 4.18879e-9 / 0.58 / (4 * x * y)
    flight = 0.06 - (-0.0605 + 0.01)  # m
    ball = {"x": [0, 0, top + 0.0115], "radius": 0.01, "v": [0, 0, -math.sqrt(5 ** 2 + 2 * 9.8 * flight)], "material": "steel"}
    return start, {"more": [ball]}, {"top": top}


JOBS = {
    "drum": Job("Drum, 5000 balls of 3 to 5 mm", (5000, 1000), (1e-3, 1e-3), 0.3, (1.0, 0.2), "angle",
                "angle of the centre of mass, degrees", drum),
    "drum-20k": Job("Drum, 20 000 balls of 3 to 5 mm", (20000, 2000), (1e-3, 1e-3), 0.3, (0.5, 0.1), "angle",
                    "angle of the centre of mass, degrees", drum),
    "silo": Job("Silo, 10 000 balls of 3 to 5 mm", (10000, 3000), (1e-3, 1e-3), 0.4, (0.5, 0.2), "discharged",
                "discharged mass, kg", silo),
    "settling": Job("Settling, 10 000 balls of 3 to 5 mm", (10000, 1000), (1e-3, 1e-3), 0, (0.5, 0.3), "bed",
                    "solid fraction", settling, yade=True),
    "dosta-drum": Job("Dosta's drum, 8000 balls of 4 mm and 30 000 of 2 mm", (38000, 3000), (2.5e-4, 5e-4), 0.25,
                      (0.25, 0.05), "risen", "large balls in the rising quadrant", dosta_drum, start_dt=5e-4),
    "dosta-silo": Job("Dosta's silo, 100 000 balls of 4 mm, large orifice", (100000, 6000), (5e-4, 1e-3), 0.25,
                      (0.15, 0.05), "inside", "balls above the orifice", dosta_silo),
    "penetration": Job("Dosta's penetration, a steel ball into 25 000 of 2 mm", (25000, 3000), (2e-5, 2e-5), 0.15,
                       (0.02, 0.01), "depth", "height of the ball, m", penetration, skin=3e-3, start_dt=2.5e-4),
}


STARTS = os.environ.get("NSD_STARTS", os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "shared", "benchmarks"))


def given(job, path, axes, shift, span):
    """The job with the balls of a table x y z r [kind]: its axes as ours, -1 the opposite of x, and shifted along the first."""
    def scenes(count, seed):
        start, run, about = job.scenes(count, seed)
        with (gzip.open if path.endswith(".gz") else open)(path, "rt") as f:
            rows = [line.split() for line in f if not line.startswith("#")]
        table = "# x y z r" + " material" * (len(rows[0]) > 4) + "\n"
        for row in rows:
            x = [float(row[c]) if c >= 0 else -float(row[0]) for c in axes]
            table += " ".join(["%.12g" % (x[0] + shift), "%.12g" % x[1], "%.12g" % x[2], *row[3:]]) + "\n"
        return {**start, "allow_overlap": True, "table": table, "bodies": [{"file": "TABLE"}]}, run, about

    def from_above(count, seed):  # the whole flight
        start, run, about = scenes(count, seed)
        if "more" in run:
            run["more"][0].update(x=[0, 0, 0.06], v=[0, 0, -5])
        return start, run, about

    return replace(job, title=job.title + ", a start by others", balls=(job.balls[0],) * 2, settle=0, span=span or job.span, scenes=from_above, given=path)


# drums lie along y there, and turn the other way or the same
for name, path, axes, shift, span in (("drum", "peers/drum5k.tab.gz", (1, -1, 2), 0, None),
                                       ("dosta-drum", "dosta2024/drum.txt", (1, 0, 2), 0.03, None),
                                       ("penetration", "dosta2024/penetration25.txt", (0, 1, 2), 0, (0.04, 0.01))):
    if os.path.exists(os.path.join(STARTS, path)):
        JOBS[name + "-given"] = given(JOBS[name], os.path.join(STARTS, path), axes, shift, span)

# The number that --mode check compares, where it is not the plotted one
COMPARED = {"dosta-drum": "rising", "dosta-silo": "out", "penetration": "depth"}
