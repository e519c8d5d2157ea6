#!/usr/bin/python3
"""page.py OUT SIZE...: the page of make wall, from what wall.py found."""
import json
import sys


def rows(*path):
    with open("/".join(map(str, (out, *path)))) as file:
        return [json.loads(line) for line in file]


out, sizes = sys.argv[1], [int(n) for n in sys.argv[2:]]
last = sizes[-1]
with open(__file__.replace("page.py", "page.md")) as file:
    text = file.read()


def table(head, lines):
    cells = [head, ["---"] * len(head), *lines]
    return "\n".join("| " + " | ".join(map(str, c)) + " |" for c in cells)


def e(x):
    return "" if x is None else f"{x:.1e}".replace("e-0", "e-")


sweeps = []
for n in sizes:
    for f in rows(n, "follow.jsonl"):
        k = f["file"].split("sweeps-")[1].split(".")[0]
        sweeps.append([n, k, e(f["natural"]), f"{f['r']:.5e}", e(f.get("dr")), e(f.get("dv")), f.get("flips", ""),
                       f"{f['bodies']} of {f['of']}" if "bodies" in f else ""])
spectra, solved = [], []
for n in sizes:
    s = rows(n, "spectrum.jsonl")[0]
    spectra.append([n, s["contacts"], s["load"], s["slide"], e(s["natural"]), s["zero"], s["unstable"], e(s["least"]),
                    e(s["smallest"]), ", ".join(map(str, sorted(set(s["spread"])))), s["size"]])
    a = rows(n, "auto.jsonl")[0]
    solved.append([n, a["sweeps"], e(a["natural"]), e(a["self_stress"])])
steps = rows(last, "steps.jsonl")
ratio = {law: [s["ratio"] for s in steps if s["law"] == law and s["ratio"]] for law in ("Coulomb", "held")}
jam = [[f["file"].split("eps-")[1][:-3], e(f["natural"]), e(f["r"]), e(f.get("dr")), e(f.get("dv")), e(f["self_stress"])]
       for f in rows("jam", "follow.jsonl")]


def cells(name):
    with open(f"{out}/{name}", encoding="ascii") as file:
        return [row.rstrip("\n").split("\t") for row in file]


def number(text):
    return f"{float(text):.2g}".replace("e-0", "e-")


stiff, soft = {}, []
for balls, contacts, alpha, deep, eps, taken, newton, seconds, natural in cells("stiffness.tsv"):
    row = stiff.setdefault((balls, alpha), [balls, contacts, alpha, "" if alpha == "0" else e(float(deep))])
    good = float(natural) <= 1.01 * float(eps)
    steps = taken + (f" + {newton}" if newton not in ("", "0") else "")
    row.append(f"{steps}; {number(seconds)} s" if good else f"{e(float(natural))} in {number(seconds)} s")
for n in sizes:
    s = rows(n, "soft.jsonl")[0]
    soft.append([n, s["contacts"], s["load"], s["slide"], s["zero"], s["unstable"], e(s["least"])])
change = [[a, e(float(x)), e(float(y)), *more] for a, x, y, *more in cells("change.tsv")]
for name, value in {
        "STIFF": table(["balls", "contacts", "alpha", "deepest, radii", "to 1e-4", "to 1e-6", "to 1e-8"],
                       [row + [""] * (7 - len(row)) for row in stiff.values()]),
        "SOFT": table(["balls", "contacts", "loaded", "sliding", "zero", "unstable", "least real part"], soft),
        "CHANGE": table(["alpha", "map of auto", "of Gauss-Seidel", "largest change", "root mean square"], change),
        "SWEEPS": table(["balls", "sweeps", "natural map", "norm of r, N s", "change of r", "change of v, g dt",
                         "statuses changed", "bodies with 9/10 of it"], sweeps),
        "SPECTRA": table(["balls", "contacts", "loaded", "sliding", "natural map", "zero", "unstable", "least real part",
                          "smallest but zero", "unknowns in unstable ones", "of"], spectra),
        "SOLVED": table(["balls", "sweeps", "natural map", "self-stress"], solved),
        "JAM": table(["tolerance", "natural map", "norm of r, N s", "change of r", "change of v, g dt", "self-stress"], jam),
        "COUNT": str(max(len(rows(n, "spectrum.jsonl")[0]["eigenvalues"]) + rows(n, "spectrum.jsonl")[0]["zero"]
                         for n in sizes)),
        "LAST": str(last),
        "LONGER": str(sum(r > 1 for r in ratio["Coulomb"])),
        "STEPS": str(len(ratio["Coulomb"])),
        "COULOMB": f"{min(ratio['Coulomb']):.5f} to {max(ratio['Coulomb']):.5f}",
        "HELD": f"{min(ratio['held']):.5f} to {max(ratio['held']):.5f}"}.items():
    text = text.replace(f"@{name}@", value)
print(text, end="")
