"""outside.py FOLDER: what tests/tools/outside.t asks of the Python module; a line "ok ..." or "not ok ..." for each claim."""
import gc
import json
import os
import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy as np

import nsd
import nsd._library

warnings.simplefilter("ignore", nsd.FailedStep)  # coarse runs of forty balls

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
for options in ({}, {"contacts": True}, {"forces": True, "tolerance": 1e-6, "criterion": "natural"},
                {"local": "exact", "relax": 1.2, "overlap_rule": "keep"}, {"small_steps": 0.01, "threads": 2}, {"threads": 2, "cold": True}):
    words = [w for key, x in options.items()
             for w in (["--" + key] if x is True else ["--" + key.replace("_", "-"), str(x)])]
    tool("nsd-step", "-n", "60", "--every", "20", *words, "-o", path("step.h5"), path("begin.h5"))
    line = tool("h5dump", "-d", "/nsd/history", "-o", path("history"), "-b", path("step.h5")) and read("history")
    line = line.split(b"\n")[1].decode()  # as nsd-step wrote it
    settings = dict(options)
    if settings.pop("cold", None):
        settings["warm"] = False
    if "contacts" in options or "forces" in options:
        settings["compare"] = True  # as nsd-step does in frames with contacts
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
    run.set_velocity(3, angular_velocity=[0, 0, 2])
    run.set_velocity(4, [0.1, 0, 0])
    ok((run.angular_velocity[3] == [0, 0, 2]).all() and (run.velocity[4] == [0.1, 0, 0]).all(), "bodies that are thrown")
    ok(raises(nsd.Error, "is not finite", lambda: run.set_velocity(3, [0, np.nan, 0])), "not to nowhere")

# ---- forces that last ----

with nsd.Run.from_document(path("last.h5")) as run:
    run.set(warm=False, small_steps=0)
    run.force[3] = [1e-4, 0, 2e-5]
    run.push_wall(5, 1e-3)
    run.save(path("lasting.h5"))
    run.step()
    position = run.position.copy()
solved = tool("nsd-solve", input=tool("nsd-detect", path("lasting.h5")))
for name, words in {"nsd-step": ["nsd-step", "--small-steps", "0", "--cold", path("lasting.h5")], "detect, solve, move": ["nsd-move"]}.items():
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
ok(abs(-run.wall_force[4, 2] / (w + 0.02) - 1) < 0.05, "the floor carries the grains and the load")
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
                   "set": lambda: run.set(tolerance=1), "iteration": lambda: next(iter(run))}.items():
    ok(raises(ValueError, "closed", call), f"a run that is closed: {name}")

# ---- bad input leaves the run as it was ----

run, twin = nsd.Run.from_scene(heap), nsd.Run.from_scene(heap)
run.step(100), twin.step(100)
for kind, words, call in (
        (ValueError, "shape", lambda: run.apply_force(0, [1, 2])),
        (ValueError, "broadcast", lambda: setattr(run, "force", np.zeros((3, 2)))),
        (nsd.Error, "not finite", lambda: run.apply_force(0, [np.nan, 0, 0])),
        (nsd.Error, "no body 99", lambda: run.apply_force(99, [0, 0, 1])),
        (nsd.Error, "no body 99", lambda: run.remove([1, 99])),
        (nsd.Error, "twice", lambda: run.remove([1, 1])),
        (ValueError, "shape", lambda: run.add(position=[[0, 0]], radius=[1], density=1)),
        (ValueError, "shape", lambda: run.add(position=[[0, 0, 0]], radius=[1, 2], density=1)),
        (nsd.Error, "density", lambda: run.add(position=[[0, 0, 0]], radius=[1e-3])),
        (nsd.Error, "radius", lambda: run.add(position=[[0, 0, 0]], radius=[-1], density=1)),
        (nsd.Error, "material", lambda: run.add(position=[[0, 0, 0]], radius=[1e-3], density=1, material=[9])),
        (nsd.Error, "no array", lambda: run.array("speed")),
        (nsd.Error, "no number", lambda: run.number("speed")),
        (nsd.Error, "measures", lambda: run.measure("beauty")),
        (nsd.Error, "no such option", lambda: run.set(epsilon=1)),
        (nsd.Error, "did you mean criterion?", lambda: run.set(critereon="natural")),
        (nsd.Error, "global: now called solver", lambda: run.set(**{"global": "auto"})),
        (nsd.Error, "overlap: now called overlap-rule", lambda: run.set(overlap="keep")),
        (nsd.Error, "did you mean pixels?", lambda: run.set(pixel=3)),
        (nsd.Error, "not load-controlled", lambda: run.push_wall(0, 1)),
        (nsd.Error, "no wall", lambda: run.move_wall(17, [0, 0, 1])),
        (nsd.Error, "no material", lambda: run.friction("ball", "cheese", 1)),
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
        run = nsd.Run.from_scene(scene).set(small_steps=0)
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
for what, act in (("energy", lambda r: r.apply_force(0, [1e308, 0, 0])), ("angular velocity", lambda r: r.apply_force(0, torque=[1e308, 0, 0])),
                  ("position", lambda r: (r.set_velocity(0, [1e20, 0, 0]), r.set(dt=1e300))), ("energy", lambda r: r.set_velocity(0, [1e160, 0, 0]))):
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
    ok((frame.x == frame.position).all() and (frame.q == frame.orientation).all(), "by their names of version 1, too")
    ok((frame.position == again.position).all(), "frames have the same places")
names = []
while (name := nsd._library.library.nsd_array_name(len(names))) is not None:
    names.append(name.decode())
ok(len(names) > 20 and all(isinstance(vars(nsd.Run).get(name), property) and vars(nsd.Run)[name].__doc__ for name in names),
   "every array of the library is a property with a docstring")
ok(all(x.__doc__ for name, x in vars(nsd.Run).items() if not name.startswith("_")), "every member has a docstring")
ok(nsd.Run.from_scene(heap).set(contacts=True).measure("energy")["bodies"] == 40, "measures by their names")

# ---- arguments that are no numbers, texts or paths ----

run = nsd.Run.from_scene(heap)
before = run.position.copy(), run.force.copy()
a_ball = dict(position=[[2.5e-3, 2.5e-3, 7e-3]], radius=[2e-4], density=2500)
for name, call in {
        "n": lambda x: run.step(x), "ids": lambda x: run.remove(x), "id": lambda x: run.apply_force(x, [0, 0, 1]),
        "wall": lambda x: run.move_wall(x, [0, 0, 1]), "material": lambda x: run.add(**a_ball, material=[x])}.items():
    for x in 1.5, float("nan"), float("inf"), True, None, "1", 1 << 70, -1 << 70, 1 + 2j, b"1":
        if name == "boundary" and x == "1":
            continue  # a name
        ok(raises((TypeError, ValueError), name, lambda: call(x)), f"{name}: {x!r} is refused by name")
for name, call in {"time": run.until, "force": lambda x: run.push_wall(5, x), "mu": lambda x: run.friction("ball", "wall", x),
                   "density": lambda x: run.add(position=[[0, 0, 1]], radius=[1e-4], density=x)}.items():
    for x in True, "1", b"1", [1], 1j:
        ok(raises((TypeError, ValueError), name, lambda: call(x)), f"{name}: {x!r} is refused by name")
for name, call in {"force": lambda x: run.apply_force(0, x), "velocity": lambda x: run.set_velocity(0, x), "torque": lambda x: setattr(run, "torque", x),
                   "g": run.gravity, "radius": lambda x: run.add(position=[[0, 0, 1]] * 3, radius=x, density=1)}.items():
    for x in ["1", "2", "3"], [True, False, True], [1j, 0, 0], [None, 0, 0], [10 ** 400, 0, 0]:
        ok(raises((TypeError, ValueError), name, lambda: call(x)), f"{name}: {x!r:.40} is refused by name")
for name, call in {"path": run.save, "document": nsd.Run.from_document, "scene": nsd.Run.from_scene, "name": run.array,
                   "names": run.measure, "material": lambda x: run.friction(x, "wall", 1), "line": run.note, "source": nsd.last,
                   "tolerance": lambda x: run.set(tolerance=x)}.items():
    ok(raises(ValueError, f"{name}: ", lambda: call("a\0b")), f"{name}: a zero byte is refused by name")
    ok(raises(TypeError, f"{name}: ", lambda: call(3j)), f"{name}: so is what is no text")
ok((run.position == before[0]).all() and (run.force == before[1]).all() and run.step_number == 0 and len(run.id) == 40,
   "and the run is what it was")
run.step(np.int64(2)), run.step(1.0), run.apply_force(np.int32(3), [0, 0, 1]), run.remove(np.array([3, 4])), run.remove(5)
ok(run.step_number == 3 and len(run.id) == 37, "whole numbers of any type are taken")
run.close()

# ---- the periodic cell ----

sheared = {"dt": 1e-3, "gravity": [0, 0, 0], "cell": {"lengths": [2, 3, 4], "gradient": [[0, 0.5, 0], [0, 0, 0], [0, 0, 0]]},
           "bodies": [{"x": [0.5, 0.5, 0.5], "radius": 0.1}]}
run = nsd.Run.from_scene(sheared)
run.step(100)
run.save(path("cell.h5"))
want = np.array([[2, 0, 0], [0.5 * 3 * 0.1, 3, 0], [0, 0, 4]])
for name, cell in {"run": run.cell, "frame": nsd.last(path("cell.h5")).cell}.items():
    ok(np.allclose(cell.edges, want, rtol=1e-12) and np.allclose(cell.rates, [[0] * 3, [1.5, 0, 0], [0] * 3], rtol=1e-12) and
       list(cell.periodic) == [True] * 3 and cell.origin.shape == (3,), f"the cell of a {name}: edges of simple shear, L t")
ok(nsd.Run.from_scene(heap).cell is None and nsd.last(path("last.h5")).cell is None, "None where nothing is periodic")

# ---- a step that fails ----

run, twin = nsd.Run.from_scene(heap), nsd.Run.from_scene(heap)
run.step(20), twin.step(20)
run.apply_force(3, [1e308, 0, 0], once=True)
ok(raises(nsd.Diverged, "step 21: ", lambda: run.step(5)), "a step whose result is not finite fails, by its number")
run.apply_force(3, once=True)
run.save(path("a.h5")), twin.save(path("b.h5"))
ok(read("a.h5") == read("b.h5"), "and the run, and its document, is what it was")

# ---- threads with one run ----

run = nsd.Run.from_scene(heap)
run.step()
sys.setswitchinterval(1e-6)
stop, wrong = time.time() + 2, []


def again(look):
    while time.time() < stop:
        try:
            assert look()
        except Exception as e:
            wrong.append(repr(e))


def sees_contacts():
    body = run.contact_body
    return not len(body) or (body.max() < 40 and body.min() >= -6)


looks = [lambda: "kinds" in run.names, lambda: "bodies" in run.measure("sizes"), sees_contacts, sees_contacts,
         lambda: run.step() is None, lambda: run.cell is None]
threads = [threading.Thread(target=again, args=(look,)) for look in looks]
[t.start() for t in threads], [t.join() for t in threads]
sys.setswitchinterval(0.005)
ok(not wrong, f"threads that share a run get whole answers {wrong[:1]}")

# ---- Ctrl-C ----


def interrupted(call, after=0.3):
    """s: how long it takes from Ctrl-C to KeyboardInterrupt; None: there was none. One that comes in a __del__() is lost in
    Python: after 3 s another is sent."""
    sent, done, hook = [], threading.Event(), sys.unraisablehook
    sys.unraisablehook = lambda lost: None if lost.exc_type is KeyboardInterrupt else hook(lost)

    def send():
        while not done.wait(3 if sent else after):
            sent.append(time.time())
            os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=send).start()
    try:
        call()
    except KeyboardInterrupt:
        done.set()
        return time.time() - sent[-1]
    finally:
        done.set()
        sys.unraisablehook = hook
    return None


signal.signal(signal.SIGINT, signal.default_int_handler)
run = nsd.Run.from_scene({"dt": 1e-3, "bodies": [{"x": [0, 0, 1], "radius": 0.1}]})
for name, call in {"step": lambda: run.step(10 ** 9), "until": lambda: run.until(1e9),
                   "a step after a quick one": lambda: (run.step(), run.step(10 ** 9))}.items():
    late = interrupted(call)
    ok(late is not None and late < 1, f"{name}: KeyboardInterrupt at once")
    made = run.step_number
    time.sleep(0.1)
    ok(made and run.step_number == made, f"{name}: and the run is at rest")
    run.step()
    ok(run.step_number == made + 1, f"{name}: and can be used")
late = interrupted(lambda: [f for _ in iter(int, 1) for f in nsd.frames(path("mine.h5"))])
ok(late is not None and late < 1, "frames, too")
read_end, write_end = os.pipe()
late = interrupted(lambda: nsd.Run.from_document(f"/proc/self/fd/{read_end}"))
ok(late is not None and late < 1, "and a document that does not come")
os.close(write_end), os.close(read_end)
run.close()

# ---- fork() ----

import multiprocessing
run = nsd.Run.from_scene(heap)
run.step(5)
run.append(path("forked.h5"))
frame = nsd.last(path("last.h5"))


def child(k):
    try:
        run.append(path("forked.h5"))
        return "it appends"
    except nsd.Error as e:
        if "copy by fork()" not in str(e):
            return str(e)
    with nsd.Run.from_scene(heap) as own:
        own.step(5 + k)
        own.save(path(f"own{k}.h5"))
        same = (own.position == nsd.last(path(f"own{k}.h5")).position).all()
        return float(frame.position.sum()) if same else "other places"


with multiprocessing.get_context("fork").Pool(3) as pool:
    got = pool.map(child, range(6))
    run.step(5)
    run.append(path("forked.h5"))
    run.finish()
    ok(got == [float(frame.position.sum())] * 6, f"multiprocessing: children are refused the run, read documents and make their own {got[:1]}")
    ok([f.step for f in nsd.frames(path("forked.h5"))] == [5, 10], "and the trajectory is the parent's")
    run.step(5)
    run.append(path("forked.h5"))
    run.close()
    ok([f.step for f in nsd.frames(path("forked.h5"))] == [5, 10, 15], "which goes on while the children live")
