"""ON-DEM's exchange format for packings of DEM programs, read and written by h5py.

    python3 -m nsd.ondem read rock.vtkhdf | nsd-step -n 100 -o out.h5   # or: nsd.ondem.read("rock.vtkhdf"), a Run
    python3 -m nsd.ondem write out.h5 -o rock.vtkhdf                    # its last frame

The layout is that of October 2026, which ON-DEM's working group 3 describes in the README of its implementation: a point and a row
of columns per body, NaN and -1 where a column does not apply. What the format lacks is in /nsd as in a document [nsd-format(5)] and
in columns nsd_...: shapes, the laws of pairs, the periodic cell."""
from __future__ import annotations

import argparse
import io
import os
import sys
import tempfile
from typing import Any

import numpy as np

from ._documents import Frame, last
from ._library import Error
from ._objects import Group, Source
from ._run import Run

__all__ = ["read", "write"]

SHAPES = "sphere", "box", "polyhedron", "clump", "wall", "facet", "other"
SPHERE, BOX, POLYHEDRON, CLUMP, WALL, _, OTHER = range(len(SHAPES))
FIXED = 63  # blocked_dofs: all six
CLUMP_FORM, HULL = 1, 3  # /nsd/shape/form
COLUMNS = {  # name: numbers per body, type, also where it applies to no body
    "body_id": (1, int, True), "shape_type": (1, int, True), "material_id": (1, int, True), "clump_id": (1, int, True),
    "velocity": (3, float, True), "angular_velocity": (3, float, True), "orientation": (4, float, True), "mass": (1, float, True),
    "volume": (1, float, True), "inertia": (9, float, True), "blocked_dofs": (1, int, True), "radius": (1, float, True),
    "dimensions": (3, float, False), "clump_relative_position": (3, float, False), "clump_relative_orientation": (4, float, False),
    "wall_axis": (1, int, False), "wall_sense": (1, int, False),
    "nsd_shape": (1, int, False), "nsd_radius": (1, float, False), "nsd_inertia": (1, float, False)}
LAWS = "mu", "en", "et"


def _turn(q, x):
    t = 2 * np.cross(q[..., 1:], x)
    return x + q[..., :1] * t + np.cross(q[..., 1:], t)


def _rows(n, **given):
    """Columns of n bodies, of which those not given do not apply."""
    rows = {}
    for name, (width, kind, _always) in {"x": (3, float, True), **COLUMNS}.items():
        rows[name] = np.full((n, width) if width > 1 else n, -1 if kind is int else np.nan, np.int64 if kind is int else float)
        if name in given:
            rows[name][...] = given[name]
    return rows


# ---- writing ----

def _bodies(f: Frame, shapes: dict[str, Any]):
    """The bodies, and behind them the balls of clumps, which are bodies without a mass."""
    r, row, fixed = f.radius, f.shape, np.where(f.mass > 0, 0, FIXED)
    form, moment, volume = np.zeros(1 + len(shapes.get("form", ())), int), np.ones((1, 3)), np.array([4 / 3 * np.pi])
    what, sides = np.array([SPHERE]), np.full((1, 3), np.nan)
    ends = np.cumsum(shapes["vertices"]) if shapes else []
    corners = [None, *np.split(shapes["vertex"], ends[:-1])] if shapes else [None]
    if shapes:
        form[1:], moment, volume = shapes["form"], np.vstack([moment, shapes["moment"]]), np.append(volume, shapes["volume"])
        for k, x in enumerate(corners[1:]):
            half = np.abs(x[0])
            sharp = form[k + 1] == HULL and not shapes["round"][k] > 0
            box = sharp and len(x) == 8 and shapes["faces"][k] == 6 and (np.abs(np.abs(x) - half) < 1e-12).all()
            what = np.append(what, BOX if box else CLUMP if form[k + 1] == CLUMP_FORM else POLYHEDRON if sharp else OTHER)
            sides = np.vstack([sides, 2 * half if box else np.full(3, np.nan)])
    inertia = np.zeros((len(r), 9))
    inertia[:, ::4] = f.inertia[:, None] * (moment / moment.mean(1)[:, None])[row]
    kind, ball, own = what[row], row == 0, np.where(row > 0, 1, np.nan)
    rows = [_rows(len(r), x=f.position, body_id=f.id, shape_type=kind, material_id=np.where(kind == CLUMP, -1, f.material),
                  velocity=f.velocity, angular_velocity=f.angular_velocity, orientation=f.orientation, mass=f.mass,
                  volume=volume[row] * r ** 3, inertia=inertia, blocked_dofs=fixed,
                  radius=np.where(ball, r, np.nan), dimensions=sides[row] * r[:, None], nsd_shape=np.where(ball, -1, row),
                  nsd_radius=own * r, nsd_inertia=own * f.inertia)]
    start = int(f.id.max(initial=-1)) + 1
    for i in np.flatnonzero(kind == CLUMP):
        at, n = corners[row[i]] * r[i], len(corners[row[i]])
        away = _turn(f.orientation[i], at)
        rows.append(_rows(n, x=f.position[i] + away, body_id=np.arange(start, start + n), shape_type=SPHERE,
                          material_id=f.material[i], clump_id=f.id[i],
                          velocity=f.velocity[i] + np.cross(f.angular_velocity[i], away), angular_velocity=f.angular_velocity[i],
                          orientation=f.orientation[i], blocked_dofs=fixed[i],
                          radius=r[i] * np.split(shapes["ball"], ends[:-1])[row[i] - 1], clump_relative_position=at,
                          clump_relative_orientation=[1, 0, 0, 0]))
        start += n
    return rows, start


def _walls(f: Frame, start: int):
    """Planes perpendicular to an axis, and which body each wall is; -1: it is left out."""
    body = f.file["particles/boundary/body"] if "particles/boundary/body" in f.file else {}
    n = len(body["species"][()]) if "species" in body else 0
    names = np.full(n, -1, np.int64)

    def now(name):
        where = f.file["particles/boundary/" + name]
        return np.asarray(where["value"][f.row] if isinstance(where, Group) else where[()], float).reshape(n, -1)

    if not n:
        return [], names
    q, steady = now("orientation"), (now("orientation") == [1, 0, 0, 0]).all(1)
    normal = np.where(steady[:, None], body["normal"][()], _turn(q, body["normal"][()]))
    takes = (np.abs(normal) == 1).any(1)
    takes &= body["shape"][()] == 0 if "shape" in body else True
    takes &= body["until"][()] > f.time if "until" in body else True
    k = np.flatnonzero(takes)
    axis = np.abs(normal[k]).argmax(1)
    names[k] = np.arange(start, start + len(k))
    return [_rows(len(k), x=now("position")[k], body_id=names[k], shape_type=WALL, material_id=body["species"][()][k], velocity=now("velocity")[k],
                  angular_velocity=0, orientation=[1, 0, 0, 0], mass=0, inertia=0, blocked_dofs=FIXED, wall_axis=axis,
                  wall_sense=np.sign(normal[k, axis]).astype(int))], names


def _put_block(top, name, rows, used):
    block, n = top.create_group(name, track_order=True), len(rows["body_id"])
    block.attrs["Version"], block.attrs["Type"] = [2, 5], np.bytes_("PolyData")
    block["NumberOfPoints"], block["Points"] = [n], rows["x"]
    for cells in "Vertices", "Lines", "Polygons", "Strips":
        m = n if cells == "Vertices" else 0
        for part, value in dict(NumberOfCells=[m], NumberOfConnectivityIds=[m], Offsets=np.arange(m + 1), Connectivity=np.arange(m)).items():
            block[f"{cells}/{part}"] = np.asarray(value, np.int64)
    for column in used:
        block["PointData/" + column] = rows[column]
        if COLUMNS[column][0] == 4:
            block["PointData/" + column].attrs["order"] = "wxyz"


def _put_contacts(to, f: Frame, walls):
    c, full = f.contacts, f._all["id"]
    ids = np.append(walls[::-1], full["value"][f.row] if isinstance(full, Group) else full[()])  # row -1-w is wall w
    a, b = ids[c.a + len(walls)], ids[c.b + len(walls)]
    force = np.einsum("ni,nij->nj", c.reaction, c.basis) / f.dt
    k = np.flatnonzero((a >= 0) & (force != 0).any(1))
    along = (force * c.normal).sum(1)
    group = to.create_group("ONDEM/Interactions/hard_contact")
    group.attrs["count"] = len(k)
    for name, x in dict(id1=a, id2=b, normal=c.normal, contact_point=c.point, normal_force=-along, kn=np.full(len(a), np.inf),
                        shear_force=force - along[:, None] * c.normal, ks=np.full(len(a), np.inf), friction_coefficient=c.mu,
                        overlap=-c.gap).items():
        group[name] = np.asarray(x)[k]


def _put_scene(to, f: Frame, rows):
    scene, nsd, law = to.create_group("ONDEM/Scene"), to.create_group("nsd"), f.file["nsd/material"]
    scene.attrs["time"], scene.attrs["timestep"], scene.attrs["iteration"] = f.time, f.dt, f.step
    scene["gravity"] = f.gravity
    for name, words in dict(units=["m", "kg", "s"], display_group_names=["Points", "Others"], shape_names=SHAPES).items():
        scene[name] = np.array(words, object)
    nsd.attrs["dim"] = np.int32(3)
    for name in LAWS:
        nsd["material/" + name] = law[name][()]
    for k, label in enumerate(f.material_names):
        heavy = (rows["material_id"] == k) & (rows["mass"] > 0)
        volume = rows["volume"][heavy].sum()
        m = to.create_group(f"ONDEM/Materials/{k}")
        for name, x in dict(id=k, density=rows["mass"][heavy].sum() / volume if volume > 0 else np.nan, normal_stiffness=np.inf,
                            shear_stiffness=np.inf, shear_friction=law["mu"][k, k], shear_damping=0.0, label=np.bytes_(label.encode())).items():
            m[name] = x
        m.attrs["schema_classes"] = "linear_elastic_frictional_3D"
        m.attrs["provisional"] = "hard contact: both stiffnesses are infinite"
    if f.cell:
        nsd["cell/origin"], nsd["cell/edges"] = f.cell.origin, f.cell.edges
        nsd["cell/repeats"] = np.asarray(f.cell.periodic, np.int32)
    if "nsd/shape" in f.file:
        for name, x in f.file["nsd/shape"].items():
            nsd["shape/" + name] = x[()]
        nsd["shape"].attrs["names"] = np.bytes_("\n".join(f.shape_names[1:]).encode())


def write(document: Source, target: str) -> None:
    """Writes the last frame of a document to the file target, which it replaces when it is complete. Walls other than planes
    perpendicular to an axis are left out. Raises ValueError for discs: the format is for bodies in space."""
    import h5py
    f = last(document)
    if f is None:
        raise ValueError("no frame to write")
    if int(f.file["nsd"].attrs["dim"]) == 2:
        raise ValueError("discs: ON-DEM's format is for 3D; nsd-export --to gsd writes discs")
    table = {k: v[()] for k, v in f.file["nsd/shape"].items()} if "nsd/shape" in f.file else {}
    blocks, start = _bodies(f, table)
    walls, names = _walls(f, start)
    rows = {k: np.concatenate([b[k] for b in blocks + walls]) for k in blocks[0]}
    used = [k for k, (_, kind, always) in COLUMNS.items() if always or not (rows[k] == -1 if kind is int else np.isnan(rows[k])).all()]
    beside = f"{target}.{os.getpid()}.part"
    try:
        with h5py.File(beside, "w") as to:
            top = to.create_group("VTKHDF", track_order=True)
            top.attrs["Version"], top.attrs["Type"] = [2, 5], np.bytes_("MultiBlockDataSet")
            assembly = top.create_group("Assembly", track_order=True)
            for name, spheres in ("Points", True), ("Others", False):
                k = np.flatnonzero((rows["shape_type"] == SPHERE) == spheres)
                _put_block(top, name, {c: x[k] for c, x in rows.items()}, used)
                assembly[name] = h5py.SoftLink("/VTKHDF/" + name)
            _put_scene(to, f, rows)
            if f.contacts is not None and f.contacts.reaction is not None:
                _put_contacts(to, f, names)
        os.replace(beside, target)
    finally:
        if os.path.exists(beside):
            os.remove(beside)


# ---- reading ----

def _need(good, ids, what):
    """Where a row of good is false the body is at fault."""
    if not np.all(good):
        raise ValueError(f"body {ids[np.argmin(good)]}: {what}")


def _columns(source):
    """All bodies of the file, in the order of their ids."""
    blocks = [b for name, b in source["VTKHDF"].items() if name != "Assembly" and "Points" in b] if "VTKHDF" in source else []
    if not blocks:
        raise ValueError("/VTKHDF: no block of bodies (files before October 2026 have none)")
    parts = []
    for block in blocks:
        n, data, given = len(block["Points"]), block.get("PointData", {}), {"x": block["Points"][()]}
        for name, (width, kind, _always) in COLUMNS.items():
            if name not in data:
                continue
            given[name] = data[name][()]
            if given[name].shape != ((n, width) if width > 1 else (n,)):
                raise ValueError(f"{data[name].name}: not a row for each body")
        for name in "body_id", "shape_type", "material_id":
            if name not in given:
                raise ValueError(f"{block.name}/PointData/{name}: no such column")
        for name, usual in dict(clump_id=-1, blocked_dofs=0, velocity=0, angular_velocity=0, orientation=[1, 0, 0, 0]).items():
            given.setdefault(name, usual)
        parts.append(_rows(n, **given))
    rows = {k: np.concatenate([p[k] for p in parts]) for k in parts[0]}
    order = np.argsort(rows["body_id"], kind="stable")
    return {k: x[order] for k, x in rows.items()}


class _Shapes:
    """The table of shapes of the document to be: that of /nsd/shape, and what boxes and clumps add."""

    def __init__(self, source):
        group = source.get("nsd/shape", {})
        names = group.attrs["names"] if group else b""
        self.names = (names.decode() if isinstance(names, bytes) else str(names)).splitlines()
        self.table = {name: [group[name][()]] for name in group}
        self.known: dict[bytes, int] = {}

    def add(self, called, form, vertex, moment, volume, ball, faces=np.zeros((0, 4), np.int32)):
        """The number of this shape, which may be there already."""
        key = b"".join(np.asarray(x, float).tobytes() for x in ([form], vertex, moment, ball))
        if key not in self.known:
            self.names.append(f"{called} {len(self.names) + 1}")
            self.known[key] = len(self.names)
            new = dict(form=np.int32([form]), vertices=np.int32([len(vertex)]), faces=np.int32([len(faces)]), corners=np.int32([faces.size]),
                       round=np.zeros(1), volume=np.float64([volume]), moment=np.float64([moment]), vertex=vertex, ball=ball,
                       face=np.int32([len(face) for face in faces]), corner=faces.ravel())
            for name, x in new.items():
                self.table.setdefault(name, []).append(np.asarray(x))
        return self.known[key]

    def put(self, group):
        for name, parts in self.table.items():
            group[name] = np.concatenate(parts)
        group.attrs["names"] = np.bytes_("".join(name + "\n" for name in self.names).encode())


BOX_FACES = np.int32([[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]])
BOX_CORNERS = np.array([[x, y, z] for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)])


def _box(shapes, sides):
    r = np.sqrt((sides ** 2).sum()) / 2
    a = sides / r
    moment = [(a[(k + 1) % 3] ** 2 + a[(k + 2) % 3] ** 2) / 12 for k in range(3)]
    return shapes.add("box", HULL, BOX_CORNERS * a, moment, a.prod(), np.zeros(8), BOX_FACES), r


def _volume(balls):
    """m^3: of balls that overlap, as nsd has it"""
    run = Run.from_scene({"dt": 1, "shapes": {"a": {"balls": balls.tolist()}}, "bodies": [{"x": [0, 0, 0], "shape": "a", "size": 1}]})
    with tempfile.NamedTemporaryFile() as f, run:
        run.save(f.name)
        table = last(f.name).file["nsd/shape"]  # type: ignore[union-attr]
        return float(table["volume"][0] * (balls[0, 3] / table["ball"][0]) ** 3)


def _clump(shapes, rows, i):
    own = (rows["clump_id"] == rows["body_id"][i]) & (rows["radius"] > 0) & np.isfinite(rows["clump_relative_position"]).all(1)
    at, r, moment, mass = rows["clump_relative_position"][own], rows["radius"][own], rows["inertia"][i], rows["mass"][i]
    _need(1 <= len(at) <= 4096, rows["body_id"][i:i + 1], "a clump without members, or with more than 4096")
    aside = np.abs(np.delete(moment, [0, 4, 8])).sum() <= 1e-9 * moment[::4].sum()
    _need(mass > 0 and (moment[::4] > 0).all() and aside, rows["body_id"][i:i + 1], "a clump without a mass and a diagonal inertia")
    reach = (np.sqrt((at ** 2).sum(1)) + r).max()
    volume = rows["volume"][i] if rows["volume"][i] > 0 else _volume(np.column_stack([at, r]))
    return shapes.add("clump", CLUMP_FORM, at / reach, moment[::4] / (mass * reach ** 2), volume / reach ** 3, r / reach), reach


def _set_shapes(rows, bodies, shapes):
    """The radius of the ball around each body, and its row in the table of shapes"""
    ids, radius, row = rows["body_id"], rows["radius"].copy(), np.zeros(len(rows["x"]), np.int32)
    ball = rows["shape_type"] == SPHERE
    _need(~bodies | ~ball | ((radius > 0) & np.isfinite(radius)), ids, "a sphere without a radius")
    given = bodies & ~ball & (rows["nsd_shape"] > 0)
    _need(~given | ((rows["nsd_shape"] <= len(shapes.names)) & (rows["nsd_radius"] > 0)), ids, "nsd_shape is no row of /nsd/shape")
    radius[given], row[given] = rows["nsd_radius"][given], rows["nsd_shape"][given]
    for i in np.flatnonzero(bodies & ~ball & ~given):
        if rows["shape_type"][i] == BOX:
            _need((rows["dimensions"][i] > 0).all() and np.isfinite(rows["dimensions"][i]).all(), ids[i:i + 1], "a box without dimensions")
            row[i], radius[i] = _box(shapes, rows["dimensions"][i])
        elif rows["shape_type"][i] == CLUMP:
            row[i], radius[i] = _clump(shapes, rows, i)
        else:
            _need(False, ids[i:i + 1], "a shape that the format does not describe: only nsd's own are read, in /nsd/shape")
    return radius, row


def _materials(source):
    """Their ids, labels and friction"""
    group = source.get("ONDEM/Materials", {})
    found = []
    for name, m in group.items():
        if "id" not in m or not 0 <= m["id"][()] == int(m["id"][()]) < 2 ** 31:
            raise ValueError(f"/ONDEM/Materials/{name}: no id of a material")
        label = m["label"][()] if "label" in m else b""
        label = label.decode() if isinstance(label, bytes) else str(label)
        if any(ord(c) < 32 for c in label):
            raise ValueError(f"/ONDEM/Materials/{name}: a label with control characters")
        ident = int(m["id"][()])
        found.append((ident, label if 0 < len(label) < 200 else str(ident), float(m["shear_friction"][()]) if "shear_friction" in m else np.nan))
    return found


def _kinds(rows, found, bodies, walls):
    """The number of each body's material; that of a clump may be its members'."""
    number = {ident: k for k, (ident, _label, _mu) in enumerate(found)}
    kind = np.array([number.get(int(m), -1) for m in rows["material_id"]], np.int32)
    for i in np.flatnonzero(bodies & (rows["shape_type"] == CLUMP) & (kind < 0)):
        own = np.flatnonzero(rows["clump_id"] == rows["body_id"][i])
        kind[i] = kind[own[0]] if len(own) else 0 if found else -1
    _need(~(bodies | walls) | (kind >= 0), rows["body_id"], "material_id is none of /ONDEM/Materials")
    return kind


def _laws(source, found):
    """Of all pairs: the lesser friction of two materials, as Yade has it, unless /nsd says more"""
    n = len(found)
    mu = np.array([[min(a[2], b[2]) for b in found] for a in found]).reshape(n, n)
    if "nsd/material/mu" in source:
        return {name: source["nsd/material/" + name][()] for name in LAWS}
    return dict(mu=mu if (mu >= 0).all() else np.zeros((n, n)), en=np.zeros((n, n)), et=np.zeros((n, n)))


def _moving(group, name, x, time, step):
    group[name + "/value"] = np.asarray(x)[None]
    group[name + "/time"], group[name + "/step"] = [time], [step]


def _document(source) -> bytes:
    """The document of what is in an ON-DEM file."""
    import h5py
    if "ONDEM" not in source:
        raise ValueError("an HDF5 file without the group /ONDEM")
    if "ONDEM/Scene/shape_names" not in source:
        raise ValueError("/ONDEM/Scene/shape_names: no list of the names of shapes")
    names = [SHAPES.index(n) if n in SHAPES else OTHER for n in source["ONDEM/Scene/shape_names"].asstr()[()]]
    rows, shapes, found = _columns(source), _Shapes(source), _materials(source)
    ids, what = rows["body_id"], rows["shape_type"]
    member = rows["clump_id"] >= 0
    _need(member | ((what >= 0) & (what < len(names))), ids, "shape_type is none of /ONDEM/Scene/shape_names")
    rows["shape_type"] = what = np.array([*names, SPHERE])[np.where(member, len(names), what)]
    walls, bodies, free = ~member & (what == WALL), ~member & (what != WALL), rows["blocked_dofs"] == 0
    kind = _kinds(rows, found, bodies, walls)
    _need(~walls | np.isin(rows["wall_axis"], (0, 1, 2)), ids, "a wall without wall_axis 0, 1 or 2")
    _need(~walls | (np.abs(rows["wall_sense"]) == 1), ids, "a wall with bodies on both sides: wall_sense has to be 1 or -1")
    _need(~bodies | free | (rows["blocked_dofs"] == FIXED), ids, "blocked_dofs: a body is free (0) or fixed (63)")
    _need(~bodies | ((ids >= 0) & (ids < 2 ** 31)), ids, "body_id is out of range")
    _need(np.append(np.diff(ids[bodies]) > 0, True), ids[bodies], "another body has its id")
    radius, row = _set_shapes(rows, bodies, shapes)
    diagonal = rows["inertia"][:, ::4]
    mean = np.where((row > 0) & (rows["nsd_inertia"] >= 0), rows["nsd_inertia"],
                    np.where((row == 0) & (diagonal == diagonal[:, :1]).all(1), diagonal[:, 0], diagonal.sum(1) / 3))
    _need(~bodies | ~free | ((rows["mass"] > 0) & (mean > 0)), ids, "free, and without a mass and inertia")

    scene = source["ONDEM/Scene"]
    dt, gravity = float(scene.attrs.get("timestep", 1)), np.asarray(scene["gravity"][()] if "gravity" in scene else np.zeros(3), float)
    memory = io.BytesIO()
    with h5py.File(memory, "w") as to:
        to.create_group("h5md").attrs["version"] = np.int32([1, 1])
        nsd, body, all_ = to.create_group("nsd"), to.create_group("particles/boundary/body"), to.create_group("particles/all")
        for name, x in dict(version=np.int32(2), dim=np.int32(3), dt=dt if dt > 0 else 1.0, theta=0.5, seed=np.int64(1), gravity=gravity,
                            kind=np.bytes_("packing")).items():
            nsd.attrs[name] = x
        for name, x in _laws(source, found).items():
            nsd["material/" + name] = x
        nsd["material"].attrs["kinds"] = np.bytes_("".join(label + "\n" for _ident, label, _mu in found).encode())
        if shapes.names:
            shapes.put(nsd.create_group("shape"))
            all_["shape"] = row[bodies]
        for name, x in dict(id=ids.astype(np.int32), species=kind, radius=radius, mass=np.where(free, rows["mass"], 0),
                            inertia=np.where(free, mean, 0)).items():
            all_[name] = x[bodies]
        for name, column in dict(position="x", velocity="velocity", angular_velocity="angular_velocity", orientation="orientation").items():
            _moving(all_, name, rows[column][bodies], 0.0, 0)
        box, repeats = all_.create_group("box"), np.zeros(3, bool)
        if "nsd/cell/edges" in source:
            repeats = np.asarray(source["nsd/cell/repeats"][()], bool)
            box["origin"] = source["nsd/cell/origin"][()]
            _moving(box, "edges", source["nsd/cell/edges"][()], 0.0, 0), _moving(box, "rate", np.zeros((3, 3)), 0.0, 0)
            _moving(all_, "image", np.zeros((bodies.sum(), 3), np.int32), 0.0, 0)
        box.attrs["dimension"], box.attrs["boundary"] = np.int32(3), np.where(repeats, b"periodic", b"none")
        normal = np.eye(3)[rows["wall_axis"][walls]] * rows["wall_sense"][walls, None] + 0.0  # no -0
        for name, x in dict(point=rows["x"][walls], normal=normal, velocity=rows["velocity"][walls], species=kind[walls]).items():
            body[name] = x
    return memory.getvalue()


def read(path: str) -> Run:
    """A run from the bodies and plane walls of an ON-DEM file; contacts and stiffnesses are not read. Raises OSError where there is no
    HDF5 file, ValueError and Error where it is not ON-DEM's, or has what nsd cannot be given."""
    import h5py
    with h5py.File(path) as source:
        try:
            return Run.from_document(_document(source))
        except (KeyError, AttributeError, TypeError, IndexError) as e:
            raise ValueError(f"not as ON-DEM's description has it: {e}") from e


def _main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m nsd.ondem", description="Packings in ON-DEM's exchange format.")
    parser.add_argument("what", choices=("read", "write"), help="read FILE of ON-DEM's; write the last frame of the document FILE")
    parser.add_argument("file", metavar="FILE")
    parser.add_argument("-o", "--output", metavar="OUT", help="write to OUT; read: default is standard output")
    given = parser.parse_args()
    if given.what == "write" and not given.output:
        parser.error("write: needs -o OUT")
    try:
        if given.what == "write":
            write(given.file, given.output)
            return 0
        run = read(given.file)
        run.note({"command": "nsd.ondem read", "options": {"file": given.file}})
        if given.output:
            run.save(given.output)
            return 0
        with tempfile.NamedTemporaryFile() as f:
            run.save(f.name)
            with open(f.name, "rb") as document:
                sys.stdout.buffer.write(document.read())
    except ImportError as e:
        print(f"nsd.ondem: {e}: it needs h5py (Debian: python3-h5py)", file=sys.stderr)
        return 69
    except (ValueError, Error, OSError) as e:
        print(f"nsd.ondem: {given.file}: {e}", file=sys.stderr)
        return 66 if isinstance(e, FileNotFoundError) else 65
    return 0


if __name__ == "__main__":
    sys.exit(_main())
