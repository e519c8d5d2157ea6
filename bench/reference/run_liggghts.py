#!/usr/bin/python3
"""run_liggghts.py [-o OUT.h5] --until T --every T [--set modulus=PA] <FILE.h5: as run.py, by LIGGGHTS with Hertz's contacts.

For balls in tubes: cylinders along an axis, which may rotate, and horizontal discs, which may have a hole or sink. Beside OUT.h5
OUT.h5.events has the balls that were removed, and OUT.h5.wall the forces on the walls in each frame:
[step, wall, z, normal force, vertical force] on single balls, times dt of the scene: impulses of a step.
"""
import argparse
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import run

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "peers"))
import liggghts  # noqa: E402
from observe import overlap  # noqa: E402

MODEL = "model hertz tangential history"
WATCHED = 1e-3  # s: between looks at the mass that is left, and so the error of the times of events


def pair(scene, a, b, key, default):
    for p in scene.get("pairs", []):
        if sorted(p["pair"]) == sorted((a, b)):
            return p.get(key, default)
    return default


def fallen(disc, discs):
    """the hole of a disc; 0 where another one lies in it"""
    plugs = [d for d in discs if d is not disc and d["center"] == disc["center"] and not d.get("hole")]
    return 0 if any(d["radius"] >= disc.get("hole", 0) for d in plugs) else disc.get("hole", 0)


def walls_of(scene, until, folder, order):
    """lines of the input; walls of the scene by the fixes that store their forces"""
    lines, fixes, last = [], {}, []
    there = [(k, w) for k, w in enumerate(scene["walls"]) if w.get("until", math.inf) > until]
    discs = [w["disc"] for _, w in there if "disc" in w]
    for k, wall in there:
        drives = wall.get("drives", [])
        if "cylinder" in wall:
            axis = np.flatnonzero(wall["cylinder"]["axis"])
            if len(axis) != 1 or any(np.delete(wall["cylinder"]["point"], axis)):
                run.refuse("cylinder that is not about an axis")
            name = "xyz"[list(order).index(axis[0])]
            turn = ""
            if drives:  # LIGGGHTS turns cylinders about y by no key
                turn = f" shear {'yzx'['xyz'.index(name)]} {sum(d['speed'] * d['axis'][axis[0]] for d in drives):.17g}"
            lines.append(f"fix w{k} all wall/gran {MODEL} primitive type 2 {name}cylinder {wall['cylinder']['radius']:.17g} 0 0{turn} store_force yes")
        elif "disc" in wall:
            disc = wall["disc"]
            hole, height, wide = fallen(disc, discs), disc["center"][2], 1.2 * disc["radius"]
            if "hole" not in disc and len(discs) > 1:
                continue  # it lies in another one
            if hole:
                faces = liggghts.band(liggghts.ring(hole, height), liggghts.ring(wide, height))
            else:
                corner = [(s * wide, t * wide, height) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                faces = [(corner[0], corner[1], corner[2]), (corner[0], corner[2], corner[3])]
            liggghts.write_stl(os.path.join(folder, f"wall{k}.stl"), faces)
            lines += [f"fix m{k} all mesh/surface file wall{k}.stl type 2",
                      f"fix w{k} all wall/gran {MODEL} mesh n_meshes 1 meshes m{k} store_force yes"]
            for drive in drives:
                lift = drive["speed"] * drive["along"][2]
                last.append(f"fix v{k} all move/mesh mesh m{k} linear 0 0 {lift:.17g}")
        else:
            run.refuse("wall like " + json.dumps(wall))
        fixes[k] = f"w{k}"
    return lines + last, fixes


def input_of(scene, bodies, box, args, begin, folder, order):
    """data and input of LIGGGHTS; gives dt, steps of a frame, and walls by fix"""
    modulus = float(dict(s.split("=") for s in args.set).get("modulus", 5e6))
    radius, mass = (np.array([b[key] for b in bodies]) for key in ("radius", "mass"))
    every = min(float(args.every.rstrip("s")), args.until - begin)
    dt = every / math.ceil(every / liggghts.time_step({"radius": radius, "mass": mass}, modulus))
    lines, fixes = walls_of(scene, args.until, folder, order)
    density = mass / (4 / 3 * math.pi * radius ** 3)
    with open(os.path.join(folder, "data"), "w", encoding="ascii") as f:
        f.write(f"balls\n\n{len(bodies)} atoms\n2 atom types\n")
        f.writelines(f"{low:.9g} {high:.9g} {name}lo {name}hi\n" for (low, high), name in zip(box[order], "xyz"))
        f.write("\nAtoms\n\n")
        for k, b in enumerate(bodies):
            f.write("%d 1 %.17g %.17g %.17g %.17g %.17g\n" % (k + 1, 2 * radius[k], density[k], *np.array(b["position"])[order]))
        f.write("\nVelocities\n\n")
        for k, b in enumerate(bodies):
            f.write("%d %.17g %.17g %.17g %.17g %.17g %.17g\n" % (k + 1, *np.array(b["velocity"])[order], *np.array(b["angular_velocity"])[order]))
    kinds = ("ball", "wall")

    def matrix(key):
        return " ".join("%g" % max(pair(scene, a, b, key, scene.get(key, 0)), 0.06 if key == "e_n" else 0) for a in kinds for b in kinds)

    periodic = np.array(scene["cell"].get("repeats", [True] * 3) if "cell" in scene else [False] * 3)[order]
    gravity = np.array(scene.get("gravity", [0, 0, -9.81]))[order]
    columns = "id x y z vx vy vz omegax omegay omegaz" + "".join(f" f_force_{w}[{c}]" for w in fixes.values() for c in (1, 2, 3))
    frame = round(every / dt)
    with open(os.path.join(folder, "in"), "w", encoding="ascii") as f:
        f.write("\n".join([
            "atom_style granular", "atom_modify map array sort 1000 %.6g" % (3 * radius.mean()), "communicate single vel yes",
            "boundary " + " ".join("p" if p else "f" for p in periodic), "newton off", "units si", "read_data data",
            "neighbor %.6g bin" % (radius.mean() / 2), "neigh_modify delay 0", f"fix e all property/global youngsModulus peratomtype {modulus:g} {modulus:g}",
            f"fix nu all property/global poissonsRatio peratomtype {liggghts.NU} {liggghts.NU}",
            f"fix cor all property/global coefficientRestitution peratomtypepair 2 {matrix('e_n')}",
            f"fix mu all property/global coefficientFriction peratomtypepair 2 {matrix('mu')}",
            f"pair_style gran {MODEL}", "pair_coeff * *", f"timestep {dt:.17g}",
            "fix g all gravity %.17g vector %.17g %.17g %.17g" % (np.linalg.norm(gravity), *gravity / np.linalg.norm(gravity)), *lines,
            "fix motion all nve/sphere", "variable m equal mass(all)", "thermo_style custom step atoms v_m", f"thermo {max(1, round(WATCHED / dt))}",
            "thermo_modify lost ignore norm no flush yes format float %.17g", f"dump d all custom {frame} dump {columns}",
            "dump_modify d sort id format \"%d" + " %.12g" * (9 + 3 * len(fixes)) + "\"", f"run {round((args.until - begin) / dt)}", ""]))
    return dt, fixes


def dumped(path):
    """step and rows of each frame"""
    with open(path, encoding="ascii") as f:
        while f.readline():
            step = int(f.readline())
            f.readline()
            n = int(f.readline())
            for _ in range(5):
                f.readline()
            yield step, np.array([f.readline().split() for _ in range(n)], float).reshape(n, -1)


def write_events(path, log, begin, dt):
    left = None
    with open(path, "w", encoding="ascii") as f:
        for line in open(log, encoding="ascii"):
            word = line.split()
            if len(word) != 3 or not word[0].isdigit() or not word[1].isdigit():
                continue
            mass = float(word[2])
            if left is not None and mass < left * (1 - 1e-12):
                print(json.dumps({"event": "removed", "time": begin + int(word[0]) * dt, "mass": left - mass}), file=f)
            left = mass


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("-o", dest="out", required=True)
    parser.add_argument("--until", type=float, required=True)
    parser.add_argument("--every", required=True)
    parser.add_argument("--set", action="append", default=[], help="modulus=5e6: Young's modulus, Pa")
    args, _ = parser.parse_known_args()
    if not shutil.which("liggghts"):
        print("run_liggghts.py: liggghts is not installed", file=sys.stderr)
        sys.exit(69)
    with tempfile.TemporaryDirectory() as folder:
        start, scene, bodies = run.start_of(folder)
        begin, step = scene.get("time", 0), scene["dt"]
        axis = next((np.flatnonzero(w["cylinder"]["axis"])[0] for w in scene["walls"] if "cylinder" in w), 2)
        order = np.roll(np.arange(3), -axis) if axis == 1 else np.arange(3)  # a cylinder along y is turned, to lie along x
        radius = np.array([b["radius"] for b in bodies])
        x = np.array([b["position"] for b in bodies])
        wide = max([w["cylinder"]["radius"] for w in scene["walls"] if "cylinder" in w], default=0)
        box = np.array([x.min(0) - 4 * radius.max(), x.max(0) + 4 * radius.max()]).T
        box = np.array([[min(a, -1.3 * wide), max(b, 1.3 * wide)] for a, b in box])
        origin, edges, rates = run.box_of(start)
        for c in range(3):
            if "cell" in scene and scene["cell"].get("repeats", [True] * 3)[c]:
                box[c] = [origin[c], origin[c] + edges[c][c]]
        for gone in scene.get("remove", []):  # what leaves the bounds is lost
            box[2][0] = gone["below"]["point"][2]
        dt, fixes = input_of(scene, bodies, box, args, begin, folder, order)
        done = subprocess.run(["liggghts", "-in", "in", "-log", "log"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode:
            print(done.stdout[-2000:], file=sys.stderr)
            sys.exit(70)
        write_events(args.out + ".events", os.path.join(folder, "log"), begin, dt)
        cell = np.zeros(18) if edges is None else np.concatenate([edges.ravel(), rates.ravel()])
        back, frames, deepest, count = np.argsort(order), [], 0, 0
        with open(args.out + ".wall", "w", encoding="ascii") as wall:
            for count, rows in dumped(os.path.join(folder, "dump")):
                body = rows[:, 0].astype(int) - 1
                here, v, w = (rows[:, c:c + 3][:, back] for c in (1, 4, 7))
                frames.append((np.concatenate([[count * dt], cell]), np.column_stack([body, here, v, w])))
                deepest = max(deepest, overlap(here, radius[body]))
                for n, k in enumerate(fixes):
                    force = rows[:, 10 + 3 * n:13 + 3 * n][:, back]
                    way = here * [-1, -1, 0] if "cylinder" in scene["walls"][k] else np.tile([0, 0, 1.0], (len(here), 1))
                    normal = (force * way).sum(1) / np.maximum(np.linalg.norm(way, axis=1), 1e-30)
                    for i in np.flatnonzero(np.abs(force).sum(1) > 0):
                        print(json.dumps([round((begin + count * dt) / step), k, here[i][2], normal[i] * step, force[i][2] * step]), file=wall)
        print(f"ov/r {deepest:.3g}", f"steps {count}", sep="\n", file=sys.stderr)
        if "remove" in scene:
            frames = frames[-1:]
        run.write(start, frames, args.out, begin, step)


if __name__ == "__main__":
    main()
