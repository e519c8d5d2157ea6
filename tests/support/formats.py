"""formats.py WHAT ...: what formats.t asks of other programs' readers; an assertion that fails says what."""
import sys
import warnings

import numpy as np

sys.path.insert(0, "scripts")
import nsd  # noqa: E402

warnings.simplefilter("ignore")
SINGLE = 3e-7  # relative, of a number in single precision


def near(a, b, scale=1.0, eps=SINGLE):
    a, b = np.asarray(a, float), np.asarray(b, float)
    assert a.shape == b.shape, (a.shape, b.shape)
    assert np.all(np.abs(a - b) <= eps * (np.abs(b) + scale)), (a, b)


def times(a, b):
    """The product of quaternions (w, x, y, z), a row each."""
    w, v, W, V = a[:, 0], a[:, 1:], b[:, 0], b[:, 1:]
    return np.column_stack([w * W - (v * V).sum(1), w[:, None] * V + W[:, None] * v + np.cross(v, V)])


def turn(q, x):
    back = q * [1, -1, -1, -1]
    return times(times(q, np.column_stack([np.zeros(len(x)), x])), back)[:, 1:]


# ---- GSD ----

def gsd_edges(box):
    lx, ly, lz, xy, xz, yz = np.asarray(box, float)
    return np.array([[lx, 0, 0], [xy * ly, ly, 0], [xz * lz, yz * lz, lz]])


def gsd(document, path):
    """python3-gsd: every frame has the document's numbers in single precision."""
    import gsd.hoomd
    frames = list(nsd.frames(document))
    with gsd.hoomd.open(path, "rb") as trajectory:
        assert len(trajectory) == len(frames) > 0
        for s, f in zip(trajectory, frames):
            p, a = s.particles, f.file["particles/all"]
            assert s.configuration.step == f.step and p.N == len(f.id)
            assert s.log["configuration/time"][0] == f.time
            assert np.array_equal(s.log["particles/nsd_id"], f.id)
            assert np.array_equal(p.typeid[p.typeid < 2], f.kind[p.typeid < 2])
            near(p.mass, f.mass), near(p.diameter, 2 * f.radius), near(p.velocity, f.v), near(p.orientation, f.q)
            edges, image = gsd_edges(s.configuration.box), np.asarray(p.image, float)
            if "image" in a:
                image = image - a["image/value"][f.row]
            size = np.abs(edges).max()
            shift = f.x - (p.position + image @ edges)  # the centre of the box, for all the same
            near(shift, np.broadcast_to(shift[0], shift.shape), size)
            for k in range(3):
                assert "image" not in a or np.all(np.abs(p.position[:, k]) <= 0.5001 * np.abs(edges[:, k]).sum())
            spin = turn(p.orientation * [1, -1, -1, -1], f.w)
            L = times(np.asarray(p.orientation, float), np.column_stack([np.zeros(p.N), 2 * p.moment_inertia * spin]))
            near(p.angmom, L, np.abs(L).max(), 1e-6)


def gsd_shapes(document, path):
    """The shapes are the document's, of the sizes of the grains."""
    import gsd.hoomd
    f = nsd.last(document)
    table, which = f.file["nsd/shape"], f.file["particles/all/shape"][()]
    first = np.concatenate([[0], np.cumsum(table["vertices"][()])])
    with gsd.hoomd.open(path, "rb") as trajectory:
        p = trajectory[-1].particles
        seen = set()
        for i in range(p.N):
            shape = p.type_shapes[p.typeid[i]]
            if not which[i]:
                assert shape == {}
                continue
            k, r = which[i] - 1, f.radius[i]
            x, ball = table["vertex"][first[k]:first[k + 1]] * r, table["ball"][first[k]:first[k + 1]] * r
            if table["form"][k] == 1:
                assert shape["type"] == "SphereUnion"
                near(shape["centers"], x, r, 1e-8), near(shape["diameters"], 2 * ball, r, 1e-8)
            else:
                assert shape["type"] == "ConvexPolyhedron"
                near(shape["vertices"], x, r, 1e-8), near(shape["rounding_radius"], ball[0], r, 1e-8)
            seen.add(table["form"][k])
        assert seen == {1, 2, 3}, seen


if __name__ == "__main__":
    globals()[sys.argv[1]](*sys.argv[2:])
