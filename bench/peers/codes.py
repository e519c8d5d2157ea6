"""Runs of nsd, LIGGGHTS and Yade: what they cost, and frames of what they found.

Every run has a bound of CPU seconds, after which it is stopped; its cost is then that of the time it has simulated.
"""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "python"))
import nsd  # noqa: E402
import liggghts  # noqa: E402

PROGRAM = {"nsd": "nsd-step", "liggghts": os.environ.get("LIGGGHTS", "liggghts"), "yade": os.environ.get("YADE", "yade")}
FRAMES = 40  # of a run


def installed(code):
    return shutil.which(PROGRAM[code]) is not None


def version(code):
    """As it calls itself."""
    said = subprocess.run({"nsd": ["nsd-step", "--version"], "liggghts": [PROGRAM["liggghts"], "-help"], "yade": [PROGRAM["yade"], "--version"]}[code],
                          capture_output=True, text=True, timeout=60, cwd=tempfile.gettempdir()).stdout.splitlines()  # LIGGGHTS leaves a log
    said = said[0].replace("LIGGGHTS (Version LIGGGHTS-PUBLIC ", "LIGGGHTS ").split(",")[0] if said else code
    return said.replace("nsd-step (nsd)", "nsd").replace("version: ", "").strip()


TICK = os.sysconf("SC_CLK_TCK")


def used_by(session):
    """CPU seconds of the processes of a session that are there, with those of children that have ended; MiB of them."""
    total = memory = 0
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{pid}/stat") as f:
                word = f.read().rpartition(")")[2].split()
        except OSError:
            continue
        if int(word[3]) != session:
            continue
        total += sum(map(int, word[11:15]))
        try:
            with open(f"/proc/{pid}/status") as f:
                memory += sum(int(line.split()[1]) for line in f if line.startswith("VmHWM"))
        except OSError:
            pass
    return total / TICK, memory / 1024


def timed(command, folder, bound):
    """CPU and wall seconds, MiB, whether it was stopped at the bound of CPU seconds. Another failure is an error."""
    with open(os.path.join(folder, "said"), "w") as said:
        start = time.monotonic()
        child = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=said, stderr=said, start_new_session=True,
                                 env={**os.environ, "OMP_WAIT_POLICY": "passive"})
        stopped, cpu, memory, looked = None, 0, 0, start
        try:
            while True:
                pid, status, used = os.wait4(child.pid, os.WNOHANG)
                if pid:
                    break
                now = time.monotonic()
                if now - looked > min(0.1, 0.2 * (now - start)):  # not ru_maxrss, in which is what this process had when it forked
                    cpu, memory, looked = *map(max, (cpu, memory), used_by(child.pid)), now
                if stopped is None and (cpu > bound or now - start > 20 * bound):
                    stopped = now
                    os.killpg(child.pid, signal.SIGTERM)
                elif stopped and now - stopped > 60:
                    os.killpg(child.pid, signal.SIGKILL)
                time.sleep(0.005)
        except BaseException:
            os.killpg(child.pid, signal.SIGTERM)
            raise
        wall = time.monotonic() - start  # a step that was begun is ended, and counts
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode and stopped is None:
        raise RuntimeError(f"{' '.join(command)} ended with {child.returncode}:\n" + open(os.path.join(folder, "said")).read()[-2000:])
    # what mpirun's processes have used mpirun does not say where it was stopped
    return {"cpu": max(cpu, used.ru_utime + used.ru_stime), "wall": wall, "memory": memory, "cut": stopped is not None}


class TooSlow(Exception):
    """Nothing was simulated before the bound."""


def gen(scene, folder, name):
    """A document of a scene; its table, if it has one, beside it."""
    scene = dict(scene)
    table = scene.pop("table", None)
    if table:
        with open(os.path.join(folder, "table.txt"), "w") as f:
            f.write(table)
        scene["bodies"] = [{"file": os.path.join(folder, "table.txt")}]
    path = os.path.join(folder, name)
    with open(path + ".new", "wb") as out:
        subprocess.run(["nsd-gen", "-"], input=json.dumps(scene).encode(), stdout=out, check=True)
    os.rename(path + ".new", path)
    return path


def balls_of(document):
    """x, v, radius, mass, kind, as arrays."""
    frame = nsd.last(document)
    names = frame.file["nsd/material"].attrs["kinds"]
    names = (names.decode() if isinstance(names, bytes) else names).split("\n")
    return {"x": frame.position[:], "v": frame.velocity[:], "radius": frame.radius[:], "mass": frame.mass[:],
            "kind": np.array([names[k] for k in frame.material])}


def made(folder, out, dt, bound):
    """What a run of nsd has made: dt, span, steps, sweeps a step; the largest overlap and the steps that have not converged."""
    said = re.search(r"(\d+) steps?, (\d+) sweeps", open(os.path.join(folder, "said")).read())
    steps, sweeps = map(int, said.groups()) if said else (0, 0)
    if not steps:
        raise TooSlow(f"not a step in {bound:.3g} CPU s")
    kept = subprocess.run(["nsd-info", "--last", "-l", out], capture_output=True, text=True, check=True).stdout.splitlines()
    last = [line for line in map(json.loads, kept) if "account" in line][-1]
    return {"dt": dt, "span": last["time"], "steps": steps, "sweeps": sweeps / steps,
            **{key: last["account"].get(key, {}).get("value") for key in ("overlap", "unconverged")}}


def run_nsd(folder, start, span, options, threads, bound, **_):
    """Of the document start; frames have what is there."""
    out, dt = os.path.join(folder, "out.h5"), nsd.last(start).dt
    every = max(1, round(span / FRAMES / dt))  # no log: small steps would be judged, which costs a third of the run
    cost = timed(["nsd-step", "-j", str(threads), "--until", repr(span), "--every", str(every), "-o", out, *options, start], folder, bound)
    cost.update(made(folder, out, dt, bound))

    def frames():
        yield 0.0, nsd.last(start)
        for frame in nsd.frames(out):
            yield frame.time, frame

    return cost, ((t, {"x": f.position, "v": f.velocity, "radius": f.radius, "mass": f.mass}) for t, f in frames())


def run_liggghts(folder, start, span, scene, modulus, threads, bound, velocities, skin=None, **_):
    balls = balls_of(start)
    dt, every = liggghts.write(folder, scene, balls, modulus, span, FRAMES, velocities, threads, skin)
    command = [PROGRAM["liggghts"], "-in", "in", "-log", "log"]
    if threads > 1:
        command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1", "-n", str(threads)] + command
    cost = timed(command, folder, bound)
    rows, table = [], False
    for line in open(os.path.join(folder, "log")):  # step, atoms, cpu
        word = line.split()
        if word[:1] == ["Step"]:
            table = True
        elif table and len(word) == 3 and word[0].isdigit():
            rows.append(int(word[0]))
        elif line.startswith("ERROR"):
            raise RuntimeError(line)
    if not rows or not rows[-1]:
        raise TooSlow(f"no {max(1, every // 5)} steps in {bound:.3g} CPU s")
    cost.update(dt=dt, span=rows[-1] * dt, steps=rows[-1])

    def frames():
        with open(os.path.join(folder, "dump")) as f:
            while line := f.readline():
                if not line.startswith("ITEM: TIMESTEP"):
                    continue
                step = int(f.readline())
                f.readline()
                count = int(f.readline())
                while not f.readline().startswith("ITEM: ATOMS"):
                    pass
                text = [f.readline() for _ in range(count)]
                if not text or not text[-1].endswith("\n"):
                    return
                data = np.array([row.split() for row in text], dtype=float)
                k = data[:, 0].astype(int) - 1
                yield step * dt, {"x": data[:, 1:4], "v": data[:, 4:7], "radius": balls["radius"][k], "mass": balls["mass"][k]}

    return cost, frames()


def run_yade(folder, start, span, scene, modulus, threads, bound, **_):
    """The settling job alone: walls are those of a box."""
    balls = balls_of(start)
    np.savez(os.path.join(folder, "start.npz"), x=balls["x"], v=balls["v"], radius=balls["radius"],
             side=scene["walls"][0]["box"]["x"][1])
    dt = liggghts.time_step(balls, modulus)
    frame = max(1, round(span / FRAMES / dt))
    cost = timed([PROGRAM["yade"], "-n", "-x", "-j", str(threads), os.path.join(HERE, "settling.yade.py"), repr(modulus), repr(dt), str(round(span / dt)),
                  str(frame)], folder, bound)
    text = os.path.join(folder, "frames.txt")
    lines = [json.loads(line) for line in open(text)] if os.path.exists(text) else []
    if not lines or not lines[-1]["step"]:
        raise TooSlow(f"no {frame} steps in {bound:.3g} CPU s")
    cost.update(dt=dt, span=lines[-1]["step"] * dt, steps=lines[-1]["step"])

    def frames():
        for line in lines:
            data = np.load(os.path.join(folder, "frame%d.npy" % line["step"]))
            yield line["step"] * dt, {"x": data[:, :3], "v": data[:, 3:], "radius": balls["radius"], "mass": balls["mass"]}

    return cost, frames()


RUN = {"nsd": run_nsd, "liggghts": run_liggghts, "yade": run_yade}
