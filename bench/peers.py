#!/usr/bin/python3
"""peers.py [--quick] [--out DIR] [--jobs A,B] [--variants A,B] [--bound S] [--rounds N] [--mode cost|check|...]

make peers: nsd beside LIGGGHTS and Yade, where these are installed, on the jobs of bench/peers/jobs.py. A job's run that is
in DIR/JOB/VARIANT.json is not made again: remove the file to repeat it. The page is DIR/README.md, made by page.py from
these files alone. In the environment: NSD_STARTS, a folder with starts that others have made [../shared/benchmarks]; LIGGGHTS, YADE,
other names of these programs; N_JOB, T_JOB, another number of balls, another span in s, as N_DOSTA_SILO=10000.

  cost    CPU and wall seconds, memory, observables, overlaps          check   nsd beside its own run with four times as many small steps
  effort  what the size of small steps costs and changes: QUICK's jobs growth  CPU against the number of balls
  rest    a pile at rest over 1e5 steps                               profile where nsd's CPU goes, by perf
  page    DIR's page, of what is there                                keep    that in docs/peers
"""
import argparse
import json
import math
import os
import shutil
import signal
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "bench", "peers"))
try:
    import codes
    import observe
    import selfcheck
    from jobs import JOBS
except ImportError as trouble:
    sys.exit(f"peers: {trouble}: apt-get install python3-h5py")

VARIANTS = {  # in the order in which they are run: code, threads, what is different
    "nsd": ("nsd", 1, {}), "liggghts-soft": ("liggghts", 1, {"modulus": 0}), "nsd-one": ("nsd", 1, {"options": ["--small-steps", "0"]}),
    "liggghts-stiff": ("liggghts", 1, {"modulus": 1}), "nsd-2": ("nsd", 2, {}), "liggghts-soft-2": ("liggghts", 2, {"modulus": 0}),
    "yade-soft": ("yade", 1, {"modulus": 0}), "yade-soft-2": ("yade", 2, {"modulus": 0}),
}


def say(text):
    print("peers: " + text, file=sys.stderr, flush=True)


def save(path, result):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path + ".new", "w") as f:
        json.dump(result, f)
        f.write("\n")
    os.rename(path + ".new", path)


def number(x, digits=5):
    return x if isinstance(x, (int, str)) or x == 0 else round(x, digits - 1 - math.floor(math.log10(abs(x))))


def prepare(name, count, seed, quick, folder):
    """start.h5, the run's document, and its scene; what observables need."""
    job = JOBS[name]
    start, run, about = job.scenes(count, seed)
    dt = job.dt[quick]
    start["dt"] = job.start_dt
    os.makedirs(folder, exist_ok=True)
    settled = os.path.join(folder, "settled.h5")
    if not os.path.exists(settled):
        say(f"{name}: start of {count} balls, seed {seed}")
        first = codes.gen(start, folder, "fill.h5")
        if job.settle:
            with open(settled + ".new", "wb") as out:
                fall = subprocess.Popen(["nsd-step", "-j", "2", "--until", repr(job.settle), "--every", "1000000", first],
                                        stdout=subprocess.PIPE, stderr=open(os.path.join(folder, "settle.log"), "w"))
                subprocess.run(["nsd-cat", "--last"], stdin=fall.stdout, stdout=out, check=True)
                if fall.wait():
                    raise RuntimeError(f"{name}: no start: {folder}/settle.log")
            os.rename(settled + ".new", settled)
        else:
            os.rename(first, settled)
    scene = {k: v for k, v in start.items() if k not in ("bodies", "table")}
    scene.update({k: v for k, v in run.items() if k != "more"})
    scene.update(dt=dt, allow_overlap=True, bodies=[{"document": settled, "at_rest": True}] + run.get("more", []))
    document = codes.gen(scene, folder, "start.h5")
    balls = codes.balls_of(document)
    about.update(mass=balls["mass"].sum(), g=-scene["gravity"][2])
    return scene, document, about


def series(job, frames, about):
    """The observables over time: {"t": [...], NAME: [...]}, and the largest overlap of two balls in these frames, without the start."""
    out, overlap = {"t": []}, 0.0
    for t, frame in frames:
        row = getattr(observe, job.observe)(frame, about)
        if out["t"]:
            overlap = max(overlap, observe.overlap(frame["x"], frame["radius"]))
        out["t"].append(number(t))
        for key, value in row.items():
            out.setdefault(key, []).append(number(value))
    return out, overlap


def one(name, variant, scene, document, about, span, folder, options, bound=None):
    """A run of a variant: its cost and observables."""
    job = JOBS[name]
    code, threads, other = VARIANTS[variant]
    work = os.path.join(folder, "work")
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work)
    given = {"options": other.get("options", []) + options} if code == "nsd" else {"scene": scene, "modulus": job.modulus[other["modulus"]],
                                                      "velocities": True, "skin": job.skin}
    say(f"{name}: {variant}, {span} s")
    cost, frames = codes.RUN[code](work, document, span, threads=threads, bound=bound or BOUND, **given)
    curve, pairs = series(job, frames, about)
    result = {"variant": variant, "code": code, "threads": threads, **{k: v if v is None else number(v) for k, v in cost.items()},
              "pairs": number(pairs), "series": curve}
    if code != "nsd":
        result["modulus"] = job.modulus[other["modulus"]]
    shutil.rmtree(work)
    say(f"{name}: {variant}: {(cost['cpu'] or math.nan) / cost['span']:.4g} CPU s/s, wall {cost['wall']:.3g} s" + (", cut" if cost["cut"] else ""))
    return result


def cost(name, quick, out, rounds, chosen):
    job = JOBS[name]
    count = int(os.environ.get("N_" + name.upper().replace("-", "_"), job.balls[quick]))
    span = float(os.environ.get("T_" + name.upper().replace("-", "_"), job.span[quick]))
    folder = os.path.join(out, name)
    todo = [v for v, (code, _, _) in VARIANTS.items() if (code != "yade" or job.yade) and v in chosen]
    path = {v: os.path.join(folder, v + ".json") for v in VARIANTS}

    def runs(v):
        return json.load(open(path[v]))["runs"] if os.path.exists(path[v]) else []

    if all(len(runs(v)) >= rounds or not codes.installed(VARIANTS[v][0]) for v in todo):
        return
    scene, document, about = prepare(name, count, 1, quick, folder)
    for k in range(rounds):
        for v in todo:
            if not codes.installed(VARIANTS[v][0]):
                save(path[v], {"variant": v, "runs": [], "why": "not installed"})
            elif len(runs(v)) <= k:
                # two threads go as far as one came
                alone = runs(v[:-2])[-1]["span"] if v.endswith("-2") and runs(v[:-2]) else span
                try:
                    result = one(name, v, scene, document, about, min(span, alone), folder, [],
                                 BOUND if v in ("nsd", "nsd-2", "liggghts-soft") else BOUND / 3)
                except codes.TooSlow as why:
                    save(path[v], {"variant": v, "balls": count, "runs": [], "why": str(why)})
                    say(f"{name}: {v}: {why}")
                    continue
                curve = result.pop("series")
                kept = json.load(open(path[v])) if k and os.path.exists(path[v]) else {"series": curve, "runs": []}
                kept.update(variant=v, balls=count)
                kept["runs"].append(result)
                save(path[v], kept)


def kept(path, make):
    """What make gives, once."""
    if not os.path.exists(path):
        save(path, make())
    return json.load(open(path))


def gather(out, quick):
    """All results of a folder as one."""
    machine = subprocess.run(["bash", "-c", "cd '%s' && . bench/common.sh && machine && echo $results" % ROOT], capture_output=True,
                             text=True, check=True).stdout.split("\n")
    result = {"machine": machine[0], "name": os.path.basename(machine[1]), "quick": quick,
              "versions": [codes.version(c) for c in codes.PROGRAM if codes.installed(c)], "jobs": {}}
    for name in JOBS:
        variants = {}
        for v in VARIANTS:
            path = os.path.join(out, name, v + ".json")
            if os.path.exists(path):
                variants[v] = json.load(open(path))
        if "nsd" in variants:
            result["jobs"][name] = {"title": JOBS[name].title, "label": JOBS[name].label, "published": JOBS[name].balls[0],
                                      "balls": variants["nsd"]["balls"], "variants": variants}
            if os.path.exists(os.path.join(out, name, "profile.json")):
                result["jobs"][name]["profile"] = json.load(open(os.path.join(out, name, "profile.json")))
    for key in "check", "effort":
        found = [json.load(open(path)) for path in (os.path.join(out, key, name + ".json") for name in JOBS) if os.path.exists(path)]
        if found:
            result[key] = found
    for key in "rest", "growth":
        if os.path.exists(os.path.join(out, key + ".json")):
            result[key] = json.load(open(os.path.join(out, key + ".json")))
    return result


def write_page(out, quick):
    """results.json, README.md and the curves, of what there is."""
    result = gather(out, quick)
    path = os.path.join(out, result.pop("name") + ".json")
    save(path, result)
    text = subprocess.run([os.path.join(ROOT, "bench", "peers", "page.py"), path, "--plots", out], capture_output=True, text=True, check=True).stdout
    with open(os.path.join(out, "README.md"), "w") as f:
        f.write(text)
    say(os.path.join(out, "README.md"))
    return path


def keep(out, quick):
    """Where readers find it, docs/peers or KEEP: the results and the page."""
    path, to = write_page(out, quick), os.environ.get("KEEP", os.path.join(ROOT, "docs", "peers"))
    os.makedirs(to, exist_ok=True)
    for f in [path, os.path.join(out, "README.md")] + [os.path.join(out, name + ".svg") for name in JOBS]:
        if os.path.exists(f):
            shutil.copy(f, to)


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that what runs is stopped, too
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--out")
    parser.add_argument("--jobs", default=",".join(JOBS))
    parser.add_argument("--variants", default=",".join(VARIANTS))
    parser.add_argument("--bound", type=float, help="CPU seconds of a run of nsd and of LIGGGHTS, soft; others get a third")
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--sizes", default="1000,3000,10000,30000,100000")
    parser.add_argument("--mode", default="cost,page")
    args = parser.parse_args()
    QUICK, BOUND = args.quick, args.bound or (8 if args.quick else 600)
    OUT = os.path.abspath(args.out or os.path.join("build", "peers" + ("-quick" if args.quick else "")))
    peers = sys.modules[__name__]
    each = {
        "cost": lambda name: cost(name, int(QUICK), OUT, args.rounds, args.variants.split(",")),
        "check": lambda name: JOBS[name].given or kept(os.path.join(OUT, "check", name + ".json"), lambda: selfcheck.check(name, peers, args.seeds)),
        "effort": lambda name: name in selfcheck.VARIED and kept(os.path.join(OUT, "effort", name + ".json"), lambda: selfcheck.effort(name, peers, args.seeds)),
        "profile": lambda name: kept(os.path.join(OUT, name, "profile.json"),
                                     lambda: selfcheck.profile(name, peers, JOBS[name].balls[int(QUICK)])),
    }
    once = {
        "rest": lambda: kept(os.path.join(OUT, "rest.json"), lambda: selfcheck.rest(peers)),
        "growth": lambda: kept(os.path.join(OUT, "growth.json"), lambda: selfcheck.growth(peers, [int(n) for n in args.sizes.split(",")])),
        "page": lambda: write_page(OUT, QUICK),
        "keep": lambda: keep(OUT, QUICK),
    }
    wrong = [j for j in args.jobs.split(",") if j not in JOBS] + [m for m in args.mode.split(",") if m not in each and m not in once]
    wrong += [v for v in args.variants.split(",") if v not in VARIANTS]
    if wrong:
        parser.exit(64, f"peers: no job, variant or mode {', '.join(wrong)}: jobs are {', '.join(JOBS)}; variants {', '.join(VARIANTS)}; modes {', '.join([*each, *once])}\n")
    for mode in args.mode.split(","):
        for job_name in args.jobs.split(",") if mode in each else ():
            each[mode](job_name)
        if mode in once:
            once[mode]()
