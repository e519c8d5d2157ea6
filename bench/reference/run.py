#!/usr/bin/python3
"""run.py [-o OUT.h5] --until T --every T [--set KEY=VALUE] <FILE.h5: the scene of a document, from its last frame, by dem.c.

OUT.h5 is a trajectory that nsd-info and nsd-stat read. Beside it OUT.h5.rows has the stress, the solid fraction and the mean
number of contacts of each interval of a periodic cell, from the forces of dem.c. A scene that dem.c cannot express is refused (65).
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np


def refuse(what):
    print(f"run.py: dem.c has no {what}", file=sys.stderr)
    sys.exit(65)


def nsd(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def vector(v):
    return (list(v) + [0, 0, 0])[:3]


def walls_of(scene, dim, time, arguments):
    """walls: planes, which a segment is where grains do not pass its ends, and a circle about the origin that rotates"""
    for wall in scene.get("walls", []):
        until = wall.get("until", math.inf) - time
        if until <= 0:
            continue
        if "circle" in wall:
            drives = wall.get("drives", [])
            if any(wall["circle"]["center"]) or any(set(d) - {"about", "speed"} for d in drives):
                refuse("such a circle")
            arguments += [f"crad={wall['circle']['radius']}", f"comega={sum(d['speed'] for d in drives)}"]
        elif "drives" in wall or "load" in wall:
            refuse("moving walls")
        elif "point" in wall:
            arguments.append("wall=" + ",".join(f"{v:.17g}" for v in vector(wall["point"]) + vector(wall["normal"]) + [min(until, 1e300)]))
        elif "segment" in wall:
            a, b = (np.array(p, float) for p in wall["segment"])
            n = np.array([a[1] - b[1], b[0] - a[0]]) / np.linalg.norm(b - a)
            arguments.append("wall=" + ",".join(f"{v:.17g}" for v in vector(a) + vector(n) + [min(until, 1e300)]))
        else:
            refuse("wall like " + json.dumps(wall))


def cell_of(scene, dim, edges, rates, arguments):
    cell = scene.get("cell")
    if cell is None:
        return
    periodic = cell.get("repeats", [True] * dim)
    arguments.append("per=" + "".join("1" if p else "0" for p in vector(periodic)))
    arguments.append("H=" + ",".join(f"{v:.17g}" for v in edges.ravel()))
    arguments.append("Hd=" + ",".join(f"{v:.17g}" for v in rates.ravel()))
    for i, row in enumerate(cell.get("gradient", [])):
        arguments += [f"L{i}{k}={v}" for k, v in enumerate(row) if v]
    stress = cell.get("stress", {})
    if "pressure" in stress:
        target = [[stress["pressure"] if i == k else None for k in range(dim)] for i in range(dim)]
    else:
        target = stress.get("target", [])
    for i, row in enumerate(target):
        arguments += [f"P{i}{k}={v}" for k, v in enumerate(row) if v is not None]
    if target:
        arguments.append(f"M={stress['mass']}")


def arguments_of(scene, dim, time):
    gravity = vector(scene.get("gravity", [0, -9.81] if dim == 2 else [0, 0, -9.81]))
    out = [f"dim={dim}", f"mu={scene.get('mu', 0)}", f"e={scene.get('e_n', 0)}"] + [f"g{c}={g:.17g}" for c, g in zip("xyz", gravity)]
    for pair in scene.get("pairs", []):
        if sorted(pair["pair"]) != ["ball", "wall"]:
            refuse("kinds of grains")
        if "mu" in pair:
            out.append(f"muw={pair['mu']}")
    if any(key in scene for key in ("rolling", "pour", "bonds", "liquid", "stiffness")):
        refuse("rolling friction, inlets, bonds, liquid, or stiffness of a scene")
    if scene.get("cohesion"):
        out += [f"coh={scene['cohesion']['force']}", f"range={scene['cohesion'].get('range', 0)}"]
    for remove in scene.get("remove", []):
        out.append("outside=" + ",".join(str(x) for x in remove["outside"]["x"]))
    walls_of(scene, dim, time, out)
    return out


def frames_of(path):
    """time, edges, their rates, rows of body and x, v, w"""
    head, rows = None, []
    with open(path, encoding="ascii") as file:
        for line in file:
            if line.startswith("frame"):
                if head is not None:
                    yield head, np.array(rows)
                head, rows = np.array(line.split()[1:], float), []
            else:
                rows.append(np.array(line.split(), float))
    if head is not None:
        yield head, np.array(rows)


def write(start, frames, out, begin, dt):
    """the document START with other frames; bodies that were removed are missing in all"""
    alive = frames[-1][1][:, 0].astype(int)
    with h5py.File(start, "r") as old, h5py.File(out, "w") as new:
        for name in old:
            old.copy(old[name], new, name)
        new.attrs.update(old.attrs)
        for name in ("contacts", "nsd/bonds", "nsd/memory", "nsd/solver", "nsd/account"):
            if name in new:
                del new[name]
        every, cell = new["particles/all"], new["particles/all/box"]
        count = every["radius"].shape[0]
        time = np.array([begin + f[0][0] for f in frames])
        step = np.round(time / dt).astype(np.int64)
        for name in list(every):
            if isinstance(every[name], h5py.Dataset) and every[name].shape[:1] == (count,):
                put(every, name, every[name][()][alive])

        def series(group, values):
            """all frames of a quantity; None: the last one of the start"""
            if values is None:
                values = np.repeat(group["value"][-1:], len(frames), axis=0)
                if values.shape[1:2] == (count,):
                    values = values[:, alive]
            put(group, "value", values)

        pick = [f[1][np.isin(f[1][:, 0].astype(int), alive)] for f in frames]
        for name, columns in (("position", slice(1, 4)), ("velocity", slice(4, 7)), ("angular_velocity", slice(7, 10))):
            series(every[name], np.array([p[:, columns] for p in pick]))
        for name in ("orientation", "image"):
            if name in every:
                series(every[name], None)
        if "edges" in cell and "value" in cell["edges"]:
            series(cell["edges"], np.array([f[0][1:10].reshape(3, 3) for f in frames]))
            if "rate" in cell:
                series(cell["rate"], np.array([f[0][10:19].reshape(3, 3) for f in frames]))
        for name, values in (("step", step), ("time", time)):
            share(new, name, values)


def put(group, name, values):
    attributes, kind = dict(group[name].attrs), group[name].dtype
    del group[name]
    made = group.create_dataset(name, data=np.asarray(values).astype(kind))
    made.attrs.update(attributes)
    return made


def share(group, name, values, made=None):
    """steps and times of all series are one dataset with a name in each of them"""
    for member in list(group):
        if isinstance(group[member], h5py.Group):
            made = share(group[member], name, values, made)
    if "value" in group and name in group:
        if made is None:
            return put(group, name, values)
        del group[name]
        group[name] = made
    return made


def start_of(work):
    """the last frame of standard input as a document in the folder, its scene and its bodies"""
    start = os.path.join(work, "start.h5")
    with open(start + ".in", "wb") as file:
        file.write(sys.stdin.buffer.read())
    with open(start, "wb") as file:
        subprocess.run(["nsd-cat", "--last", start + ".in"], check=True, stdout=file)
    return start, json.loads(nsd("nsd-info", "--scene", start)), [json.loads(line) for line in nsd("nsd-info", "-b", start).splitlines()]


def box_of(start):
    """origin, edges and their rates; None: it has none"""
    with h5py.File(start, "r") as file:
        box = file["particles/all/box"]
        origin = box["origin"][()] if "origin" in box else np.zeros(3)
        if "edges" not in box:
            return origin, None, None
        edges = box["edges/value"][-1] if isinstance(box["edges"], h5py.Group) else np.diag(box["edges"][()])
        return origin, edges, box["rate/value"][-1] if "rate" in box else np.zeros((3, 3))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("-o", dest="out", required=True)
    parser.add_argument("--until", type=float, required=True)
    parser.add_argument("--every", required=True)
    parser.add_argument("--set", action="append", default=[], help="argument of dem.c: kn=1e6")
    parser.add_argument("--dem", default=os.path.join(os.path.dirname(__file__), "../../build/reference/dem"))
    args, _ = parser.parse_known_args()
    with tempfile.TemporaryDirectory() as work:
        start, scene, bodies = start_of(work)
        origin, edges, rates = box_of(start)
        dim, dt, time = scene.get("dim", 3), scene["dt"], scene.get("time", 0)
        arguments = arguments_of(scene, dim, time)
        if edges is not None:
            cell_of(scene, dim, edges, rates, arguments)
        if np.any(origin) and "cell" in scene:
            refuse("cell whose corner is not the origin")
        with open(os.path.join(work, "start.txt"), "w", encoding="ascii") as file:
            for body in bodies:
                if body.get("shape", "ball") != "ball":
                    refuse("shapes")
                numbers = [*body["position"], body["radius"], body["mass"], *body["velocity"], *body["angular_velocity"]]
                print(*(f"{n:.17g}" for n in numbers), 0 if body["mass"] > 0 else 1, file=file)
        every = float(args.every.rstrip("s"))
        frames = os.path.join(work, "frames")
        command = [args.dem, os.path.join(work, "start.txt"), *arguments, *args.set, f"T={args.until - time:.17g}", f"every={min(every, args.until - time):.17g}",
                   f"frames={frames}"]  # fmt: skip
        if "cell" in scene and "stress" in scene["cell"]:
            command.append(f"rows={args.out}.rows")
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        print(" ".join(command[2:]), done.stdout, sep="\n", file=sys.stderr)
        if done.returncode:
            sys.exit(70)
        all_frames = list(frames_of(frames))
        if "remove" in scene:
            all_frames = all_frames[-1:]
        write(start, all_frames, args.out, time, dt)


if __name__ == "__main__":
    main()
