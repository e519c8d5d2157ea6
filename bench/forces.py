#!/usr/bin/python3
"""forces.py [--draw FOLDER BODIES.json] TRUTH OTHER...: contact by contact, each other one beside the truth; files of forces.sh, .json
of nsd-info -c whose name ends in the time step, or .txt of reference/dem.c. A row of a Markdown table each. --draw makes distribution.png, pairs.png and
chains.png of them instead: how large forces are, each beside that of the truth, and the strong ones in space."""
import json
import os
import subprocess
import sys

import numpy as np

NONE = 0, np.zeros(3)


def of_nsd(path):
    """F_n and the vector F_t on b, N, of each pair"""
    dt, found = float(os.path.basename(path)[:-5].split("_dt_")[1]), {}
    with open(path, encoding="ascii") as file:
        for row in map(json.loads, file):
            if "r" in row:
                t1, t2 = np.array(row["t1"]), np.array(row["t2"])
                found[tuple(row["body"])] = row["r"][0] / dt, (row["r"][1] * t1 + row["r"][2] * t2) / dt
    return found


def of_dem(path):
    found = {}
    with open(path, encoding="ascii") as file:
        for row in file:
            i, j, *f = row.split()
            across = np.array(f[1:], float)
            pair = (int(j), int(i)) if int(j) < 0 else (int(i), int(j))
            found[pair] = float(f[0]), -across if int(j) < 0 else across
    return found


def read(path):
    return of_nsd(path) if path.endswith(".json") else of_dem(path)


def explained(x, truth):
    return 1 - ((x - truth) ** 2).sum() / ((truth - truth.mean(axis=0)) ** 2).sum()


def title(path):
    return os.path.basename(path).rsplit(".", 1)[0].replace("_", " ")


def table(paths):
    truth = read(paths[0])
    mean = np.mean([f[0] for f in truth.values()])
    for path in paths[1:]:
        other = read(path)
        pairs = sorted(set(truth) | set(other))
        n, t = ([[np.array(f.get(p, NONE)[k]) / mean for p in pairs] for f in (other, truth)] for k in (0, 1))
        (n, n0), (t, t0) = map(np.array, n), map(np.array, t)
        loaded, loaded0 = n > 1e-6, n0 > 1e-6
        row = [title(path), loaded.sum(), (loaded & loaded0).sum(),
               f"{np.corrcoef(n, n0)[0, 1]:.3f}", f"{np.corrcoef(t.ravel(), t0.ravel())[0, 1]:.3f}", f"{explained(n, n0):.3f}",
               f"{explained(t, t0):.3f}", f"{np.sqrt(((n - n0) ** 2).mean()):.2f}"]  # fmt: skip
        print("|", " | ".join(map(str, row)), "|")


def plot(folder, name, size, commands):
    script = f"set terminal pngcairo size {size} font 'sans,13' background 'white'; set output '{folder}/{name}.png'; set border 3; set tics nomirror; "
    subprocess.run(["gnuplot", "-e", script + commands], check=True)


def draw(folder, bodies, paths):
    os.makedirs(folder, exist_ok=True)
    forces = [read(path) for path in paths]
    mean = np.mean([f[0] for f in forces[0].values()])
    with open(bodies, encoding="ascii") as file:
        x = np.array([body["x"] for body in json.load(file)]) * 1e3  # mm
    tables = []
    for k, found in enumerate(forces):
        n = np.array([f[0] for f in found.values()])
        counts, edges = np.histogram(n[n > 1e-6 * mean] / mean, bins=np.linspace(0, 6, 25), density=True)
        tables.append(f"{folder}/.distribution-{k}")
        np.savetxt(tables[-1], np.c_[(edges[1:] + edges[:-1]) / 2, counts][counts > 0])
    colours = ["#222222", "#888888", "#c05a1a", "#1f4e79"]
    curves = [f"'{path}' with linespoints lw 2 pt 7 ps 0.7 lc rgb '{colour}' title '{title(paths[k])}'" for k, (path, colour) in enumerate(zip(tables, colours))]
    plot(folder, "distribution", "720,460", "set logscale y; set xlabel 'normal force over its mean'; set ylabel 'probability density'; plot " + ", ".join(curves))
    panels = ""
    for k, found in enumerate(forces[1:], 1):
        pairs = sorted(set(found) | set(forces[0]))
        np.savetxt(f"{folder}/.pairs-{k}", [[forces[0].get(p, NONE)[0] / mean, found.get(p, NONE)[0] / mean] for p in pairs])
        tables.append(f"{folder}/.pairs-{k}")
        panels += f"set title '{title(paths[k])}'; plot '{tables[-1]}' with points pt 7 ps 0.35 lc rgb '{colours[k]}' notitle, x with lines lc rgb '#888888' notitle; "
    plot(folder, "pairs", "1080,420", "set multiplot layout 1,3; set size square; set xrange [0:6]; set yrange [0:6]; "
         f"set xlabel 'F_n / mean, {title(paths[0])}'; " + panels)
    panels = ""
    for k, found in enumerate(forces):
        tables.append(f"{folder}/.chains-{k}")
        with open(tables[-1], "w", encoding="ascii") as file:
            for (i, j), (n, _) in found.items():
                if i >= 0 and j >= 0 and n > mean:
                    print(*x[i, [0, 2]], *(x[j] - x[i])[[0, 2]], min(4, n / mean), file=file)
        widths = [f"'{tables[-1]}' using 1:($5 >= {low} && $5 < {low + 1} ? $2 : NaN):3:4 with vectors nohead lw {1.4 * low} lc rgb '{colours[k]}' notitle" for low in (1, 2, 3, 4)]
        panels += f"set title '{title(paths[k])}'; plot " + ", ".join(widths) + "; "
    ends = np.array([x[b] for found in forces for pair, (n, _) in found.items() for b in pair if min(pair) >= 0 and n > mean])
    low, high = ends.min(axis=0) - 0.2, ends.max(axis=0) + 0.2
    plot(folder, "chains", "1440,420", f"set multiplot layout 1,4; set size ratio -1; unset border; unset tics; set xrange [{low[0]}:{high[0]}]; "
         f"set yrange [{low[2]}:{high[2]}]; " + panels)
    for path in tables:
        os.remove(path)


if sys.argv[1] == "--draw":
    draw(sys.argv[2], sys.argv[3], sys.argv[4:])
else:
    table(sys.argv[1:])
