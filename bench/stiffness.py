#!/usr/bin/python3
"""stiffness.py [--part impacts|jobs]: what a stiffness of the contacts changes; tables on standard output, those of docs/forces.

impacts   steps of a ball in a self-locking V, a heap, a tube and a screw that Newton's law of impact leaves without a solution
jobs      CPU seconds, overlap and observable of the drum, silo and settling jobs of make peers
"""
import argparse
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(ROOT, "bench"), os.path.join(ROOT, "python")]
try:
    import h5py
    import numpy as np
    import peers
except ImportError as trouble:
    sys.exit(f"stiffness: {trouble}: apt-get install python3-h5py")

OPTIONS = {"rigid": ["--stiffness", "rigid"], "auto": ["--stiffness", "auto"]}
EVERY = 5  # steps whose largest impulse is compared with that for e = 0: those with the largest


def screw(turns=3, radius=0.012, pitch=0.012, sides=24):
    """The surface of a screw about z, as the text of an OBJ file, m"""
    lines, rows = [], turns * sides + 1
    for i in range(rows):
        a, z = 2 * math.pi * i / sides, pitch * i / sides
        lines += ["v 0 0 %.6g" % z, "v %.6g %.6g %.6g" % (radius * math.cos(a), radius * math.sin(a), z)]
    for i in range(1, 2 * rows - 2, 2):
        lines += ["f %d %d %d" % (i, i + 1, i + 3), "f %d %d %d" % (i, i + 3, i + 2)]
    return "\n".join(lines) + "\n"


def scenes(folder):
    """name, scene, steps. All walls are at rest, and all grains rebound."""
    with open(os.path.join(ROOT, "scenes", "heap.json")) as f:
        heap = dict(json.load(f), e_n=0.5)
    with open(os.path.join(folder, "screw.obj"), "w") as f:
        f.write(screw())
    balls = {"dt": 5e-4, "density": 2500, "mu": 0.6, "e_n": 0.5, "seed": 2, "gravity": [0, 0, -9.81]}
    pipe = {"cylinder": {"point": [0, 0, 0], "axis": [0, 0, 1], "radius": 0.0125}}
    floor = {"point": [0, 0, 0], "normal": [0, 0, 1]}
    group = {"radius": {"uniform": [1e-3, 1.5e-3]}, "box": {"x": [-8e-3, 8e-3], "y": [-8e-3, 8e-3], "z": [0.002, 0.06]}, "random": {"count": 150}}
    above = {**group, "box": {**group["box"], "z": [0.04, 0.1]}}
    vee = {"dt": 2e-4, "mu": 0.5, "e_n": 0.2, "bodies": [{"x": [0, 0, 0.01], "radius": 1e-3}],
           "walls": [{"point": [0, 0, 0], "normal": [s * 0.94, 0, 0.34]} for s in (1, -1)]}
    yield "ball in a V", vee, 700
    yield "heap of 321 discs", heap, 1000
    yield "150 balls in a tube", {**balls, "walls": [pipe, floor], "bodies": [group]}, 300
    yield "150 balls on a screw in a tube", {**balls, "walls": [pipe, floor, {"mesh": {"file": os.path.join(folder, "screw.obj")}}],
                                             "bodies": [above]}, 400


def step(document, out, steps, options):
    """Its messages"""
    with open(out + ".said", "w") as said:
        subprocess.run(["nsd-step", "-j", "1", "-n", str(steps), "--contacts", "--log", out + ".log", *options, "-o", out, document], stderr=said, check=True)
    return open(out + ".said").read()


def largest(document):
    """N s: the largest normal impulse of each frame, and its step"""
    with h5py.File(document) as f:
        c = f["contacts"]
        reaction = c["reaction"][:, 0]
        found = []
        for k, (first, count) in enumerate(zip(c["start"][:], c["count"][:])):
            found.append((float(reaction[first:first + count].max()) if count else 0.0, int(c["step"][k])))
    return found


def without_restitution(document, number, folder, options):
    """N s: the largest normal impulse of the step after this frame, with e = 0"""
    one, out = os.path.join(folder, "one.h5"), os.path.join(folder, "none.h5")
    subprocess.run(["nsd-cat", "-s", f"{number}:{number}", "-o", one, document], check=True)
    with h5py.File(one, "r+") as f:
        for name in "en", "et":
            f["nsd/material/" + name][...] = 0
    with open(one, "rb") as f:  # without the user block, whose checksum is of what was there
        plain = f.read()[512:]
    with open(one, "wb") as f:
        f.write(plain)
    step(one, out, 1, options)
    return largest(out)[-1][0]


def impacts(folder):
    print("| | contacts | steps | without a solution | others not converged | worst natural map | largest impulse, N s | over that with e = 0 |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for name, scene, steps in scenes(folder):
        start = os.path.join(folder, "start.h5")
        with open(start, "wb") as out:
            subprocess.run(["nsd-gen", "-"], input=json.dumps(scene).encode(), stdout=out, stderr=subprocess.DEVNULL, check=True)
        for law, options in OPTIONS.items():
            options = options + ["--criterion", "natural", "--tolerance", "1e-8", "--max-sweeps", "5000"]
            run = os.path.join(folder, "run.h5")
            said = step(start, run, steps, options)
            lines = [json.loads(line) for line in open(run + ".log")]
            bad = sum(not line["converged"] for line in lines)
            unsolved = sum(map(int, re.findall(r"(\d+) (?:of them have no solution|without a solution)", said)[:1]))
            worst = sorted((row for row in largest(run) if row[1] > 1), reverse=True)[:EVERY]
            ratios = [impulse / max(without_restitution(run, k - 1, folder, options), 1e-300) for impulse, k in worst if impulse]
            print(f"| {name}, {law} | {max(line['contacts'] for line in lines)} | {steps} | {unsolved} | {bad - unsolved} | "
                  f"{max(line['natural'] for line in lines):.1e} | {worst[0][0]:.1e} | {max(ratios):.3g} |", flush=True)


def jobs(folder):
    print("| | CPU s | over rigid | deepest overlap, radii | observable at the end |")
    print("| --- | --- | --- | --- | --- |")
    laws = {"rigid": ["--small-steps", "0"], "stiffness auto": OPTIONS["auto"], "small steps of 0.03": ["--small-steps", "0.03"]}
    for name in "drum", "silo", "settling":
        job = peers.JOBS[name]
        _, document, about = peers.prepare(name, job.balls[0], 1, 0, os.path.join(folder, name))
        rigid = None
        for law, options in laws.items():
            run = os.path.join(folder, "run")
            os.makedirs(run)
            cost, frames = peers.codes.RUN["nsd"](run, document, job.span[0], options=options, threads=1, bound=300)
            curve = peers.series(job, frames, about)
            shutil.rmtree(run)
            rigid = rigid or cost["cpu"]
            key = [key for key in curve if key != "t"][0]
            last = np.mean(curve[key][-10:]) if key == "angle" else curve[key][-1]
            print(f"| {job.title}, {law} | {cost['cpu']:.3g} | {cost['cpu'] / rigid:.2f} | {cost['overlap']:.2g} | {key} {last:.3g} |", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--part", choices=["impacts", "jobs"])
    part = parser.parse_args().part
    with tempfile.TemporaryDirectory() as work:
        for k, make in enumerate([impacts, jobs]):
            if part in (None, make.__name__):
                print(end="\n" if k and not part else "")
                make(work)
