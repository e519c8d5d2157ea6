"""What nsd is compared with besides other codes: itself with four times as many small steps; piles that rest; CPU against the number
of balls; where the CPU goes."""
import os
import shutil
import subprocess

import codes
import numpy as np
from jobs import COMPARED, JOBS

FINE = ["--small-steps", "0.0025"]  # the finer run: a quarter of the default


def compared(name, curve):
    """The mean over the second half of a run."""
    key = COMPARED.get(name) or [k for k in curve if k != "t"][0]
    half = [v for t, v in zip(curve["t"], curve[key]) if t >= curve["t"][-1] / 2]
    return key, float(np.mean(half))


def check(name, peers, seeds):
    """The mean difference of defaults and fine over seeds, with its error, and the scatter of one run."""
    job = JOBS[name]
    count = job.balls[1]
    span = job.span[1]
    default, fine, cost = [], [], [0, 0]
    for seed in range(1, seeds + 1):
        folder = os.path.join(peers.OUT, "check", f"{name}-{count}-{seed}")
        scene, document, about = peers.prepare(name, count, seed, 1, folder)
        pair = []
        for k, options in enumerate(([], FINE)):
            result = peers.one(name, "nsd", scene, document, about, span, folder, options, bound=20 * peers.BOUND)
            if result["cut"]:
                raise RuntimeError(f"{name}: stopped at the bound of {20 * peers.BOUND} s: a larger --bound")
            cost[k] += result["cpu"]
            pair.append(compared(name, result["series"]))
        default.append(pair[0][1])
        fine.append(pair[1][1])
    difference = np.array(default) / np.array(fine) - 1
    return {"job": name, "balls": count, "options": " ".join(FINE), "observable": pair[0][0], "seeds": seeds, "default": float(np.mean(default)),
            "fine": float(np.mean(fine)), "difference": float(difference.mean()),
            "error": float(difference.std(ddof=1) / seeds ** 0.5), "scatter": float(np.std(default, ddof=1) / abs(np.mean(default))),
            "cost": cost[1] / cost[0]}


# What the effort is varied by: the way of the fastest body in a small step, in radii; one solve per step
VARIED = "settling", "drum"
SETTINGS = 0.04, 0.02, 0.01, 0.005, 0.0025, 0


def effort(name, peers, seeds):
    """The observable, the CPU and the largest overlap by the size of small steps, means over seeds."""
    job = JOBS[name]
    rows = []
    for value in SETTINGS:
        found, cpu, sweeps, overlap = [], 0, 0, 0
        for seed in range(1, seeds + 1):
            scene, document, about = peers.prepare(name, job.balls[1], seed, 1, os.path.join(peers.OUT, "check", f"{name}-{job.balls[1]}-{seed}"))
            result = peers.one(name, "nsd", scene, document, about, job.span[1], os.path.join(peers.OUT, "effort", name), ["--small-steps", repr(value)],
                               bound=20 * peers.BOUND)
            found.append(compared(name, result["series"])[1])
            cpu += result["cpu"] / result["span"] / seeds
            sweeps += result["sweeps"] / seeds
            overlap = max(overlap, result["overlap"])
        rows.append({"value": value, "default": value == 0.01, "found": float(np.mean(found)), "error": float(np.std(found, ddof=1) / seeds ** 0.5),
                     "cpu": cpu, "sweeps": sweeps, "overlap": overlap})
    return {"job": name, "balls": job.balls[1], "seeds": seeds, "observable": compared(name, result["series"])[0], "rows": rows}


def rest(peers, balls=500, settle=3.0, steps=100000):
    """A bed that has settled, over many steps: energy, displacements, overlap."""
    folder = os.path.join(peers.OUT, "rest")
    scene, document, about = peers.prepare("settling", balls, 1, 0, folder)
    settled, long = os.path.join(folder, "bed.h5"), os.path.join(folder, "long.h5")
    codes.timed(["nsd-step", "--until", repr(settle), "--every", "1000000", "-o", settled, document], folder, 600)
    codes.timed(["nsd-step", "-n", str(steps), "--every", str(steps // 10), "-o", long, settled], folder, 3600)
    # a ball that touches fewer than three others or walls may roll for ever: nothing brakes that
    solved = os.path.join(folder, "solved.h5")
    with open(solved, "wb") as out:
        subprocess.run("nsd-cat --last long.h5 | nsd-detect | nsd-solve", shell=True, cwd=folder, stdout=out, stderr=subprocess.DEVNULL, check=True)
    contacts = codes.nsd.last(solved).contacts
    touch = np.zeros(balls, int)
    for side in contacts.a, contacts.b:
        np.add.at(touch, side[(side >= 0) & (contacts.reaction[:, 0] > 0)], 1)
    held = touch >= 3
    first = codes.nsd.last(settled)
    start, r = first.position[:], first.radius[:]
    rows = []
    for frame in codes.nsd.frames(long):
        way = np.sqrt(((frame.position[:] - start) ** 2).sum(1)) / (2 * r.mean())
        kinetic = (0.5 * frame.mass[:] * (frame.velocity[:] ** 2).sum(1)).mean() / (frame.mass[:].mean() * about["g"] * 2 * r.mean())
        rows.append({"step": frame.step - first.step, "kinetic": float(kinetic), "median": float(np.median(way[held])),
                     "held": float(way[held].max()), "largest": float(way.max()),
                     "overlap": float(frame.report["max_overlap"] / r.min())})
    os.remove(long)
    return {"balls": balls, "settle": settle, "steps": steps, "dt": scene["dt"], "loose": int((~held).sum()), "rows": rows}


def growth(peers, sizes, steps=50):
    """CPU of a step, of beds that fall and then rest, and the exponent between the first and the last."""
    rows = []
    for count in sizes:
        folder = os.path.join(peers.OUT, "growth")
        shutil.rmtree(folder, ignore_errors=True)
        scene, document, about = peers.prepare("settling", count, 1, 0, folder)
        # until three times the time in which the highest falls
        until = 3 * (2 * 3 * about["side"] * 0.58 / about["g"]) ** 0.5
        settled, out = os.path.join(folder, "bed.h5"), os.path.join(folder, "out.h5")
        fall = codes.timed(["nsd-step", "--until", repr(until), "--every", "1000000", "-o", settled, document], folder, 3600)
        none = codes.timed(["nsd-step", "-n", "0", "-o", os.path.join(folder, "none.h5"), settled], folder, 600)
        at_rest = codes.timed(["nsd-step", "-n", str(steps), "--every", "1000000", "-o", out, settled], folder, 600)
        rows.append({"balls": count, "steps": steps, "cpu": at_rest["cpu"] - none["cpu"], "falling": fall["cpu"] / (until / scene["dt"]),
                     "sweeps": codes.made(folder, out, scene["dt"], 600)["sweeps"]})
        peers.say(f"growth: {rows[-1]}")
        shutil.rmtree(folder)

    def exponent(values):
        return float(np.polyfit(np.log([r["balls"] for r in rows]), np.log(values), 1)[0])

    return {"rows": rows, "exponent": exponent([r["cpu"] for r in rows]), "falling": exponent([r["falling"] for r in rows])}


def profile(name, peers, count):
    """The functions of nsd-step that take most of the CPU, in per cent, by perf."""
    if not shutil.which("perf"):
        return None
    folder = os.path.join(peers.OUT, name)
    _, document, _ = peers.prepare(name, count, 1, int(peers.QUICK), folder)
    span = min(JOBS[name].span[int(peers.QUICK)], 0.3)
    data = os.path.join(folder, "perf.data")
    codes.timed(["perf", "record", "-q", "-F", "400", "-o", data, "nsd-step", "--until", repr(span), "--every", "1000000", "-o", os.path.join(folder, "perf.h5"), document], folder, peers.BOUND)
    said = subprocess.run(["perf", "report", "-i", data, "--stdio", "--no-children", "--sort", "symbol", "--percent-limit", "2"],
                          capture_output=True, text=True, check=True).stdout
    os.remove(data)
    rows = [line.split() for line in said.splitlines() if line.strip() and not line.startswith("#")]
    return [(word[2], float(word[0].rstrip("%"))) for word in rows if len(word) > 2 and word[0].endswith("%")][:14]
