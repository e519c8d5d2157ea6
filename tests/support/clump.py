"""clump.py write DIR: closed surfaces as OBJ files: a sphere, a torus, an L of three unit cubes, cubes in and beside one another,
and wrong ones.
clump.py judge DOCUMENT OBJ SCALE BALLS VOLUME DISTANCE: is the clump in the document as nsd-gen said? Volume, centre and
moments against sums over the surface's tetrahedra, the distance against all pairs of places and balls."""
import json
import sys

import numpy as np


def write(directory):
    def obj(name, v, f):
        with open(f"{directory}/{name}.obj", "w") as out:
            out.writelines("v %.17g %.17g %.17g\n" % tuple(x) for x in v)
            out.writelines("f " + " ".join(str(i + 1) for i in t) + "\n" for t in f)
    n, m, v, f = 48, 24, [], []
    for i in range(n):
        for j in range(m):
            a, b = 2 * np.pi * i / n, 2 * np.pi * j / m
            v.append(((1 + 0.3 * np.cos(b)) * np.cos(a), (1 + 0.3 * np.cos(b)) * np.sin(a), 0.3 * np.sin(b)))
            p, q = i * m + j, (i + 1) % n * m + j
            r, s = (i + 1) % n * m + (j + 1) % m, i * m + (j + 1) % m
            f += [(p, q, r), (p, r, s)]
    obj("torus", v, f)
    obj("open", v, f[1:])
    obj("inside", v, [t[::-1] for t in f])
    v, f, last = [(0, 0, 0.5)], [], (m - 1) * n + 1
    for j in range(1, m):
        for i in range(n):
            t, p = np.pi * j / m, 2 * np.pi * i / n
            v.append((0.5 * np.sin(t) * np.cos(p), 0.5 * np.sin(t) * np.sin(p), 0.5 * np.cos(t)))
    v.append((0, 0, -0.5))
    for i in range(n):
        f += [(0, 1 + i, 1 + (i + 1) % n), (last, 1 + (m - 2) * n + (i + 1) % n, 1 + (m - 2) * n + i)]
        for j in range(m - 2):
            a, b = 1 + j * n + i, 1 + j * n + (i + 1) % n
            f += [(a, a + n, b + n), (a, b + n, b)]
    obj("sphere", v, f)

    def prism(name, corners, height):
        k = len(corners)
        v = [(x, y, z) for z in (0, height) for x, y in corners]
        sides = [(i, (i + 1) % k, k + (i + 1) % k, k + i) for i in range(k)]
        lids = [tuple(range(k))[::-1], tuple(range(k, 2 * k))]
        obj(name, v, sides + lids)
    prism("ell", [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], 1)
    prism("plate", [(0, 0), (1, 0), (1, 1), (0, 1)], 1e-3)

    def cubes(name, *all):  # each (x, y, z of its lower corner, edge, outward)
        v, f = [], []
        for x, y, z, a, outward in all:
            quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
            f += [tuple(len(v) + i for i in (q if outward else q[::-1])) for q in quads]
            v += [(x + a * (i & 1), y + a * (i >> 1 & 1), z + a * (i >> 2)) for i in range(8)]
        obj(name, v, f)
    cubes("apart", (0, 0, 0, 1, True), (1.5, 0, 0, 1, True))
    cubes("touching", (0, 0, 0, 1, True), (1, 0.25, 0.25, 1, True))
    cubes("hollow", (0, 0, 0, 2, True), (0.5, 0.5, 0.5, 1, False))
    cubes("overlapping", (0, 0, 0, 1, True), (0.5, 0.25, 0.25, 1, True))
    cubes("outward", (0, 0, 0, 2, True), (0.5, 0.5, 0.5, 1, True))
    cubes("island", (0, 0, 0, 3, True), (0.5, 0.5, 0.5, 2, False), (1, 1, 1, 1, True))
    cubes("one_inside_out", (0, 0, 0, 2, True), (3, 0, 0, 1, False))
    cubes("hidden", (0, 0, 0, 3, True), (0.5, 0.5, 0.5, 1, True), (1.75, 1.75, 1.75, 1, False))
    cubes("shell", (0, 0, 0, 2, True), (0.05, 0.05, 0.05, 1.9, False))


def read(path, scale):
    v, f = [], []
    for line in open(path):
        w = line.split()
        if w[0] == "v":
            v.append([float(x) * scale for x in w[1:]])
        else:
            k = [int(x) - 1 for x in w[1:]]
            f.append(k)
    return np.array(v), f


def triangles(v, f):
    """Quads and the L's lids, which are not convex, are cut from a corner from which all can be seen."""
    for k in f:
        if len(k) == 6:
            turn = next(i for i in range(6) if np.allclose(v[k[i]][:2] / v.max(), [0, 0]))
            k = k[turn:] + k[:turn]
        for i in range(1, len(k) - 1):
            yield k[0], k[i], k[i + 1]


def judge(document, path, scale, balls, volume, distance):
    import h5py
    v, f = read(path, float(scale))
    t = np.array([v[list(k)] for k in triangles(v, f)])
    det = np.linalg.det(t)
    V, s = det.sum() / 6, t.sum(1)
    c = (det[:, None] * s).sum(0) / 24 / V
    S = sum(d * (np.outer(q, q) + sum(np.outer(x, x) for x in p)) for d, q, p in zip(det, s, t)) / 120 - V * np.outer(c, c)
    inertia = np.sort(np.linalg.eigvalsh(np.trace(S) * np.eye(3) - S)) / V  # of mass 1
    with h5py.File(document) as g:
        k = 0
        mass, I, reach = (g["particles/all/" + n][k] for n in ("mass", "inertia", "radius"))
        moment, x, r = g["nsd/shape/moment"][0], g["nsd/shape/vertex"][()] * reach, g["nsd/shape/ball"][()] * reach
        near = lambda a, b, eps: np.allclose(a, b, rtol=eps, atol=0) or sys.exit(f"{a} is not {b}")  # noqa: E731
        near(mass, 2500 * V, 1e-12)
        near(np.sort(moment) * reach ** 2, inertia, 1e-9)
        near(I, mass * inertia.mean(), 1e-9)
        assert len(r) <= int(balls)
        at = np.array(json.loads(g["nsd/scene"][()])["shapes"]["g"]["balls"])
        near(np.max(np.linalg.norm(at[:, :3] - c, axis=1) + at[:, 3]), reach, 1e-12)
    # places on the surface: corners and middles of a fine division
    n = 40
    ij = np.array([(i / n, j / n) for i in range(n + 1) for j in range(n + 1 - i)])
    places = (t[:, None, 0] + ij[None, :, :1] * (t[:, None, 1] - t[:, None, 0]) + ij[None, :, 1:] * (t[:, None, 2] - t[:, None, 0])).reshape(-1, 3)
    places = places[:: max(1, len(places) // 40000)]
    gap = np.min(np.linalg.norm(places[:, None] - at[None, :, :3], axis=2) - at[:, 3], axis=1)
    surface = np.max(np.linalg.norm(v - c, axis=1))
    assert np.abs(gap).max() / surface <= float(distance) * 1.06 + 1e-4, (np.abs(gap).max() / surface, distance)
    # the volume of the balls by 200^3 points
    lo, hi = (at[:, :3] - at[:, 3:]).min(0), (at[:, :3] + at[:, 3:]).max(0)
    axes = [np.linspace(a, b, 201)[:-1] + (b - a) / 400 for a, b in zip(lo, hi)]
    inside = np.zeros((200, 200, 200), bool)
    for x0, y0, z0, r0 in at:
        inside |= ((axes[0] - x0) ** 2)[:, None, None] + ((axes[1] - y0) ** 2)[None, :, None] + ((axes[2] - z0) ** 2)[None, None] <= r0 * r0
    assert abs(inside.mean() * np.prod(hi - lo) / V - 1 - float(volume)) < 2e-3


if __name__ == "__main__":
    globals()[sys.argv[1]](*sys.argv[2:])
