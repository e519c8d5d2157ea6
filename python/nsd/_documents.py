"""Frames and contact problems of documents of nsd [nsd-format(5)] in Python, by libnsd and numpy; SI units throughout.

    import nsd
    for frame in nsd.frames("out.h5"):          # a trajectory, documents back to back, or "-"
        print(frame.step, frame.time, frame.position[:, 2].max())
    contacts = nsd.last("out.h5").contacts      # None: the document keeps none
    print(contacts.force[:3])                   # N, on b, in space
    problem = nsd.fclib("problem.hdf5")         # W, q, mu ...

Arrays are read when they are asked for. What a frame's document does not have is None.
"""
from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np

from ._objects import Document, Group, Source, documents
from ._run import Cell, _walls

__all__ = ["Contacts", "Document", "Frame", "Problem", "documents", "fclib", "frames", "last"]


class Contacts:
    """The contacts of a frame, one row each; a is -1-w for boundary w."""

    def __init__(self, group, rows, dt):
        self._group, self._rows, self._dt = group, rows, dt

    def __len__(self):
        return self._rows.stop - self._rows.start

    def _column(self, name):
        return self._group[name][self._rows] if name in self._group else None

    @cached_property
    def a(self):
        return self._column("body")[:, 0]

    @cached_property
    def b(self):
        return self._column("body")[:, 1]

    point = cached_property(lambda self: self._column("point"))  # m
    basis = cached_property(lambda self: self._column("frame"))  # [n][3][3]: rows n, t1, t2
    gap = cached_property(lambda self: self._column("gap"))  # m; negative: overlap
    mu = cached_property(lambda self: self._column("mu"))
    reaction = cached_property(lambda self: self._column("reaction"))  # N s, in the basis
    velocity = cached_property(lambda self: self._column("velocity"))  # m/s, in the basis
    status = cached_property(lambda self: self._column("status"))  # 0 free, 1 stick, 2 slide

    @cached_property
    def normal(self):
        """Unit vectors from a to b."""
        return self.basis[:, 0]

    @cached_property
    def force(self):
        """N: [n][3] the force on b, in the axes of space; None if the contacts are not solved."""
        if self.reaction is None:
            return None
        return np.einsum("ni,nij->nj", self.reaction, self.basis) / self._dt

    @cached_property
    def normal_force(self):
        """N: the part of the force along the normal; negative where cohesion, liquid or bonds pull."""
        return None if self.reaction is None else self.reaction[:, 0] / self._dt

    @cached_property
    def tangential_force(self):
        """N: the magnitude of the tangential part."""
        return None if self.reaction is None else np.hypot(*self.reaction[:, 1:].T) / self._dt


# Names of version 1, for programs that have them
_BEFORE = {"x": "position", "v": "velocity", "w": "angular_velocity", "q": "orientation", "kind": "material", "kind_names": "material_names"}


class Frame:
    """One frame of a document."""

    def __init__(self, file: Document, row: int):
        self.file, self.row = file, row
        self._all = file["particles/all"]
        self.step = int(self._all["position/step"][row])
        self.time = float(self._all["position/time"][row])  # s
        adapts = "nsd/time_step" in file
        self.dt = float(file["nsd/time_step/value"][row] if adapts else file["nsd"].attrs["dt"])  # s
        self.gravity = np.array(file["nsd"].attrs["gravity"])  # m/s^2

    def __repr__(self):
        return f"<nsd frame of step {self.step}: {len(self.id)} bodies>"

    @cached_property
    def _rows(self):
        """With inlets or outlets the rows of the bodies in this frame; else all."""
        if isinstance(self._all["id"], Group):
            return np.flatnonzero(self._all["id/value"][self.row] >= 0)
        return slice(None)

    def _moving(self, name):
        return self._all[name]["value"][self.row][self._rows]

    def _fixed(self, name):
        return self._all[name][()][self._rows]

    def __getattr__(self, name):
        """Any other number of the bodies, by the name of its dataset in nsd-format(5)."""
        if name in _BEFORE:
            return getattr(self, _BEFORE[name])
        if name.startswith("_") or name not in self._all:
            raise AttributeError(f"the document has no {name} of bodies", name=name, obj=self)
        return self._moving(name) if isinstance(self._all[name], Group) else self._fixed(name)

    position = cached_property(lambda self: self._moving("position"))  # m
    velocity = cached_property(lambda self: self._moving("velocity"))  # m/s
    angular_velocity = cached_property(lambda self: self._moving("angular_velocity"))  # rad/s
    orientation = cached_property(lambda self: self._moving("orientation"))  # unit quaternions (w, x, y, z)
    radius = cached_property(lambda self: self._fixed("radius"))  # m
    mass = cached_property(lambda self: self._fixed("mass"))  # kg
    inertia = cached_property(lambda self: self._fixed("inertia"))  # kg m^2

    @cached_property
    def id(self):
        moves = isinstance(self._all["id"], Group)
        return self._moving("id") if moves else self._fixed("id")

    material = cached_property(lambda self: self._fixed("species"))

    @cached_property
    def material_names(self):
        """The name of each material: material_names[material[i]] is that of grain i."""
        return _lines(self.file["nsd/material"].attrs["kinds"])

    @cached_property
    def shape(self):
        """The number of each grain's shape in shape_names; all 0, balls, if the document has no shapes."""
        return self._fixed("shape") if "shape" in self._all else np.zeros(len(self.id), np.int32)

    @cached_property
    def shape_names(self):
        """The name of each shape; the first is the ball."""
        return ["ball", *(_lines(self.file["nsd/shape"].attrs["names"]) if "nsd/shape" in self.file else [])]

    @cached_property
    def _vertices(self):
        """The vertices of each shape: corners, ends of a capsule, centres of the balls of a clump, in units of its radius."""
        if "nsd/shape" not in self.file:
            return [np.zeros((0, 3))]
        group = self.file["nsd/shape"]
        ends = np.cumsum(group["vertices"][()])
        return [np.zeros((0, 3)), *np.split(group["vertex"][()], ends[:-1])]

    def corners(self, i):
        """m: [corners, 3] the positions of the corners of grain i (its row); for a capsule of its ends, for a clump of the centres
        of its balls, for a ball none."""
        w, u = self.q[i, 0], self.q[i, 1:]
        v = self._vertices[self.shape[i]]
        t = 2 * np.cross(u, v)
        return self.x[i] + self.radius[i] * (v + w * t + np.cross(u, t))

    @cached_property
    def names(self):
        """All names of walls, parts of walls and groups of grains."""
        return _lines(self.file["nsd/names/text"][()]) if "nsd/names/text" in self.file else []

    @cached_property
    def group(self):
        """The name of each grain's group; None: no group."""
        rows = self._fixed("group") if "group" in self._all else np.zeros(len(self.id), np.int32)
        return np.array([self.names[k - 1] if k else None for k in rows], object)

    @cached_property
    def wall_names(self):
        """The name of each wall; None: no name."""
        body = self.file["particles/boundary/body/point"] if "particles/boundary/body/point" in self.file else []
        found = [None] * len(body)
        for name, wall, (_, count) in self._named:
            if not count:
                found[wall] = name
        return found

    @cached_property
    def _named(self):
        if "nsd/names/boundary" not in self.file:
            return []
        group = self.file["nsd/names"]
        return [(self.names[k], int(wall), faces) for k, wall, faces in
                zip(group["name"][()], group["boundary"][()], group["faces"][()])]

    def walls(self, name):
        """The numbers of the walls that have this name, or of which a part has it, in order; a number stands for that wall.
        Raises KeyError, which is a ValueError too."""
        named = {}
        for own, wall, _ in self._named:
            named.setdefault(own, set()).add(wall)
        return _walls(name, len(self.wall_names), {own: sorted(found) for own, found in named.items()})

    @cached_property
    def cell(self):
        """The periodic cell, as that of a Run; None: no direction is periodic."""
        box = self._all["box"] if "box" in self._all else None
        periodic = np.array([b == "periodic" for b in box.attrs.get("boundary") or ()] if box else [], bool)
        if not periodic.any():
            return None
        moves = isinstance(box["edges"], Group)
        edges = np.asarray(box["edges/value"][self.row] if moves else box["edges"][()], float)
        rates = box["rate/value"][self.row] if "rate" in box else np.zeros((3, 3))
        origin = box["origin"][()] if "origin" in box else np.zeros(3)
        return Cell(origin, np.diag(edges) if edges.ndim == 1 else edges, rates, periodic)

    @cached_property
    def contacts(self):
        """The frame's contacts; None if the document does not contain them."""
        if "contacts" not in self.file:
            return None
        group = self.file["contacts"]
        at = np.flatnonzero(group["step"][()] == self.step)
        if not len(at):
            return None
        start, count = (int(group[name][at[-1]]) for name in ("start", "count"))
        return Contacts(group, slice(start, start + count), self.dt)

    @cached_property
    def report(self):
        """The report of the solve: {"sweeps": ..., "natural": ...}; None: no report."""
        for place in "nsd/solver", "observables/solver":  # the second until nsd 0.1
            if place in self.file:
                break
        else:
            return None
        group = self.file[place]
        steps = group["step"][()]
        at = np.flatnonzero(steps == self.step)
        if len(steps) == 1 and self._all["position/step"].shape[0] == 1:
            at = [0]
        if not len(at):
            return None
        return {name: group[name]["value"][at[-1]] for name in group
                if isinstance(group[name], Group)}


def _lines(text):
    return list(text) if isinstance(text, np.ndarray) else str(text).splitlines()


def _count(file):
    """The number of complete frames: a trajectory may be growing."""
    group = file["particles/all"]
    names = "position", "velocity", "angular_velocity", "orientation"
    count = min(group[name]["value"].shape[0] for name in names)
    steps = group["position/step"][:min(count, group["position/time"].shape[0])]
    back = np.flatnonzero(np.diff(steps) <= 0)  # room for a step that is not written yet
    return int(back[0]) + 1 if len(back) else len(steps)


def frames(source: Source = "-") -> Iterator[Frame]:
    """The frames of all documents of the source, one after another: of a file, an open binary stream, or standard input ("-").
    Raises what documents() does."""
    for file in documents(source):
        for row in range(_count(file)):
            yield Frame(file, row)


def last(source: Source = "-") -> Frame | None:
    """The last frame of all documents of the source; None: no frame. Raises what documents() does."""
    frame = None
    for file in documents(source):
        count = _count(file)
        frame = Frame(file, count - 1) if count else frame
    return frame


class Problem:
    """A contact problem in the FCLIB format: u = W r + q, or M v = H r + G l + f, u = H* v + w."""

    def __init__(self, file):
        self.is_global = "fclib_global" in file
        group = file["fclib_global" if self.is_global else "fclib_local"]
        vectors = group["vectors"]
        self.dim = int(group["spacedim"][0])
        for name in ("M", "H", "G") if self.is_global else ("W",):
            setattr(self, name, _matrix(group[name]) if name in group else None)
        for name in "mu", "q", "f", "w", "b":
            setattr(self, name, vectors[name][()] if name in vectors else None)
        solution = file["solution"] if "solution" in file else {}
        for name in "u", "r", "v", "l":
            setattr(self, name, solution[name][()] if name in solution else None)


def _matrix(group):
    """A sparse matrix of FCLIB: scipy's if scipy is installed, else a dense array. Repeated entries are added."""
    m, n, kind = (int(group[name][0]) for name in ("m", "n", "nz"))
    p, i, x = (group[name][()] for name in ("p", "i", "x"))
    if kind >= 0:
        rows, columns, x = i[:kind], p[:kind], x[:kind]
    else:
        lines = m if kind == -2 else n
        outer = np.repeat(np.arange(lines), np.diff(p[:lines + 1]))
        inner, x = i[:len(outer)], x[:len(outer)]
        rows, columns = (outer, inner) if kind == -2 else (inner, outer)
    try:
        from scipy.sparse import coo_matrix
        return coo_matrix((x, (rows, columns)), shape=(m, n)).tocsr()
    except ImportError:
        dense = np.zeros((m, n))
        np.add.at(dense, (rows, columns), x)
        return dense


def fclib(source: Source = "-") -> Problem:
    """The first contact problem in the FCLIB format among the documents of the source. Raises what documents() does, and ValueError if
    there is none."""
    for file in documents(source):
        if "fclib_local" in file or "fclib_global" in file:
            return Problem(file)
    raise ValueError("no problem in the FCLIB format")
