"""Mixing, residence, lifetimes and fields of motion by nsd-stat, against closed answers and numpy on the same document."""

import json
import subprocess
import sys

import h5py
import numpy as np


def stat(*args):
    out = subprocess.run(["nsd-stat", *args], capture_output=True, text=True, check=True).stdout
    assert "nan" not in out.lower() and "inf" not in out.lower(), out
    return [json.loads(line) for line in out.splitlines()]


def rows(*args):
    out = subprocess.run(["nsd-stat", "--tsv", *args], capture_output=True, text=True, check=True).stdout.splitlines()
    names = out[0].split("\t")
    return [dict(zip(names, map(float, line.split("\t")))) for line in out[1:]]


def close(a, b, eps=1e-12, scale=None):
    a, b = np.asarray(a, float), np.asarray(b, float)
    scale = np.abs(b).max() if scale is None else scale
    assert np.abs(a - b).max() <= eps * max(scale, 1e-300), (a, b)


def lattice(document, sample, *wanted):
    """A lattice in a periodic cell: NAME=VALUE for what the measure is to give."""
    s = stat("-m", "mixing", "--sample", sample, document)[-1]["mixing"]
    for name, value in (w.split("=") for w in wanted):
        close(s[name], float(value), 1e-9, 1)


def at_random(document):
    s = stat("-m", "mixing", document)[-1]["mixing"]
    assert abs(s["lacey"] - 1) < 0.03 and abs(s["neighbours"] - 1) < 0.05 and abs(s["segregation"]) < 0.1, s


def same_as_numpy(document, sample, tracer):
    """Samples and neighbours by brute force, whatever the cell is."""
    f = h5py.File(document)
    p, dim = f["particles/all"], f["particles/all/position/value"].shape[2]
    x, r, kind = p["position/value"][-1], p["radius"][:], p["species"][:]
    names = f["nsd/material"].attrs["kinds"]
    names = (names if isinstance(names, str) else names.decode()).split("\n")
    mark = r > r.mean() if tracer == "large" else kind == names.index(tracer)
    n, share, k = len(x), mark.mean(), 12
    s = stat("-m", "mixing", "--sample", sample, "--tracer", tracer, document)[-1]["mixing"]
    flat = np.ptp(x[:, 2]) == 0
    k, dims = (6, 2) if flat else (12, 3)
    box = f["particles/all/box"]
    images = [np.zeros(3)]
    if "edges" in box and flat:
        e = (box["edges/value"][-1] if "value" in box["edges"] else box["edges"][:])[:2]
        images = [i * np.append(e[0][:2], 0) + j * np.append(e[1][:2], 0) for i in range(-2, 3) for j in range(-2, 3)]
        unit = np.linalg.solve(np.array([e[0][:2], e[1][:2]]).T, (x[:, :2]).T).T % 1
        size = [1 / np.linalg.norm(row) for row in np.linalg.inv(np.array([e[0][:2], e[1][:2]]).T)]
    else:
        whole = stat("-m", "fraction", document)[-1]["fraction"]
        lo, hi = np.array(whole["from"])[:dims], np.array(whole["to"])[:dims]
        unit, size = (x[:, :dims] - lo) / (hi - lo), hi - lo
    parts = [max(int(np.ceil(l / float(sample) * (1 - 1e-9))), 1) for l in size]
    place = np.minimum((np.clip(unit, 0, 1) * parts).astype(int), np.array(parts) - 1)
    place = np.ravel_multi_index(place.T, parts)
    held = np.bincount(place)
    p_k = np.bincount(place, mark)[held > 0] / held[held > 0]
    held = held[held > 0]
    variance = (held * (p_k - share) ** 2).sum() / n
    apart = share * (1 - share)
    close(s["variance"], variance, 1e-9)
    close(s["lacey"], (apart - variance) / (apart - apart * len(held) / n), 1e-9)
    close(s["intensity"], variance / apart, 1e-9)
    unlike = 0
    for i in range(n):
        d = np.concatenate([np.linalg.norm(x + m - x[i], axis=1) for m in images])
        other = np.tile(mark, len(images))
        near = np.argsort(np.where(d > 0, d, np.inf), kind="stable")[:k]
        unlike += (other[near] != mark[i]).mean() / n
    close(s["neighbours"], unlike / (2 * apart), 1e-9)


def walk(start, document, steps, speed, dt):
    """A walk at random: 6 D t = 3 s^2 dt^2 (n - 3/4), for the half steps at its ends; D along each axis."""
    s = stat("-m", "displacement", start, document)[-1]["displacement"]
    n, v, h = int(steps), float(speed), float(dt)
    wanted = v * v * h * h * (n - 0.75)
    close(s["since"], n * h, 1e-9)
    close(s["about_drift"], 3 * wanted, 0.06)
    close(6 * s["diffusion"] * s["since"], s["about_drift"], 1e-9)
    close(2 * np.array(s["along"]) * s["since"], [wanted] * 3, 0.1)
    close(s["msd"] - np.dot(s["drift"], s["drift"]), s["about_drift"], 1e-9)


def passing(document, stay):
    """Bodies that pass a box: how long they were there, by each and by the mean of all."""
    box = ("--box", "0.155,0.755,-1,1,-1,1", document)
    each = [r for r in rows("-m", "departures", *box)]
    whole = [r["stay"] for r in each if r["whole"]]
    assert len(whole) >= 3 and len(each) > len(whole), each
    close(whole, float(stay), 1e-9)
    assert all(r["stay"] < float(stay) for r in each if not r["whole"]), each
    all_of = [s["residence"] for s in stat("-m", "residence", *box) if s["residence"]]
    assert sum(s["left"] for s in all_of) == len(each)
    close([s["stay"] for s in all_of if s["stay"] is not None], float(stay), 1e-9)
    assert all_of[-1]["bodies"] == all_of[0]["bodies"] + sum(s["entered"] - s["left"] for s in all_of[1:])


def removed(document):
    """Poured and removed bodies: the time between the two, which the document has, whatever the frames."""
    e = h5py.File(document)["nsd/flow/events"]
    poured, gone = ({int(i): t for i, t, c in zip(e["id"][:], e["time"][:], e["came"][:]) if c == k} for k in (1, 0))
    each = rows("-m", "departures", document)
    assert len(each) == len(gone) > 5, each
    seen = [r for r in each if r["whole"]]
    assert len(seen) > 3 and all(r["removed"] for r in each)
    for r in seen:
        close(r["stay"], gone[r["id"]] - poured[r["id"]], 1e-9)


def landing(document, first, last):
    """A ball that lands on a floor which goes: one contact, from then to then, to a frame."""
    each = rows("-m", "separations", document)
    assert len(each) == 1 and each[0]["a"] == -1 and each[0]["b"] == 0 and each[0]["whole"] == 1, each
    close([each[0]["began"], each[0]["ended"]], [float(first), float(last)], 0.011, 1)
    close(each[0]["life"], each[0]["ended"] - each[0]["began"])
    s = [s["lifetimes"] for s in stat("-m", "lifetimes", document) if s["lifetimes"]]
    assert sum(t["made"] for t in s) == 1 and sum(t["ended"] for t in s) == 1
    assert [t["life"] for t in s if t["life"] is not None] == [each[0]["life"]]


def pairs_of_frames(document):
    """Contacts of a heap: what comes and goes, by sets of pairs."""
    f = h5py.File(document)
    c, before, began = f["contacts"], None, {}
    lives, s = [], stat("-m", "lifetimes", document)
    times = [t["time"] for t in s]
    for k, (start, count) in enumerate(zip(c["start"][:], c["count"][:])):
        body, r = c["body"][start:start + count], c["reaction"][start:start + count]
        now = {tuple(sorted(b)) if b[0] >= 0 else tuple(b) for b, f_n in zip(body.tolist(), r) if f_n[0] != 0}
        for pair in now - set(began):
            began[pair] = (times[k], before is not None)
        ended = set(began) - now
        if before is not None:
            t = s[k]["lifetimes"]
            assert (t["pairs"], t["made"], t["ended"]) == (len(now), len(now - before), len(before - now)), k
            if now:
                close(t["age"], np.mean([times[k] - began[q][0] for q in now]), 1e-9, 1)
        lives += [(times[k] - began[q][0], began[q][1]) for q in ended]
        for q in ended:
            del began[q]
        before = now
    each = rows("-m", "separations", document)
    assert sorted((round(r["life"], 9), bool(r["whole"])) for r in each) == sorted((round(a, 9), b) for a, b in lives)
    assert len(lives) > 20


def affine(document, made):
    """An affine flow: its gradient everywhere, and no temperature, however the bodies lie."""
    subprocess.run(["nsd-stat", "-m", "fraction", "-f", made, document], capture_output=True, check=True)
    f = h5py.File(made)["fields"]
    L = np.array([[0.1, 2, 0], [0.3, -0.2, 0.5], [0, 1, 0.4]])
    D = (L + L.T) / 2
    s = D - np.eye(3) * np.trace(D) / 3
    G = f["velocity_gradient/value"][-1].reshape(-1, 3, 3)
    good = np.isfinite(G[:, 0, 0])
    assert good.mean() > 0.99, good.mean()
    close(G[good], np.broadcast_to(L, G[good].shape), 1e-7)  # bodies at a corner of the grid nearly lie in a plane
    close(f["strain_rate/value"][-1].reshape(-1, 3, 3)[good], np.broadcast_to(D, G[good].shape), 1e-7)
    close(f["shear_rate/value"][-1][good], np.sqrt(2 * (s * s).sum()), 1e-7)
    assert f["temperature/value"][-1][good].max() < 1e-12


def thermal(document, made, deviation):
    """Velocities at random beside a flow: their variance, less what an affine flow fits of it."""
    subprocess.run(["nsd-stat", "-m", "fraction", "-f", made, "--width", "0.15", document], capture_output=True, check=True)
    f = h5py.File(made)["fields"]
    n = f["points"][:]
    T = f["temperature/value"][-1].reshape(n[::-1])
    inner = tuple(slice(m // 4, m - m // 4) for m in T.shape)
    close(T[inner].mean(), float(deviation) ** 2, 0.06)


def inertial(document, made):
    """A cell that is sheared under pressure: the inertial number is made of the fields beside it."""
    subprocess.run(["nsd-stat", "-m", "stress", "-f", made, document], capture_output=True, check=True)
    f, r = h5py.File(made)["fields"], h5py.File(document)["particles/all/radius"][:]
    found, press = f["inertial_number/value"][-1], f["stress/value"][-1]
    rho, phi = f["density/value"][-1], f["fraction/value"][-1]
    local = (press[:, 0] + press[:, 4]) / 2
    good = np.isfinite(found)
    assert good.mean() > 0.9 and np.array_equal(good, local > 0)
    again = f["shear_rate/value"][-1] * np.sqrt(rho / phi / np.where(good, local, np.nan))
    diameter = (found / again)[good]  # the mean of those nearby
    assert 2 * r.min() < diameter.min() < diameter.max() < 2 * r.max(), (diameter.min(), diameter.max())


def sheared_gas(document, made, rate, deviation):
    """Balls that fly at random in a plane shear: p = rho T, so I = rate d / sqrt(phi T)."""
    subprocess.run(["nsd-stat", "-m", "fraction", "-f", made, "--width", "0.2", document], capture_output=True, check=True)
    f, d = h5py.File(made)["fields"], h5py.File(document)
    n, w = f["points"][:], f.attrs["width"]
    rate, T = float(rate), float(deviation) ** 2
    p = T + (rate * w) ** 2 / 2 / 3  # about the velocity at the point: with what the shear is across w
    phi = f["fraction/value"][-1].reshape(n[::-1])
    inner = tuple(slice(m // 4, m - m // 4) for m in phi.shape)
    wanted = rate * 2 * d["particles/all/radius"][0] / np.sqrt(phi[inner] * p)
    close(np.median(f["inertial_number/value"][-1].reshape(n[::-1])[inner] / wanted), 1, 0.05)


globals()[sys.argv[1]](*sys.argv[2:])
