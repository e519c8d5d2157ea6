#!/usr/bin/python3
"""page.py RESULTS.json ... [--plots DIR]: the page of make peers, from kept results, one file a machine (peers.py --mode
keep); with --plots the curves as well, DIR/JOB.svg of the first file, by gnuplot. It runs nothing and measures nothing."""
import json
import math
import os
import subprocess
import sys

ROWS = {  # variant: how it is called, how it is drawn
    "nsd": ("nsd", 1), "nsd-2": ("nsd, 2 threads", 0), "nsd-one": ("nsd, one solve per step", 2),
    "liggghts-soft": ("LIGGGHTS, soft", 3), "liggghts-soft-2": ("LIGGGHTS, soft, 2 processes", 0),
    "liggghts-stiff": ("LIGGGHTS, stiff", 4), "yade-soft": ("Yade, soft", 5), "yade-soft-2": ("Yade, soft, 2 threads", 0),
}
COLUMNS = "nsd", "nsd-one", "liggghts-soft", "liggghts-stiff"  # of the first table: CPU s/s
GOAL = 0.2  # CPU of nsd over LIGGGHTS'


def text(x, digits=3):
    if x is None:
        return ""
    if isinstance(x, str):
        return x
    shown = "%.*g" % (digits, x)
    return "%.*e" % (digits - 1, x) if "e" in shown and abs(x) < 1 else ("%d" % round(x) if "e" in shown else shown)


def row(*cells):
    return "| " + " | ".join(cells) + " |"


FEW = 10  # steps: a run of fewer says nothing of its cost


def per_second(kept, what):
    """Seconds of a physical second, the least of the rounds; None where it was not run or came to a few steps only."""
    runs = [r[what] / r["span"] for r in kept.get("runs", []) if r["steps"] >= FEW]
    return min(runs) if runs else None


def cost_text(kept):
    """CPU of a physical second, or why there is none."""
    if not kept.get("runs"):
        return kept.get("why", "")
    r = kept["runs"][-1]
    return text(per_second(kept, "cpu")) or f"{r['steps']} step{'s' * (r['steps'] > 1)} in {text(r['cpu'])} s"


def ratio(variants, a="nsd", b="liggghts-soft"):
    """CPU of a over that of b, by sums over the rounds that both have."""
    pair = [(per_second({"runs": [p]}, "cpu"), per_second({"runs": [q]}, "cpu"))
            for p, q in zip(variants.get(a, {}).get("runs", []), variants.get(b, {}).get("runs", []))
            if min(p["steps"], q["steps"]) >= FEW]
    return sum(p for p, _ in pair) / sum(q for _, q in pair) if pair else None


def at(curve, t):
    """The plotted number at a time, linear between frames."""
    name = [key for key in curve if key != "t"][0]
    times, values = curve["t"], curve[name]
    for k in range(1, len(times)):
        if times[k] >= t * (1 - 1e-9):
            share = (t - times[k - 1]) / (times[k] - times[k - 1])
            return values[k - 1] + share * (values[k] - values[k - 1])
    return None


NOTES = {"penetration": "A heavy ball that strikes light ones loses energy differently in the two codes. nsd's law of impact does not depend on the rate: "
         "from light balls that rest on a floor a heavy one rebounds with e v. The dashpots of LIGGGHTS, which give a pair of light balls the restitution e, "
         "hardly act on the heavy mass, and it keeps almost all its speed (0.800 against 1.980 m/s for e = 0.4 and 2 m/s, one light ball between; nsd-methods(7), "
         "Simultaneous impacts). In these runs the steel ball turns 3 mm higher in nsd, above the beads at the floor, and rebounds with about e v; in LIGGGHTS it "
         "hardly rebounds."}


def common_time(job):
    """The time that nsd and LIGGGHTS, soft, both have simulated."""
    return min([v["series"]["t"][-1] for k, v in job["variants"].items() if v.get("series") and k in ("nsd", "liggghts-soft")], default=0)


def blind(job):
    """Whether nsd and LIGGGHTS have the same observable, to four digits, until the shorter run ends."""
    last = {text(at(job["variants"].get(k, {}).get("series") or {"t": [], "": []}, common_time(job)), 4) for k in ("nsd", "liggghts-soft")}
    return len(last) == 1 and last != {""}


def job_section(name, job, quick):
    variants = job["variants"]
    out = [f"## {job['title'].replace(', a start by others', ', start published by others')}", ""]
    if job["balls"] != job["published"]:
        out += [f"Run here with {job['balls']} balls.", ""]
    common = common_time(job)
    out += [row("code", "dt, s", "simulated, s", "CPU s/s", "wall s/s", "MiB", f"{job['label'].split(',')[0]} at {text(common)} s", "overlap, r", "in the run, r"),
            row(*["---"] * 9)]
    for key, (title, _) in ROWS.items():
        v = variants.get(key)
        if v is None:
            continue
        if not v.get("runs"):
            out.append(row(title, v.get("why", "not run"), *[""] * 7))
            continue
        last = v["runs"][-1]
        if "modulus" in last:
            title += f" ({last['modulus']:.0e} Pa)".replace("e+0", "e")
        out.append(row(title, text(last["dt"]), text(last["span"]) + (", cut" if last["cut"] else ""), cost_text(v),
                       text(per_second(v, "wall")), text(max(r["memory"] for r in v["runs"])), text(at(v["series"], common), 4), text(last.get("pairs"), 2), text(last.get("overlap"), 2)))
    r = ratio(variants)
    if not variants["nsd"]["runs"]:
        return out + [""]
    own = variants["nsd"]["runs"][-1]
    out.append("")
    if r:
        out.append(f"nsd needs {text(r, 2)} times the CPU of LIGGGHTS, soft{'' if r <= GOAL else f', more than {GOAL}'}.")
    out.append(f"A step of {text(own['dt'])} s has {text(own['sweeps'])} sweeps" + (f"; {own['unconverged']} steps have not converged." if own.get("unconverged") else "."))
    if name.split("-given", maxsplit=1)[0] in NOTES:
        out += ["", NOTES[name.split("-given", maxsplit=1)[0]]]
    if job.get("profile"):
        out += ["", "Functions of nsd by CPU: " + ", ".join(f"{f} {share:.0f} %" for f, share in job["profile"]) + "."]
    if blind(job):
        out += ["", "Until then both codes have the same value to four digits: the run was stopped before the grains changed it."]
    values = seen(job)
    if len(values) == 1:  # a job that was cut before anything happened
        return out + ["", f"No picture: {job['label']} stays {text(values.pop())} over the time simulated.", ""]
    return out + ["", f"![{job['label']} over time]({name}.svg)", ""]


def seen(job):
    """all values of the first observable, of the variants that are drawn"""
    out = set()
    for key, (_, style) in ROWS.items():
        series = job["variants"].get(key, {}).get("series")
        if style and series:
            out.update(series[next(k for k in series if k != "t")])
    return out


def check_section(check):
    out = ["## nsd compared with four times as many small steps", "",
           "The finer run has the same start and the option of the column. The observable is the mean over the second half of "
           "the run; the difference is relative to the finer run; the scatter is the standard deviation of single runs with different seeds. "
           "A difference below the scatter is not significant.", "",
           row("job", "balls", "option of the finer run", "observable", "seeds", "defaults", "finer run", "difference", "its standard error", "scatter of a run", "CPU, finer / defaults"),
           row(*["---"] * 11)]
    for c in check:
        out.append(row(c["job"], text(c["balls"]), f"`{c['options']}`", c["observable"], text(c["seeds"]), text(c["default"], 4), text(c["fine"], 4),
                       f"{100 * c['difference']:+.2f} %", f"{100 * c['error']:.2f} %", f"{100 * c['scatter']:.2f} %", text(c["cost"])))
    return out + [""]


def effort_section(efforts):
    out = ["## Cost and effect of the size of small steps", "",
           "In a small step the fastest body moves by at most R radii of the smallest; 0: one solve per step. Means over the seeds, with the standard error of the mean.", ""]
    for e in efforts:
        out += [f"{e['job']}, {e['balls']} balls, {e['seeds']} seeds:", "",
                row("option", e["observable"], "CPU s/s", "sweeps per step", "largest overlap, r"), row(*["---"] * 5)]
        for r in e["rows"]:
            out.append(row((f"`--small-steps {text(r['value'])}`") + (", default" if r["default"] else ""), f"{text(r['found'], 4)} +- {text(r['error'], 2)}",
                           text(r["cpu"]), text(r["sweeps"]), text(r["overlap"])))
        out.append("")
    return out


def rest_section(rest):
    out = ["## A pile at rest", "",
           f"{rest['balls']} balls of the settling job, {rest['settle']} s to settle, then {rest['steps']} steps of {rest['dt']} s. "
           f"{rest['loose']} balls touch fewer than three others or walls; without rolling friction such a ball may roll on the floor without end. "
           "Displacements are measured from the beginning of these steps. The columns held exclude these balls.", "",
           row("steps", "kinetic energy, m g d per ball", "displacement, held: median, d", "held: largest, d", "any ball: largest, d", "largest overlap, r"),
           row(*["---"] * 6)]
    for r in rest["rows"]:
        out.append(row(text(r["step"], 7), text(r["kinetic"]), text(r["median"]), text(r["held"]), text(r["largest"]), text(r["overlap"])))
    return out + [""]


def growth_section(growth):
    out = ["## CPU against the number of balls", "",
           "The settling job with defaults, until three times the time of fall of the highest balls, and then some steps of the bed at rest. CPU per step "
           f"grows as N^{text(growth['falling'])} while the bed forms and as N^{text(growth['exponent'])} afterwards (least squares of the logarithms).", "",
           row("balls", "forming: CPU, us per ball and step", "bed: CPU, us per ball and step", "bed: sweeps per step", "bed: steps"), row(*["---"] * 5)]
    for r in growth["rows"]:
        out.append(row(text(r["balls"], 7), text(1e6 * r["falling"] / r["balls"]), text(1e6 * r["cpu"] / r["steps"] / r["balls"]),
                       text(r["sweeps"]), text(r["steps"])))
    return out + [""]


SUMMARY = ("nsd", "liggghts-soft"), ("nsd-one", "liggghts-soft"), ("nsd", "liggghts-stiff")  # the ratios of the first table


def page(results):
    out = ["# nsd compared with LIGGGHTS and Yade", "",
           "`make peers` runs seven jobs with nsd and LIGGGHTS from the same start, with the same geometry, friction and restitution, and writes this page "
           "(`QUICK=1`: small jobs, in minutes). Yade runs one of them, settling. LIGGGHTS and Yade are optional Debian packages. CPU is user and system time per simulated second. "
           "Wall is real time per simulated second, which is meaningful only if the machine has no other load. nsd has its defaults, small steps, except `-j`; "
           "\"one solve per step\" is `--small-steps 0`. Its dt is that of the job's scene. LIGGGHTS and Yade use Hertzian contacts with tangential history, "
           "Poisson's ratio 0.3, and 0.2 of the Rayleigh time as time step. \"cut\": the run was stopped at a limit of CPU seconds, and its cost is "
           "that of the time it simulated. \"overlap\" is the largest of two balls in the 40 frames of the run, over the smaller radius, measured alike for all codes; "
           "\"in the run\" is what nsd itself reports: the largest of all steps, with walls.", ""]
    for r in results:
        jobs = r["jobs"]
        out += [f"## {r['machine']}", "", "; ".join(r["versions"]) + "." + (" Small jobs (QUICK=1)." if r["quick"] else ""), "",
                row("job", "balls", *(ROWS[k][0] for k in COLUMNS), *(f"{ROWS[a][0]} / {ROWS[b][0].split(', ')[-1]}" for a, b in SUMMARY)),
                row(*["---"] * (2 + len(COLUMNS) + len(SUMMARY)))]
        for name, job in jobs.items():
            v = job["variants"]
            out.append(row(name, text(job["balls"], 7), *(cost_text(v.get(k, {})) for k in COLUMNS),
                           *(text(q, 2) if q else "" for q in (ratio(v, a, b) for a, b in SUMMARY))))
        loses = [f"{name} ({text(ratio(job['variants']), 2)})" for name, job in jobs.items() if (ratio(job["variants"]) or 0) > GOAL]
        memory = [f"{name} ({text(job['variants']['nsd']['runs'][-1]['memory'])} and {text(job['variants']['liggghts-soft']['runs'][-1]['memory'])} MiB)"
                  for name, job in jobs.items() if job["variants"].get("liggghts-soft", {}).get("runs") and job["variants"]["nsd"]["runs"]
                  and job["variants"]["nsd"]["runs"][-1]["memory"] > job["variants"]["liggghts-soft"]["runs"][-1]["memory"]]
        out += ["", f"More than {GOAL} of the CPU of LIGGGHTS, soft: " + (", ".join(loses) or "none") + ". "
                "More memory: " + (", ".join(memory) or "none") + ".", ""]
        for name, job in jobs.items():
            out += job_section(name, job, r["quick"])
        for key, section in (("check", check_section), ("effort", effort_section), ("rest", rest_section), ("growth", growth_section)):
            if r.get(key):
                out += section(r[key])
    return "\n".join(out)


def step_of(end):
    """A round step of some five labels of an axis from 0"""
    unit = 10 ** math.floor(math.log10(end / 5))
    return next(unit * k for k in (1, 2, 5, 10) if unit * k >= end / 5 * 0.99)


def plot(name, job, folder):
    path = os.path.join(folder, name)
    if len(seen(job)) == 1:
        if os.path.exists(path + ".svg"):
            os.remove(path + ".svg")
        return
    runs = {title: (style, job["variants"][key]["series"]) for key, (title, style) in ROWS.items() if style and job["variants"].get(key, {}).get("series")}
    end = max(curve["t"][-1] for _, curve in runs.values())
    # of a run that was stopped at once no curve is seen: it stands in a note instead of the legend
    drawn = {title: run for title, run in runs.items() if run[1]["t"][-1] >= 0.03 * end}
    note = "; ".join(f"{title}: {text(runs[title][1]['t'][-1])} s" for title in runs if title not in drawn)
    data = "".join("".join(" ".join(map(str, values)) + "\n" for values in zip(curve["t"], *(curve[k] for k in curve if k != "t"))) + "\n\n"
                   for _, curve in drawn.values())
    with open(path + ".dat", "w") as f:
        f.write(data)
    two = name == "settling"  # the second observable below the first
    script = f"set terminal svg size 720,{900 if two else 480} background 'white' font 'sans,17'; set output '{path}.svg'; set border 3; set tics nomirror; "
    script += f"set grid lc rgb '#dddddd'; set key outside top center horizontal maxcols 2 width 2; set xlabel 'time, s'; set xrange [0:{end}]; set xtics {text(step_of(end))}; "
    if note:
        script += f"set label 'stopped at once: {note}' at graph 0.98, graph 0.06 right font 'sans,13' tc rgb '#555555'; "
    # nsd: solid, blue; LIGGGHTS: dashed, red; Yade: green; paler: the second variant. A dot where a run was stopped
    colour = {1: "#1b6ca8", 2: "#7fb2d8", 3: "#c8402c", 4: "#e8a090", 5: "#4a7d3a"}

    def curves(column):
        parts = []
        for k, (title, (style, curve)) in enumerate(drawn.items()):
            last = curve["t"][-1]
            named = title if last > 0.98 * end else f"{title}, to {text(last)} s"
            looks = f"lc rgb '{colour[style]}'"
            parts.append(f"'{path}.dat' index {k} using 1:{column} with lines lw {4 if style == 1 else 2.5} {'dt (6, 5) ' if style in (3, 4) else ''}{looks} title '{named}'")
            if last <= 0.98 * end:
                parts.append(f"'{path}.dat' index {k} using 1:{column} every ::{len(curve['t']) - 1} with points pt 7 ps 1 {looks} notitle")
        return "plot " + ", ".join(parts) + "; "

    if two:
        script += "set multiplot layout 2,1; "
    script += f"set ylabel '{job['label']}'; " + curves(2)
    if two:
        script += "unset key; set logscale y; set format y '10^{%T}'; set ylabel 'kinetic energy per ball, m g d'; " + curves(3)
    subprocess.run(["gnuplot", "-e", script], check=True)
    os.remove(path + ".dat")


if __name__ == "__main__":
    arguments = sys.argv[1:]
    plots = arguments.pop(arguments.index("--plots") + 1) if "--plots" in arguments else None
    kept = [json.load(open(path)) for path in arguments if path != "--plots"]
    print(page(kept))
    if plots:
        for job_name, its in kept[0]["jobs"].items():
            plot(job_name, its, plots)
