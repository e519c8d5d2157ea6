"""export.py WHAT ...: what export.t asks of other programs' readers; an assertion that fails says what."""
import glob
import os
import subprocess
import sys
import time
import warnings

import numpy as np

sys.path.insert(0, "python")
import nsd  # noqa: E402

warnings.simplefilter("ignore")


def vtk_read(path):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    reader = (vtk.vtkXMLPolyDataReader if path.endswith("vtp") else vtk.vtkXMLUnstructuredGridReader)()
    reader.SetFileName(path)
    reader.Update()
    out = reader.GetOutput()
    assert reader.GetErrorCode() == 0

    def arrays(data):
        return {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}
    x = vtk_to_numpy(out.GetPoints().GetData()) if out.GetNumberOfPoints() else np.zeros((0, 3))
    cells = []
    for k in range(out.GetNumberOfCells()):
        ids = out.GetCell(k).GetPointIds()
        cells.append([ids.GetId(i) for i in range(ids.GetNumberOfIds())])
    return x, cells, arrays(out.GetPointData()), arrays(out.GetCellData()), arrays(out.GetFieldData())


def same(a, b):
    assert np.array_equal(np.asarray(a), np.asarray(b)), (a, b)


def check_grains(path, frame):
    x, cells, data, _, field = vtk_read(path)
    same(x, frame.position), same(cells, np.arange(len(x))[:, None])
    for name, value in dict(id=frame.id, material=frame.material, radius=frame.radius, mass=frame.mass,
                            velocity=frame.velocity, angular_velocity=frame.angular_velocity, orientation=frame.orientation).items():
        same(data[name], value)
    same(field["step"], [frame.step]), same(field["TimeValue"], [frame.time])
    return data


def check_contacts(path, frame):
    x, cells, _, data, _ = vtk_read(path)
    c = frame.contacts
    same(len(cells), len(c))
    if not len(c):
        return
    ends = x[np.array(cells)]
    same(ends[:, 1], frame.position[c.b])
    same(ends[:, 0], np.where(c.a[:, None] >= 0, frame.position[c.a], c.point))
    same(data["body"], np.stack([c.a, c.b], 1)), same(data["gap"], c.gap), same(data["status"], c.status)
    same(data["normal"], c.normal), same(data["point"], c.point)
    largest = abs(c.force).max()
    assert abs(data["force"] - c.force).max() <= 1e-14 * largest
    # the parts of that vector, seen by the normal
    normal = (data["force"] * data["normal"]).sum(1)
    assert abs(normal - data["normal_force"]).max() <= 1e-12 * largest
    across = np.linalg.norm(data["force"] - normal[:, None] * data["normal"], axis=1)
    assert abs(across - data["tangential_force"]).max() <= 1e-12 * largest


def check_walls(path, frame):
    x, cells, _, data, _ = vtk_read(path)
    same(sorted(data["wall"]), range(5))
    for k, corners in enumerate(cells):
        assert len(corners) >= 3
        off = (x[corners] - data["point"][k]) @ data["normal"][k]
        assert abs(off).max() < 1e-9
        inside = ((frame.position - data["point"][k]) @ data["normal"][k])
        assert inside.min() > 0  # the grains are on the side of the normal


def directory(document, folder, ending):
    frames = list(nsd.frames(document))
    for k, frame in enumerate(frames):
        check_grains(f"{folder}/grains-{k:05}.{ending}", frame)
        check_contacts(f"{folder}/contacts-{k:05}.{ending}", frame)
        check_walls(f"{folder}/walls-{k:05}.{ending}", frame)
    assert not glob.glob(folder + "/cell*")  # nothing repeats


def pvd(document, folder):
    import xml.etree.ElementTree as tree
    frames = list(nsd.frames(document))
    for part in "grains", "contacts", "walls":
        sets = list(tree.parse(f"{folder}/{part}.pvd").getroot().iter("DataSet"))
        same([float(s.get("timestep")) for s in sets], [f.time for f in frames])
        assert all(os.path.exists(f"{folder}/{s.get('file')}") for s in sets)


def growing(folder):
    """Every list that is there while the run goes on is whole, and names files that are."""
    import xml.etree.ElementTree as tree
    seen = set()
    for _ in range(2000):
        try:
            with open(folder + "/grains.pvd") as f:
                text = f.read()
        except FileNotFoundError:
            time.sleep(0.005)
            continue
        if text:
            sets = list(tree.fromstring(text).iter("DataSet"))
            assert all(os.path.exists(f"{folder}/{s.get('file')}") for s in sets)
            seen.add(len(sets))
        if len(seen) > 3:
            return
        time.sleep(0.005)
    raise AssertionError(seen)


def stl(path, document, detail):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    frame = nsd.last(document)
    reader = vtk.vtkSTLReader()
    reader.SetFileName(path)
    reader.MergingOff()
    reader.Update()
    out = reader.GetOutput()
    x = vtk_to_numpy(out.GetPoints().GetData()).astype(float).reshape(-1, 3, 3)
    each = 20 * 4 ** detail
    balls = x[:each * len(frame.position)].reshape(len(frame.position), each, 3, 3)
    # by the divergence theorem: positive where triangles are seen from outside
    off = balls - frame.position[:, None, None]
    volume = np.einsum("bti,bti->b", off[:, :, 0], np.cross(off[:, :, 1], off[:, :, 2])) / 6
    share = volume / (4 / 3 * np.pi * frame.radius ** 3)
    # the icosahedron in a unit ball has 2.53615 m^3 of 4.18879
    expected = {0: 2.536150 / 4.188790}.get(detail, 1 - 0.394 / 3.6 ** detail)
    assert np.ptp(share) < 1e-3 and abs(share.mean() - expected) < 0.03, (share.mean(), expected)
    reach = np.linalg.norm(off, axis=-1) / frame.radius[:, None, None]
    assert abs(reach - 1).max() < 1e-3  # corners are on the ball
    assert len(x) - each * len(frame.position) >= 10  # five walls


def surfaces(path, document, density):
    """Each grain's polygons close, and hold its mass about its centre."""
    x, cells, _, data, field = vtk_read(path)
    frame = nsd.last(document)
    same(field["step"], [frame.step])
    volume, first = np.zeros(len(frame.position)), np.zeros((len(frame.position), 3))
    row = {id: i for i, id in enumerate(frame.id)}
    for k, corners in enumerate(cells):
        i = row[data["id"][k]]
        p = x[corners] - frame.position[i]
        for a, b in zip(p[1:], p[2:]):
            v = np.dot(p[0], np.cross(a, b)) / 6
            volume[i] += v
            first[i] += v * (p[0] + a + b) / 4
        same(data["velocity"][k], frame.velocity[i]), same(data["mass"][k], frame.mass[i])
    seen = volume > 0
    assert seen.sum() == (data["shape"].max() > 0) * len(set(data["id"])) > 0
    assert abs(volume * density / frame.mass - 1)[seen].max() < 1e-6
    assert (np.linalg.norm(first, axis=1) / (volume * frame.radius))[seen].max() < 1e-6


def xyz(path, document):
    import ase.io
    read = ase.io.read(path, index=":", format="extxyz")
    frames = list(nsd.frames(document))
    same(len(read), len(frames))
    for a, f in zip(read, frames):
        same(a.positions, f.position), same(a.arrays["radius"], f.radius), same(a.arrays["id"], f.id)
        same(a.arrays["velo"], f.velocity), same(a.arrays["orientation"], np.roll(f.orientation, -1, 1))
        same(a.info["Step"], f.step), same(a.info["Time"], f.time), same(a.pbc, [False] * 3)


def lammps(path, document):
    import ase.io
    import MDAnalysis
    frames = list(nsd.frames(document))
    read = ase.io.read(path, index=":", format="lammps-dump-text")
    same(len(read), len(frames))
    for a, f in zip(read, frames):
        same(a.positions, f.position[np.argsort(f.id, kind="stable")])
    u = MDAnalysis.Universe(path, format="LAMMPSDUMP", topology_format="LAMMPSDUMP")
    same(len(u.trajectory), len(frames))
    x, mine = u.trajectory[-1].positions, frames[-1].x  # it begins at the box's corner
    assert abs((x - x[0]) - (mine - mine[0])).max() < 1e-8


def table(path, document, part, by):
    frames = [f for f in nsd.frames(document) if part == "grains" or f.contacts is not None]
    read = np.genfromtxt(path, delimiter=by.replace("\\t", "\t"), names=True)
    same(read["step"], np.concatenate([[f.step] * len(f.position if part == "grains" else f.contacts) for f in frames]))
    xyz_of = lambda name: np.stack([read[name + k] for k in ("_x", "_y", "_z")], 1)  # noqa: E731
    if part == "grains":
        same(np.stack([read[k] for k in "xyz"], 1), np.concatenate([f.position for f in frames]))
        same(xyz_of("velocity"), np.concatenate([f.velocity for f in frames]))
        return
    force = np.concatenate([f.contacts.force for f in frames])
    assert abs(xyz_of("force") - force).max() <= 1e-14 * abs(force).max()
    same(read["normal_force"], np.concatenate([f.contacts.normal_force for f in frames]))


def newton(document, folder):
    """m dv = (m g + all contact forces) dt over each step, for the forces that were exported."""
    frames = list(nsd.frames(document))
    worst = 0
    for k in range(1, len(frames)):
        old, new = frames[k - 1], frames[k]
        assert new.step == old.step + 1
        data = vtk_read(f"{folder}/grains-{k:05}.vtp")[2]
        left = new.mass[:, None] * (new.v - old.v) / new.dt
        right = new.mass[:, None] * new.gravity + data["contact_force"]
        assert data["contacts"].sum() > 10
        # a grain that goes on as another of its images has that one's velocity
        same_image = np.linalg.norm(new.x - old.x, axis=1) < 10 * new.radius
        assert same_image.mean() > 0.9
        worst = np.maximum(worst, abs(left - right)[same_image].max() / abs(data["contact_force"]).max())
        same(data["contacts"].sum(), sum((new.contacts.normal_force > 0) * (1 + (new.contacts.a >= 0))))
    assert worst < 1e-9, worst


def images(document, folder):
    across = 0
    for k, frame in enumerate(nsd.frames(document)):
        x, lines, _, data, _ = vtk_read(f"{folder}/contacts-{k:05}.vtp")
        assert len(lines) > 10
        ends = x[np.array(lines)]
        a, b = data["body"].T
        reach = frame.radius[a] + frame.radius[b]
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        assert len(a) and (abs(length - reach) < 0.05 * reach).all(), (length / reach)
        across += (np.linalg.norm(frame.position[b] - frame.position[a], axis=1) > 1.5 * reach).sum()
    assert across > 10  # by images


def edges(document):
    import h5py
    return h5py.File(document, "r")["particles/all/box/edges/value"][()]


def cell(document, folder):
    for k, edge in enumerate(edges(document)):
        x, lines, _, data, _ = vtk_read(f"{folder}/cell-{k:05}.vtp")
        assert len(lines) == 12
        ends = x[np.array(lines)]
        assert abs(ends[:, 1] - ends[:, 0] - edge[data["edge"]]).max() < 1e-15
        same(np.unique(np.round(x - x.min(0), 9), axis=0).shape, (8, 3))


def ase_cell(document, *files):
    import ase.io
    for name in files:
        kind = "extxyz" if name.endswith("xyz") else "lammps-dump-text"
        read = ase.io.read(name, index=":", format=kind)
        for a, edge in zip(read, edges(document)):
            same(a.pbc, [True, True, False])
            assert abs(a.cell[()] - edge).max() < 1e-15 and abs(edge[1, 0]) > 1e-4


def box(document):
    import MDAnalysis
    u = MDAnalysis.Universe.empty(len(nsd.last(document).position), trajectory=True)
    u.load_new(document, format="H5MD", convert_units=False)
    for ts, edge in zip(u.trajectory, edges(document)):
        length = np.linalg.norm(edge, axis=1)
        angle = [np.degrees(np.arccos(edge[i] @ edge[j] / length[i] / length[j])) for i, j in ((1, 2), (0, 2), (0, 1))]
        assert np.allclose(ts.dimensions, np.concatenate([length, angle]), rtol=1e-5), ts.dimensions


def forces(document):
    """/contacts/force is what nsd.py makes of reaction and frame."""
    import h5py
    kept = h5py.File(document, "r")["contacts/force"]
    assert kept.attrs["units"] in (b"N", "N")
    made = np.concatenate([f.contacts.force for f in nsd.frames(document)])
    assert kept.shape == made.shape and abs(kept[()] - made).max() <= 1e-14 * abs(made).max()


def mdanalysis(document):
    import h5py
    import MDAnalysis
    frames = list(nsd.frames(document))
    n = len(h5py.File(document, "r")["particles/all/id"])
    u = MDAnalysis.Universe.empty(n, trajectory=True)
    u.load_new(document, format="H5MD", convert_units=False)
    same(len(u.trajectory), len(frames))
    for ts, f in zip(u.trajectory, frames):
        same(ts.data["step"], f.step), same(ts.time, f.time)
        same(ts.positions, f.position.astype("f4"))


def readable(document):
    """Where grains come and go, numbers of those that are not there are NaN."""
    import h5py
    import MDAnalysis
    frames = list(nsd.frames(document))
    n = h5py.File(document, "r")["particles/all/position/value"].shape[1]
    u = MDAnalysis.Universe.empty(n, trajectory=True)
    u.load_new(document, format="H5MD", convert_units=False)
    for ts, f in zip(u.trajectory, frames):
        there = np.isfinite(ts.positions[:, 0])
        same(ts.positions[there], f.position.astype("f4"))


def looks_on(document):
    """h5py and nsd.py read a trajectory that grows: the frames that they see are whole, and more and more."""
    seen, failed = [], 0
    for _ in range(2000):
        try:
            frame = nsd.last(document)
            if frame and np.isfinite(frame.position).all() and (not seen or frame.step > seen[-1]):
                seen.append(frame.step)
        except (OSError, KeyError, nsd.Error):  # in the midst of a frame, or of the very first
            failed += 1
        if len(seen) > 3:
            return
        time.sleep(0.005)
    raise AssertionError((seen, failed))


def stream(document):
    """nsd.py reads documents back to back out of a pipe, the same frames."""
    with subprocess.Popen(["nsd-cat", document], stdout=subprocess.PIPE) as cat:
        pipe = subprocess.run(["cat"], stdin=cat.stdout, stdout=subprocess.PIPE, check=True).stdout
    import io
    few = list(nsd.frames(document))
    many = list(nsd.frames(io.BytesIO(pipe)))
    same(len(many), len(few))
    for a, b in zip(many, few):
        same(a.x, b.x), same(a.step, b.step), same(a.contacts.force, b.contacts.force)
        same(a.report["sweeps"], b.report["sweeps"])


def fclib(document):
    """W of nsd.py solves what nsd-solve has solved: u = W r + q, and u, r obey the law."""
    p = nsd.fclib(document)
    W = p.W.toarray() if hasattr(p.W, "toarray") else p.W
    same(W, W.T)
    u = W @ p.r + p.q
    assert abs(u - p.u).max() <= 1e-9 * abs(p.u).max()
    r = p.r.reshape(-1, p.dim)
    assert (r[:, 0] >= 0).all() and (np.linalg.norm(r[:, 1:], axis=1) <= p.mu * r[:, 0] * (1 + 1e-9)).all()


globals()[sys.argv[1]](*[int(a) if a.isdigit() else a for a in sys.argv[2:]])
