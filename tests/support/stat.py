"""What nsd-stat says, against closed answers and against numpy on the same document."""

import json
import subprocess
import sys

import h5py
import numpy as np


def stat(*args):
    out = subprocess.run(["nsd-stat", *args], capture_output=True, text=True, check=True).stdout
    assert "nan" not in out.lower() and "inf" not in out.lower(), out
    return [json.loads(line) for line in out.splitlines()]


def close(a, b, eps=1e-12, scale=None):
    a, b = np.asarray(a, float), np.asarray(b, float)
    scale = np.abs(b).max() if scale is None else scale
    assert np.abs(a - b).max() <= eps * max(scale, 1e-300), (a, b)


def last(document):
    """Frame, contacts and parameters of a document's last frame, as arrays."""
    f = h5py.File(document)
    p, c = f["particles/all"], f["contacts"]
    start, count = int(c["start"][-1]), int(c["count"][-1])
    d = {k: p[k + "/value"][-1] for k in ("position", "velocity", "angular_velocity")}
    d |= {k: p[k][:] for k in ("radius", "mass", "inertia")}
    d |= {k: c[k][start:start + count] for k in ("body", "point", "frame", "gap", "reaction", "mu")}
    d["dt"], d["g"] = f["nsd"].attrs["dt"], f["nsd"].attrs["gravity"]
    d["force"] = np.einsum("ci,cij->cj", d["reaction"], d["frame"]) / d["dt"]
    return d


def lattice(document, phi, z, anisotropy):
    """A lattice of touching bodies in a cell that repeats."""
    s = stat("-m", "fraction,coordination,fabric,contact_numbers", document)[-1]
    close(s["fraction"]["fraction"], float(phi), 1e-8)
    close(s["coordination"]["z"], float(z))
    close(s["fabric"]["anisotropy"], float(anisotropy), 1e-9, 1)
    close(np.trace(s["fabric"]["tensor"]), 1)
    assert s["contact_numbers"]["contacts"][-1] == int(z) and s["contact_numbers"]["share"][-1] == 1


def column(document):
    """n balls one above the other at rest: contact k carries what lies above it."""
    d, s = last(document), stat("--last", "-m", "walls,stress,profile", "--layers", "z:5", document)[-1]
    n, m, g, r = len(d["mass"]), d["mass"][0], -d["g"][2], d["radius"][0]
    floor = s["walls"]["wall"].index(0)
    close(s["walls"]["force"][floor], [0, 0, -n * m * g], 1e-6)
    weights = m * g * np.arange(1, n)  # between balls, from the top
    whole = (2 * r * weights.sum() + r * n * m * g) / (np.pi * r * r)  # times the volume by the area, below
    volume = stat("--last", "-m", "fraction", document)[-1]["fraction"]["volume"]
    close(s["stress"]["tensor"][2][2] * volume, whole * np.pi * r * r, 1e-6)
    close(np.delete(np.ravel(s["stress"]["tensor"]), 8), 0, 1e-6, s["stress"]["tensor"][2][2])
    t = np.array(s["profile"]["stress"]).reshape(5, 3, 3)[:, 2, 2] * volume / 5
    assert np.all(np.diff(t) < 0), t


def same_as_numpy(document):
    """Stress, forces, fabric, energies, temperature of a frame, from its datasets."""
    d, s = last(document), stat("--last", "-m", "all", document)[-1]
    a, b, f, n = d["body"][:, 0], d["body"][:, 1], d["force"], d["frame"][:, 0]
    r = np.append(d["radius"], 0)
    wall = a < 0
    length = np.where(wall, r[b] + d["gap"], r[b] + r[np.where(wall, -1, a)] + d["gap"])
    V = s["fraction"]["volume"]
    contacts = -np.einsum("ci,cj->ij", f, -length[:, None] * n) / V
    close(s["stress"]["contact_part"], contacts, 1e-9)
    m, v = d["mass"], d["velocity"]
    mean = (m[:, None] * v).sum(0) / m.sum()
    kinetic = np.einsum("i,ij,ik->jk", m, v - mean, v - mean)
    close(s["stress"]["kinetic"], kinetic / V, 1e-9)
    close(s["stress"]["tensor"], contacts + kinetic / V, 1e-9)
    close(s["temperature"]["velocity"], mean, 1e-9)
    close(s["temperature"]["temperature"], np.trace(kinetic) / m.sum() / 3, 1e-9)
    for w in set(-1 - a[wall]):
        i = s["walls"]["wall"].index(w)
        close(s["walls"]["force"][i], -f[a == -1 - w].sum(0), 1e-9, np.abs(f).max())
        torque = np.cross(d["point"][a == -1 - w], -f[a == -1 - w]).sum(0)
        close(s["walls"]["torque"][i], torque, 1e-9, np.abs(f).max() * np.abs(d["point"]).max())
    push = d["reaction"][:, 0] > 0
    close(s["fabric"]["tensor"], np.einsum("ci,cj->ij", n[push], n[push]) / push.sum(), 1e-9)
    close(s["energy"]["kinetic"], 0.5 * (m * (v ** 2).sum(1)).sum(), 1e-9)
    close(s["energy"]["rotation"], 0.5 * (d["inertia"] * (d["angular_velocity"] ** 2).sum(1)).sum(), 1e-9)
    close(s["energy"]["potential"], -(m * (d["position"] @ d["g"])).sum(), 1e-9)
    fn, ft = d["reaction"][push, 0], np.hypot(d["reaction"][push, 1], d["reaction"][push, 2])
    close(s["friction"]["normal_mean"], fn.mean() / d["dt"], 1e-9)
    close(s["friction"]["ratio"], ft.sum() / (d["mu"][push] * fn).sum(), 1e-9)
    h = s["normal_forces"]
    density, width = np.array(h["density"]), np.array(h["to"]) - np.array(h["from"])
    close((density * width).sum(), 1, 1e-9)
    counts, _ = np.histogram(fn / fn.mean(), bins=np.append(h["from"], h["to"][-1]))
    assert abs(counts - np.array(h["contacts"])).sum() <= 2  # the very ends
    count = np.bincount(np.append(a[push & ~wall], b[push]), minlength=len(m))
    close(s["coordination"]["z"], count.mean(), 1e-9)


def balances(document, of=""):
    """What a step dissipates is what its report says, in every frame; of walls: so is what they give."""
    q = h5py.File(document)["nsd/solver"]
    for k, s in enumerate(stat("-m", "energy", document)):
        if of == "walls":
            close(s["energy"]["walls"], q["work_drives/value"][k], 1e-6, abs(q["kinetic_energy/value"][k]))
        close(s["energy"]["dissipated"], q["dissipation/value"][k], 1e-6, abs(q["kinetic_energy/value"][k]))
        if of != "edges":  # these have an energy of their own
            close(s["energy"]["kinetic"] + s["energy"]["rotation"], q["kinetic_energy/value"][k], 1e-9)
        close(s["energy"]["impact"] + s["energy"]["friction"], s["energy"]["dissipated"], 1e-9)


def flight(document):
    """Free flight: the mean square displacement is <v^2> t^2, the temperature constant."""
    v = h5py.File(document)["particles/all/velocity/value"][0]
    first = None
    for s in stat("-m", "displacement,temperature", document):
        if s["displacement"] is None:
            continue
        t = s["displacement"]["since"]
        close(s["displacement"]["msd"], (v ** 2).sum(1).mean() * t * t, 1e-9)
        first = s["temperature"]["temperature"] if first is None else first
        close(s["temperature"]["temperature"], first, 1e-9)


def scattered(document):
    """Points at random: g is 1."""
    g = stat("-m", "pairs", "--bins", "10", "--distance", "0.2", "--box", "0,1,0,1,0,1", document)[-1]["pairs"]
    pairs, g = np.array(g["pairs"])[1:], np.array(g["g"], float)[1:]
    assert pairs.min() > 100 and np.all(np.abs(g - 1) < 5 / np.sqrt(pairs)), (pairs, g)


def slope(document, degrees):
    """A heap whose surface is a plane, and no cone."""
    s = stat("-m", "surface", document)[-1]["surface"]
    close(s["angle"], float(degrees), 2e-2)
    assert s["cone"] is None, s


def cone(document, degrees):
    s = stat("-m", "surface", document)[-1]["surface"]
    close(s["cone"], float(degrees), 4e-2)


def flow(document, rate):
    """A row of balls that crosses a plane."""
    n = sum(s["flux"]["forth"] - s["flux"]["back"]
            for s in stat("-m", "flux", "--plane", "1,0,0", "--point", "0.55,0,0", document) if s["flux"])
    assert n == int(rate), n


def sorted_by_size(document):
    s = stat("-m", "segregation,sizes", "--layers", "z:2", document)[-1]
    assert s["segregation"]["index"] > 0.99 and s["segregation"]["correlation"] > 0.9, s
    assert s["sizes"]["large"] == [0, 1], s


def fields(document, made):
    """The balance of momentum in a settled pile, with what little its bodies are accelerated."""
    subprocess.run(["nsd-stat", "-m", "fraction", "--spacing", "1.5e-4", "--width", "1e-3", "-f", made, document],
                   capture_output=True, check=True)
    f, d = h5py.File(made)["fields"], last(document)
    n, h = f["points"][:], f["spacing"][:]
    rho = f["density/value"][-1].reshape(n[::-1])
    sigma = f["stress/value"][-1].reshape(*n[::-1], 3, 3)
    # stress is f l^T: its first index is the force's, and the divergence goes along the second
    div = sum(np.gradient(sigma[..., :, k], h[k], axis=2 - k) for k in range(3))
    gain = (f["momentum/value"][-1] - f["momentum/value"][-2]).reshape(*n[::-1], 3) / d["dt"]
    off = div + gain - rho[..., None] * d["g"]
    inner = off[15:-15, 15:-15, 15:-15]
    weight = (rho[..., None] * d["g"])[15:-15, 15:-15, 15:-15]
    left = np.sqrt((inner ** 2).sum(-1).mean() / (weight ** 2).sum(-1).mean())
    assert left < 0.01, left


def inside(document, floor, least, most):
    """The fraction inside a bed by points at random: in the region that is reported, and in the lower half of the bed."""
    s, d = stat("-l", "-m", "fraction", document)[-1]["fraction"], h5py.File(document)["particles/all"]
    x, r = d["position/value"][-1], d["radius"][:]
    rng = np.random.default_rng(1)

    def solid(lo, hi, n=20000):
        at = lo + (hi - lo) * rng.random((n, 3))
        return np.mean([(((x - y) ** 2).sum(1) < r ** 2).any() for y in at])
    lo, hi, mean = np.array(s["from"]), np.array(s["to"]), 2 * r.mean()
    assert abs(solid(lo, hi) - s["fraction"]) < 0.012, (solid(lo, hi), s)
    assert float(least) < s["fraction"] < float(most), s
    middle = np.median(x, 0)
    own = [middle - 3 * mean, middle + 3 * mean]
    own[0][2], own[1][2] = float(floor) + 2 * mean, middle[2] + mean
    assert abs(solid(*own) - s["fraction"]) < 0.05, (solid(*own), s)
    assert lo[2] > float(floor) + 1.9 * mean and hi[2] < (x[:, 2] + r).max() - mean, s


def tied(document):
    """Pairs in tension count, what ties store is stored and not dissipated, friction has its limit in the push."""
    q = h5py.File(document)["nsd/solver"]
    pulls, used = 0, 0
    for k, s in enumerate(stat("-m", "energy,coordination,friction,normal_forces", document)):
        close(s["energy"]["stored"], q["bond_energy/value"][k], 1e-9)
        close(s["energy"]["dissipated"], q["dissipation/value"][k], 1e-6,
              abs(q["bond_change/value"][k]) + abs(q["dissipation/value"][k]))
        assert s["friction"]["contacts"] == s["coordination"]["contacts"]
        used = max(used, s["friction"]["mobilised"] or 0)
    d = last(document)
    pulls = (d["reaction"][:, 0] < 0).sum()
    assert pulls > 5 and s["coordination"]["contacts"] == len(d["gap"]) and used <= 1, (pulls, used)


def images(document, made):
    """Images move as their cell does: fields of a lattice by brute force, over many images; layers by the flow."""
    s = stat("-m", "profile", "--layers", "y:5", "--width", "0.6", "-f", made, document)[-1]["profile"]
    f, d = h5py.File(made)["fields"], h5py.File(document)
    n, at, h, w = f["points"][:], f["origin"][:], f["spacing"][:], f.attrs["width"]
    part, box = d["particles/all"], d["particles/all/box"]
    x, v = part["position/value"][-1][:, :2], part["velocity/value"][-1][:, :2]
    edges, rate = box["edges/value"][-1][:2, :2], box["rate/value"][-1][:2, :2]
    points = np.stack(np.meshgrid(at[0] + np.arange(n[0]) * h[0], at[1] + np.arange(n[1]) * h[1]), -1).reshape(-1, 2)
    mass, momentum = 0, 0
    for k in np.ndindex(9, 9):
        far = np.array(k) - 4
        phi = np.exp(-((points[:, None] - x - far @ edges) ** 2).sum(-1) / w ** 2)
        phi[phi < np.exp(-16)] = 0
        mass, momentum = mass + phi.sum(1), momentum + phi @ (v + far @ rate)
    found = f["velocity/value"][-1][:, :2]
    assert np.abs(found - momentum / mass[:, None]).max() < 1e-2 * np.abs(found).max()
    L = np.linalg.solve(edges, rate).T
    for y, u in zip(s["at"], s["velocity"]):
        close(u[0], L[0, 1] * y, 1e-9, 1), close(u[1], L[1, 1] * y, 1e-9, 1)


def table(document):
    """--tsv and JSON say the same."""
    out = subprocess.run(["nsd-stat", "--tsv", "-m", "energy,stress", document], capture_output=True, text=True,
                         check=True).stdout.splitlines()
    names = out[0].split("\t")
    for line, s in zip(out[1:], stat("-m", "energy,stress", document)):
        row = dict(zip(names, line.split("\t")))
        kinetic = [k for k in names if k.endswith("kinetic") and not k.startswith("stress")][0]
        close(float(row[kinetic]), s["energy"]["kinetic"], 0)
    assert len(out) > 1


globals()[sys.argv[1]](*sys.argv[2:])
