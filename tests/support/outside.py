"""outside.py FOLDER: what tests/tools/outside.t asks of the Python module; a line "ok ..." or "not ok ..." for each claim."""
import gc
import json
import os
import subprocess
import sys
import threading
import warnings

import numpy as np

import nsd
import nsd._library

folder = sys.argv[1]
heap = {"dt": 1e-4, "mu": 0.3, "seed": 4,
        "bodies": [{"count": 40, "radius": {"uniform": [4e-4, 5e-4]},
                    "box": {"x": [0, 5e-3], "y": [0, 5e-3], "z": [0, 4e-3]}}],
        "walls": [{"box": {"x": [0, 5e-3], "y": [0, 5e-3], "z": [0, None]}},
                  {"point": [0, 0, 6e-3], "normal": [0, 0, -1], "load": {"along": [0, 0, 1], "mass": 1e-4, "force": -0.02}}]}


def ok(good, text):
    print("ok" if good else "not ok", text, flush=True)


def raises(kind, words, call):
    try:
        call()
    except kind as e:
        return words in str(e)
    return False


def path(name):
    return os.path.join(folder, name)


def read(name):
    with open(path(name), "rb") as f:
        return f.read()


def tool(*words, **options):
    return subprocess.run(words, check=True, capture_output=True, **options).stdout


# ---- the same bytes as nsd-step ----

with open(path("scene.json"), "w") as f:
    json.dump(heap, f)
gen = tool("nsd-gen", path("scene.json"))
with open(path("begin.h5"), "wb") as f:
    f.write(gen)
for options in ({}, {"contacts": True}, {"forces": True, "eps": 1e-6, "criterion": "natural"}, {"dt": "auto:0.01"},
                {"method": "exact", "relax": 1.2, "overlap": "keep"}, {"threads": 2, "cold": True}):
    words = [w for key, x in options.items()
             for w in (["--" + key] if x is True else ["--" + key.replace("_", "-"), str(x)])]
    tool("nsd-step", "-n", "60", "--every", "20", *words, "-o", path("step.h5"), path("begin.h5"))
    line = tool("h5dump", "-d", "/nsd/history", "-o", path("history"), "-b", path("step.h5")) and read("history")
    line = line.split(b"\n")[1].decode()  # as nsd-step wrote it
    settings = dict(options)
    if settings.pop("cold", None):
        settings["warm"] = False
    if os.path.exists(path("mine.h5")):
        os.remove(path("mine.h5"))
    with nsd.Run.from_document(path("begin.h5")) as run:
        run.set(**settings)
        run.note(line)
        for step in run.steps(60):
            if step % 20 == 0:
                run.append(path("mine.h5"))
    ok(read("step.h5") == read("mine.h5"), f"a trajectory is that of nsd-step, byte for byte: {options}")
    run = nsd.Run.from_document(path("begin.h5")).set(**settings)
    run.note(line)
    run.step(60)
    run.save(path("last.h5"))
    again = nsd.Run.from_document(path("last.h5"))
    ok((again.position == run.position).all() and (again.velocity == run.velocity).all(),
       f"a document has the run: {options}")
    run.close(), again.close()

    with nsd.Run.from_document(path("mine.h5")) as again:
        ok(raises(nsd.Error, "has step 60 already, and the run is at step 60", lambda: again.append(path("mine.h5"))),
           "a trajectory that has the step is not gone on with")
        again.set(**settings)
        again.step(20)
        again.append(path("mine.h5"))
    ok([frame.step for frame in nsd.frames(path("mine.h5"))] == [20, 40, 60, 80], f"one that has not is: {options}")

with nsd.Run.from_document(path("last.h5")) as run:
    run.throw(3, angular_velocity=[0, 0, 2])
    run.throw(4, [0.1, 0, 0])
    ok((run.angular_velocity[3] == [0, 0, 2]).all() and (run.velocity[4] == [0.1, 0, 0]).all(), "bodies that are thrown")
    ok(raises(nsd.Error, "is not finite", lambda: run.throw(3, [0, np.nan, 0])), "not to nowhere")

# ---- forces that last ----

with nsd.Run.from_document(path("last.h5")) as run:
    run.set(warm=False)
    run.force[3] = [1e-4, 0, 2e-5]
    run.push_boundary(5, 1e-3)
    run.save(path("lasting.h5"))
    run.step()
    position = run.position.copy()
solved = tool("nsd-solve", input=tool("nsd-detect", path("lasting.h5")))
for name, words in {"nsd-step": ["nsd-step", "--cold", path("lasting.h5")], "detect, solve, move": ["nsd-move"]}.items():
    with open(path("tools.h5"), "wb") as f:
        f.write(tool(*words, input=solved))
    with nsd.Run.from_document(path("tools.h5")) as after:
        ok((after.position == position).all() and (after.force[3] == [1e-4, 0, 2e-5]).all(),
           f"{name} goes on with the forces that last in a document")

# ---- arrays ----

run = nsd.Run.from_scene(heap)
run.step(300)
x, z = run.position, run.position[:, 2].copy()
ok(not x.flags.writeable and x.base is not None and x.dtype == np.float64, "arrays of bodies are read-only views")
ok(raises(ValueError, "read-only", lambda: x.__setitem__((0, 0), 1.0)), "what is written into them raises")
run.step(30)
ok((x[:, 2] != z).any(), "they show what there is after a step")
w = run.mass.sum() * 9.81
ok(abs(-run.boundary_force[4, 2] / (w + 0.02) - 1) < 0.05, "the floor carries the grains and the load")
f = run.contact_force
total = np.zeros((len(run.id), 3))
a, b = run.contact_body.T
np.add.at(total, b, f)
np.add.at(total, a[a >= 0], -f[a >= 0])
dv = run.velocity.copy()
run.step()
ok(np.allclose(run.contact_normal @ np.zeros(3), 0) and np.allclose(np.linalg.norm(run.contact_normal, axis=1), 1),
   "normals are unit vectors")
ok(run.contact_gap.shape == (run.contacts,) and run.contact_body.shape == (run.contacts, 2), "arrays of contacts have their number")
del dv, total
run.close()
ok(np.isfinite(x).all() and repr(run) == "<nsd run, closed>", "arrays outlive the run")
del x
gc.collect()
for name, call in {"step": run.step, "position": lambda: run.position, "save": lambda: run.save(path("no.h5")),
                   "set": lambda: run.set(eps=1), "iteration": lambda: next(iter(run))}.items():
    ok(raises(ValueError, "closed", call), f"a run that is closed: {name}")

# ---- bad input leaves the run as it was ----

run, twin = nsd.Run.from_scene(heap), nsd.Run.from_scene(heap)
run.step(100), twin.step(100)
for kind, words, call in (
        (ValueError, "shape", lambda: run.push(0, [1, 2])),
        (ValueError, "broadcast", lambda: setattr(run, "force", np.zeros((3, 2)))),
        (nsd.Error, "not finite", lambda: run.push(0, [np.nan, 0, 0])),
        (nsd.Error, "no body 99", lambda: run.push(99, [0, 0, 1])),
        (nsd.Error, "no body 99", lambda: run.remove([1, 99])),
        (nsd.Error, "twice", lambda: run.remove([1, 1])),
        (ValueError, "shape", lambda: run.add(position=[[0, 0]], radius=[1], density=1)),
        (ValueError, "shape", lambda: run.add(position=[[0, 0, 0]], radius=[1, 2], density=1)),
        (nsd.Error, "density", lambda: run.add(position=[[0, 0, 0]], radius=[1e-3])),
        (nsd.Error, "radius", lambda: run.add(position=[[0, 0, 0]], radius=[-1], density=1)),
        (nsd.Error, "kind", lambda: run.add(position=[[0, 0, 0]], radius=[1e-3], density=1, kind=[9])),
        (nsd.Error, "no array", lambda: run.array("speed")),
        (nsd.Error, "no number", lambda: run.number("speed")),
        (nsd.Error, "measures", lambda: run.measure("beauty")),
        (nsd.Error, "no such option", lambda: run.set(epsilon=1)),
        (nsd.Error, "not load-controlled", lambda: run.push_boundary(0, 1)),
        (nsd.Error, "no boundary", lambda: run.move_boundary(17, [0, 0, 1])),
        (nsd.Error, "no kind", lambda: run.friction("ball", "cheese", 1)),
        (nsd.Error, "steps cannot", lambda: run.step(-1)),
        (nsd.Error, "", lambda: run.save("/nowhere/a.h5")),
        (nsd.Error, "", lambda: nsd.Run.from_document(gen[:1000])),
        (nsd.Error, "", lambda: nsd.Run.from_scene({"dt": -1}))):
    ok(raises(kind, words, call), f"{kind.__name__}: {words}")
run.force[3, 1] = np.inf
ok(raises(nsd.Error, "body 3 is not finite", run.step), "a force that is not finite is found as a step begins")
run.force = 0
run.step(20), twin.step(20)
ok((run.position == twin.position).all() and (run.velocity == twin.velocity).all(), "and the run goes on as its twin does")

# ---- steps that fail ----

def warned(n, scene):
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        run = nsd.Run.from_scene(scene)
        before = (run.converged, run.account, run.failure)
        for _ in range(n):
            run.step()
    return run, before, said


press = {"dt": 1e-3, "mu": 1, "bodies": [{"x": [0, 0, 0], "radius": 0.1, "mass": 1}],
         "walls": [{"point": [0, 0, -0.1], "normal": [0, 0, 1], "name": "floor"},
                   {"point": [0, 0, 0.1], "normal": [0, 0, -1], "velocity": [0, 0, -0.1]}]}
pressed, before, said = warned(3, press)
ok(before == (None, {}, "") and pressed.converged is False, "a run knows whether its last step has converged")
ok(pressed.account["unconverged"]["value"] == 3 and pressed.account["unconverged"]["bodies"][0] in ("floor", "wall 1"),
   "and its account, with the names of walls")
ok([(w.category, os.path.basename(w.filename)) for w in said] == [(nsd.FailedStep, "outside.py")]
   and "1 step not converged (step 1, wall" in str(said[0].message) and issubclass(nsd.FailedStep, UserWarning),
   "a step that fails warns once in a run, where the program steps")
ok("3 steps not converged (first step 1" in pressed.failure, "which the run can say at any time")
good, _, said = warned(3, {**press, "walls": press["walls"][:1]})
ok(not said and good.converged is True and good.failure == "", "steps that converge do not warn")
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    ok(nsd.Run.from_scene(press).measure("boundaries")["unconverged"] == 0
       and pressed.measure("boundaries")["unconverged"] == 3 and pressed.measure("boundaries")["unconverged"] == 0,
       "measures have the number of such steps since the last")

space = {"dt": 1e-3, "gravity": [0, 0, 0], "bodies": [{"x": [0, 0, 1], "radius": 1e-3}]}
for what, act in (("velocity", lambda r: r.push(0, [1e308, 0, 0])), ("angular velocity", lambda r: r.push(0, torque=[1e308, 0, 0])),
                  ("position", lambda r: (r.throw(0, [1e20, 0, 0]), r.set(dt=1e300))), ("energy", lambda r: r.throw(0, [1e160, 0, 0]))):
    fast = nsd.Run.from_scene(space)
    fast.step(2)
    act(fast)
    was = fast.position.copy(), fast.velocity.copy(), fast.angular_velocity.copy()
    ok(raises(nsd.Diverged, f"step 3: the {what} of body 0 would not be finite", fast.step)
       and all((x == y).all() for x, y in zip(was, (fast.position, fast.velocity, fast.angular_velocity))) and fast.step_number == 2,
       f"a step whose {what} is infinite fails and is undone")
    fast.save(path("undone.h5"))

# ---- bodies that come and go ----

x = run.position
ok(raises(BufferError, "in use", lambda: run.remove(3)), "bodies cannot go while an array is in use")
del x
gc.collect()
run.remove([3, 5])
ids = run.add(position=[[2.5e-3, 2.5e-3, 7e-3]], radius=[2e-4], density=2500)
ok(list(ids) == [40] and len(run.id) == 39 and 3 not in run.id, "bodies go and come, with numbers that nobody had")
run.step(5)
pour = nsd.Run.from_scene({"dt": 1e-3, "pour": [{"rate": 300, "radius": 0.1, "count": 5,
                           "opening": {"disc": {"center": [0, 0, 3], "normal": [0, 0, 1], "radius": 2}}}]})
pour.step(20)
x = pour.position
ok(len(x) == 5 and raises(BufferError, "in use", pour.step), "so it is where a scene pours")
del x

# ---- threads, and other programs' libhdf5 ----

def work(out):
    with nsd.Run.from_scene(heap) as run:
        for k in run.steps(100):
            run.force[:, 0] = 1e-6 * np.sin(k)
            if k % 50 == 0:
                run.save(path(f"{threading.get_ident()}.h5"))
        out.append(run.position.copy())


found = []
threads = [threading.Thread(target=work, args=(found,)) for _ in range(3)]
[t.start() for t in threads], [t.join() for t in threads]
ok(len(found) == 3 and all((x == found[0]).all() for x in found), "three runs in three threads are the same")
try:
    import h5py
except ImportError:
    h5py = None
if h5py:
    stop = threading.Event()

    def hdf5():
        while not stop.is_set():
            try:
                with h5py.File(path("h5py.h5"), "w") as f:
                    f["x"] = np.arange(1000)
            except BlockingIOError:  # for a moment the process that reads has it open, too
                continue

    busy = threading.Thread(target=hdf5)
    busy.start()
    for _ in range(30):
        nsd.Run.from_document(path("last.h5")).close()
    stop.set(), busy.join()
    ok(True, "documents are read while another thread uses libhdf5")
    frame = nsd.last(path("last.h5"))
    again = nsd.Run.from_document(path("last.h5"))
    ok((frame.x == again.position).all(), "frames by h5py have the same places")
names = []
while (name := nsd._library.library.nsd_array_name(len(names))) is not None:
    names.append(name.decode())
ok(len(names) > 20 and all(isinstance(vars(nsd.Run).get(name), property) and vars(nsd.Run)[name].__doc__ for name in names),
   "every array of the library is a property with a docstring")
ok(all(x.__doc__ for name, x in vars(nsd.Run).items() if not name.startswith("_")), "every member has a docstring")
ok(nsd.Run.from_scene(heap).set(contacts=True).measure("energy")["bodies"] == 40, "measures by their names")
