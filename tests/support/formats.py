"""formats.py WHAT ...: what formats.t asks of other programs' readers; an assertion that fails says what."""
import sys
import warnings

import numpy as np

sys.path.insert(0, "python")
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
            assert np.array_equal(p.typeid[p.typeid < 2], f.material[p.typeid < 2])
            near(p.mass, f.mass), near(p.diameter, 2 * f.radius), near(p.velocity, f.velocity), near(p.orientation, f.orientation)
            edges, image = gsd_edges(s.configuration.box), np.asarray(p.image, float)
            if "image" in a:
                image = image - a["image/value"][f.row]
            size = np.abs(edges).max()
            shift = f.position - (p.position + image @ edges)  # the centre of the box, for all the same
            near(shift, np.broadcast_to(shift[0], shift.shape), size)
            for k in range(3):
                assert "image" not in a or np.all(np.abs(p.position[:, k]) <= 0.5001 * np.abs(edges[:, k]).sum())
            spin = turn(p.orientation * [1, -1, -1, -1], f.angular_velocity)
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


# ---- VTKHDF ----

TOPOLOGIES = "Vertices", "Lines", "Polygons", "Strips"


def text_of(group, name):
    """VTK takes only text of fixed length in ASCII."""
    import h5py
    kind = h5py.check_string_dtype(group.attrs.get_id(name).dtype)
    assert kind.encoding == "ascii" and kind.length, kind
    return group.attrs[name].decode()


def check_structure(block, composite=False):
    """Literally what VTK's specification asks of temporal PolyData."""
    assert text_of(block, "Type") == "PolyData"
    version = block.attrs["Version"]
    assert version.dtype.kind == "i" and version.shape == (2,) and version[0] == 2
    steps = block["Steps"]
    F = int(steps.attrs["NSteps"])
    parts = len(block["NumberOfPoints"])
    assert steps["Values"].shape == (F,) and np.all(np.diff(steps["Values"][()]) > 0)
    for name, shape in dict(PartOffsets=(F,), NumberOfParts=(F,), PointOffsets=(F,), CellOffsets=(F, 4),
                            ConnectivityIdOffsets=(F, 4)).items():
        assert steps[name].shape == shape and steps[name].dtype.kind == "i", name
    assert block["Points"].ndim == 2 and block["Points"].shape[1] == 3
    for name in TOPOLOGIES:
        cells, ids = block[name]["NumberOfCells"][()], block[name]["NumberOfConnectivityIds"][()]
        assert cells.shape == ids.shape == (parts,)
        assert block[name]["Offsets"].shape == (np.sum(cells + 1),)  # sum of (S(i) + 1)
        assert block[name]["Connectivity"].shape == (ids.sum(),)
    for name, array in block.get("PointData", {}).items():
        offsets = steps.get("PointDataOffsets/" + name)
        at = steps["PointOffsets"][()] if offsets is None else offsets[()]
        n = np.array([block["NumberOfPoints"][p] for p in steps["PartOffsets"][()]])
        assert at.shape == (F,) and np.all(at + n <= len(array)), name
    return F


def vtk_step(block, f):
    """Step f as vtkHDFReader of VTK 9.3 (where part p has p entries of Offsets before it) reads PolyData, and of
    VTK 9.5, which counts the parts before by their cells; both have to agree."""
    steps = block["Steps"]
    part, parts = int(steps["PartOffsets"][f]), int(steps["NumberOfParts"][f])
    assert parts == 1
    n, at = int(block["NumberOfPoints"][part]), int(steps["PointOffsets"][f])
    out = {"points": block["Points"][at:at + n]}
    starts = [int(k) for k in steps["CellOffsets"][f]]
    count = 0
    for k, name in enumerate(TOPOLOGIES):
        sizes = block[name]["NumberOfCells"][()]
        cells, ids = int(sizes[part]), int(block[name]["NumberOfConnectivityIds"][part])
        before, total = 0, 0
        for size in sizes[:part]:
            if total >= starts[k]:
                break
            before, total = before + 1, total + size
        first = int(steps["ConnectivityIdOffsets"][f][k])
        connectivity = block[name]["Connectivity"][first:first + ids]
        if cells:
            assert before == part or not starts[k], (before, part)
            offsets = block[name]["Offsets"][starts[k] + before:][:cells + 1]
            assert np.array_equal(offsets, block[name]["Offsets"][starts[k] + part:][:cells + 1])
            assert offsets[0] == 0 and offsets[-1] == ids and np.all(np.diff(offsets) > 0)
            assert connectivity.min() >= 0 and connectivity.max() < n
            out[name] = np.split(connectivity, offsets[1:-1])
        count += cells
    for kind, size, start in ("PointData", n, at), ("CellData", count, sum(starts)):
        for name, array in block.get(kind, {}).items():
            offsets = steps.get(f"{kind}Offsets/{name}")
            first = start if offsets is None else int(offsets[f])
            out[name] = array[first:first + size]
            assert len(out[name]) == size
    return out


def same(a, b):
    assert np.array_equal(np.asarray(a), np.asarray(b)), (a, b)


def check_grains(block, frames):
    for f, frame in enumerate(frames):
        s = vtk_step(block, f)
        assert block["Steps/Values"][f] == frame.time
        same(s["points"], frame.position)
        same(np.concatenate(s.get("Vertices", [np.zeros(0)])), np.arange(len(frame.id)))
        for name, value in dict(radius=frame.radius, mass=frame.mass, id=frame.id, material=frame.material, velocity=frame.velocity,
                                angular_velocity=frame.angular_velocity, orientation=frame.orientation).items():
            same(s[name], value)


def vtkhdf(document):
    """/VTKHDF of grains alone."""
    import h5py
    frames = list(nsd.frames(document))
    block = h5py.File(document)["VTKHDF"]
    assert check_structure(block) == len(frames)
    check_grains(block, frames)


def not_stored_twice(document):
    """Where bodies stay: hard links and virtual datasets in this very file."""
    import h5py
    with h5py.File(document) as f:
        for name, other in dict(radius="radius", mass="mass", id="id", material="species").items():
            assert f["VTKHDF/PointData/" + name] == f["particles/all/" + other]
        for name in "Points", "PointData/velocity", "PointData/orientation", "PointData/angular_velocity":
            set_ = f["VTKHDF/" + name]
            assert set_.is_virtual and all(s.file_name == "." for s in set_.virtual_sources())


def volume_of(points, polygons):
    total = 0.0
    for p in polygons:
        x = points[p].astype(float)
        for k in range(1, len(p) - 1):
            total += np.dot(x[0], np.cross(x[k], x[k + 1])) / 6
    return total


def blocks(document, density):
    """The collection: grains, surfaces that hold the grains' mass, and walls; VTK's order of the blocks."""
    import h5py
    frames = list(nsd.frames(document))
    top = h5py.File(document)["VTKHDF"]
    assert text_of(top, "Type") == "PartitionedDataSetCollection" and list(top.attrs["Version"]) == [2, 1]
    flags = h5py.h5p.CRT_ORDER_TRACKED | h5py.h5p.CRT_ORDER_INDEXED
    for group in top, top["Assembly"]:
        assert group.id.get_create_plist().get_link_creation_order() == flags
    for k, name in enumerate(("grains", "surfaces", "walls")):
        assert top[name].attrs["Index"] == k
        assert isinstance(top["Assembly"].get(name, getlink=True), h5py.SoftLink)
        assert check_structure(top[name]) == len(frames)
        assert top["Assembly/" + name] == top[name]
    check_grains(top["grains"], frames)
    for f, frame in enumerate(frames):
        s, shape = vtk_step(top["surfaces"], f), vtk_step(top["grains"], f)["shape"]
        for i in np.flatnonzero(shape):
            mine = [p for p, owner in zip(s["Polygons"], s["id"]) if owner == frame.id[i]]
            near(volume_of(s["points"], mine) * density, frame.mass[i], frame.mass[i], 1e-5)
        walls = vtk_step(top["walls"], f)
        assert len(walls.get("Polygons", [])) == len(walls["wall"]) > 0


def collection(document):
    """The blocks of any scene can be read, step by step."""
    import h5py
    frames = list(nsd.frames(document))
    top = h5py.File(document)["VTKHDF"]
    for name in "grains", "surfaces", "walls":
        assert check_structure(top[name]) == len(frames)
        for f in range(len(frames)):
            step = vtk_step(top[name], f)
            assert name != "walls" or f < len(frames) - 1 or len(step["wall"]) > 0
    check_grains(top["grains"], frames)


def vtk_reads(document, copy):
    """VTK 9.1 knows no PolyData. What it knows of VTKHDF is the unstructured grid: with our points, behind the 512
    bytes, as virtual dataset and by the hard links."""
    import shutil
    import h5py
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    frame = nsd.last(document)
    shutil.copy(document, copy)
    with h5py.File(copy, "r+") as f:
        assert f.userblock_size == 512
        top, n = f["VTKHDF"], len(frame.id)
        assert top["Steps"].attrs["NSteps"] == 1
        for name, value in ("Type", np.bytes_("UnstructuredGrid")), ("Version", np.array([1, 0])):
            del top.attrs[name]
            top.attrs[name] = value
        for name in "Connectivity", "Offsets", "NumberOfCells", "NumberOfConnectivityIds":
            top[name] = top["Vertices/" + name]
        top["Types"] = np.ones(n, np.uint8)  # VTK_VERTEX
    reader = vtk.vtkHDFReader()
    assert reader.CanReadFile(copy)
    reader.SetFileName(copy)
    reader.Update()
    out = reader.GetOutput()
    same(vtk_to_numpy(out.GetPoints().GetData()), frame.position)
    assert out.GetNumberOfCells() == n
    for name, value in dict(radius=frame.radius, id=frame.id, velocity=frame.velocity, orientation=frame.orientation).items():
        same(vtk_to_numpy(out.GetPointData().GetArray(name)), value)


# ---- ON-DEM ----

def ondem(document, path):
    """As ON-DEM's working group describes it (layout of October 2026), column by column."""
    import h5py
    frame = nsd.last(document)
    with h5py.File(path) as f:
        top, scene = f["VTKHDF"], f["ONDEM/Scene"]
        assert text_of(top, "Type") == "MultiBlockDataSet" and list(top.attrs["Version"]) == [2, 5]
        assert [n for n in scene["display_group_names"].asstr()] == list(top["Assembly"]) == ["Points", "Others"]
        names = list(scene["shape_names"].asstr())
        assert scene.attrs["time"] == frame.time and scene.attrs["iteration"] == frame.step
        same(scene["gravity"], frame.gravity)
        columns, rows = None, {}
        for name in top["Assembly"]:
            assert isinstance(top["Assembly"].get(name, getlink=True), h5py.SoftLink)
            block = top["Assembly"][name]
            assert text_of(block, "Type") == "PolyData" and block["Points"].dtype == np.float64
            n = int(block["NumberOfPoints"][0])
            for topology in TOPOLOGIES:
                cells = n if topology == "Vertices" else 0
                assert block[topology]["NumberOfCells"][0] == block[topology]["NumberOfConnectivityIds"][0] == cells
                same(block[topology]["Connectivity"], np.arange(cells)), same(block[topology]["Offsets"], np.arange(cells + 1))
            data = block["PointData"]
            assert columns in (None, set(data)), "each block has the same columns"
            columns = set(data)
            assert data["orientation"].attrs["order"] == "wxyz"
            for i in range(n):
                row = {k: v[i] for k, v in data.items()}
                row["x"], row["group"], row["shape"] = block["Points"][i], name, names[row["shape_type"]]
                rows[int(row["body_id"])] = row
        for i, id_ in enumerate(frame.id):
            r = rows[id_]
            same(r["x"], frame.position[i]), same(r["velocity"], frame.velocity[i]), same(r["angular_velocity"], frame.angular_velocity[i])
            same(r["orientation"], frame.orientation[i]), same(r["mass"], frame.mass[i])
            assert r["clump_id"] == -1 and r["blocked_dofs"] == (0 if frame.mass[i] else 63)
            near(np.trace(r["inertia"].reshape(3, 3)) / 3, frame.inertia[i], frame.inertia[i], 1e-14)
            assert (r["group"] == "Points") == (r["shape"] == "sphere")
            assert r["radius"] == frame.radius[i] if r["shape"] == "sphere" else np.isnan(r["radius"])
            if r["shape"] == "box":
                near(np.prod(r["dimensions"]), r["volume"], r["volume"], 1e-12)
            if r["shape"] == "clump":
                members = [m for m in rows.values() if m["clump_id"] == id_]
                assert len(members) > 1
                for m in members:
                    away = turn(frame.orientation[i:i + 1], m["clump_relative_position"][None])[0]
                    near(m["x"], frame.position[i] + away, 1, 1e-14)
                    near(m["velocity"], frame.velocity[i] + np.cross(frame.angular_velocity[i], away), 1, 1e-14)
        for r in rows.values():
            if r["shape"] == "wall":
                assert r["wall_axis"] in (0, 1, 2) and abs(r["wall_sense"]) == 1
        for key, m in f["ONDEM/Materials"].items():
            assert m["id"][()] == int(key) and m["shear_friction"][()] == f["nsd/material/mu"][int(key), int(key)]
        if frame.contacts is not None:
            it, c = f["ONDEM/Interactions/hard_contact"], frame.contacts
            push = np.flatnonzero((c.force ** 2).sum(1) > 0)
            assert it.attrs["count"] == len(push) > 0
            near(it["normal_force"], -c.normal_force[push], 0, 1e-12)  # positive in traction
            total = it["shear_force"][()] - it["normal_force"][()][:, None] * it["normal"][()]
            near(total, c.force[push], np.abs(c.force).max(), 1e-12)
            assert set(it["id1"]) | set(it["id2"]) <= set(rows)


def ondem_foreign(path):
    """A file as another program would write it, without nsd's extension: two spheres, a box, two walls."""
    import h5py
    with h5py.File(path, "w") as f:
        top = f.create_group("VTKHDF", track_order=True)
        text = h5py.string_dtype()
        names = np.array(["facet", "wall", "box", "sphere"], dtype=object)
        scene = f.create_group("ONDEM/Scene")
        scene.attrs["time"], scene.attrs["timestep"], scene.attrs["iteration"] = 1.5, 1e-5, 7
        scene["gravity"] = [0.0, 1.0, -9.0]
        scene.create_dataset("shape_names", data=names, dtype=text)
        for k, mu in (4, 0.3), (9, 0.5):
            m = f.create_group(f"ONDEM/Materials/{k}")
            m["id"], m["density"], m["shear_friction"], m["label"] = k, 2600.0, mu, np.bytes_(f"rock{k}")
        nan = np.nan
        for name, rows in dict(Points=[(5, 3, 4, 0, [0, 0, 1], 0.1, [nan] * 3, 0), (2, 3, 9, 0, [1, 0, 1], 0.2, [nan] * 3, 0)],
                               Others=[(3, 2, 4, 0, [2, 0, 1], nan, [0.2, 0.3, 0.4], 0), (7, 1, 9, 63, [0, 0, 0], nan, [nan] * 3, 2),
                                       (8, 1, 9, 63, [0, 3, 0], nan, [nan] * 3, 1)]).items():
            b = top.create_group(name, track_order=True)
            n = len(rows)
            b["NumberOfPoints"], b["Points"] = [n], np.array([r[4] for r in rows], float)
            d = b.create_group("PointData")
            d["body_id"], d["shape_type"] = [r[0] for r in rows], [r[1] for r in rows]
            d["material_id"], d["blocked_dofs"] = [r[2] for r in rows], [r[3] for r in rows]
            d["clump_id"] = [-1] * n
            d["radius"], d["dimensions"] = [r[5] for r in rows], [r[6] for r in rows]
            d["mass"], d["inertia"] = np.full(n, 2.0), np.tile(np.diag([0.1, 0.1, 0.1]).ravel(), (n, 1))
            d["velocity"], d["angular_velocity"] = np.tile([1.0, 2, 3], (n, 1)), np.zeros((n, 3))
            q = d.create_dataset("orientation", data=np.tile([1.0, 0, 0, 0], (n, 1)))
            q.attrs["order"] = "wxyz"
            d["wall_axis"] = [r[7] if r[1] == 1 else -1 for r in rows]
            d["wall_sense"] = [-1 if r[0] == 8 else 1 if r[1] == 1 else -1 for r in rows]


if __name__ == "__main__":
    globals()[sys.argv[1]](*[float(a) if a.replace(".", "", 1).isdigit() else a for a in sys.argv[2:]])
