"""Observables of a frame: a dict of x [n][3] and v [n][3], radius, mass, kind, present (the rows that are there),
all m, s, kg; about: the job's numbers. Each gives numbers by name, the first of which is plotted.
"""
import numpy as np
from scipy.spatial import cKDTree


def overlap(x, radius):
    """The largest overlap of two balls over the smaller of their radii, not across the edges of a cell; 0 where none touch."""
    tree, wide = cKDTree(x), radius > 2 * np.median(radius)  # few wide ones would be near all others
    i, j = tree.query_pairs(2 * radius[~wide].max(), output_type="ndarray").T
    for k in np.flatnonzero(wide):
        near = np.setdiff1d(tree.query_ball_point(x[k], radius[k] + radius.max()), k)
        i, j = np.append(i, np.full(len(near), k)), np.append(j, near.astype(int))
    deep = (radius[i] + radius[j] - np.linalg.norm(x[i] - x[j], axis=1)) / np.minimum(radius[i], radius[j])
    return float(max(deep.max(initial=0), 0))


def angle(f, about):
    """By which angle the centre of mass is turned from the vertical about x: that of a flat surface."""
    m, x = f["mass"], f["x"]
    centre = (m[:, None] * x).sum(0) / m.sum()
    return {"angle": float(np.degrees(np.arctan2(centre[1], -centre[2])))}


def discharged(f, about):
    return {"discharged": float(about["mass"] - f["mass"].sum())}


def inside(f, about):
    above = int((f["x"][:, 2] > about["orifice"]).sum())
    return {"inside": above, "out": about["count"] - above}


def bed(f, about):
    """The solid fraction between two diameters above the floor and 0.8 of the height of a bed of 0.6, exactly; the
    mean kinetic energy in m g d."""
    r, z, area = f["radius"], f["x"][:, 2], about["side"] ** 2
    volume = 4 / 3 * np.pi * r ** 3
    low, high = 4 * r.mean(), 0.8 * volume.sum() / 0.6 / area

    def below(h):  # volume of each ball below h
        t = np.clip(h - z, -r, r)
        return np.pi * (r * r * (t + r) - (t ** 3 + r ** 3) / 3)

    kinetic = 0.5 * f["mass"] * (f["v"] ** 2).sum(1)
    return {"fraction": float((below(high) - below(low)).sum() / (area * (high - low))),
            "kinetic": float(kinetic.mean() / (f["mass"].mean() * about["g"] * 2 * r.mean()))}


def risen(f, about):
    """Number of the large balls with y > 0 and z > 0, the quadrant into which the drum lifts them."""
    large = f["radius"] > 1.5e-3
    return {"risen": int((large & (f["x"][:, 1] > 0) & (f["x"][:, 2] > 0)).sum()),
            "rising": int((large & (f["x"][:, 1] > 0)).sum())}


def depth(f, about):
    k = int(np.argmax(f["radius"]))
    return {"height": float(f["x"][k, 2]), "depth": float(about["top"] - f["x"][k, 2] + f["radius"][k])}
