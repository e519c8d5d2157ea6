"""Runs of nsd, stepped by a program."""
from __future__ import annotations

import contextlib
import ctypes
import itertools
import json
import math
import os
import sys
import threading
import time
import warnings
import weakref
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arguments as check
from ._library import Array, Bodies, Diverged, Error, Pace, RUN, VECTOR, fail, library

__all__ = ["Cell", "Diverged", "Error", "FailedStep", "Run"]

Path = Union[str, "os.PathLike[str]"]

_ONCE, _LASTING = 0, 1
_DTYPES = {b"d": np.float64, b"i": np.int32, b"b": np.int8}
_CHUNK = 0.03  # s: steps that are made in one call of the library, before signals are looked at


class FailedStep(UserWarning):
    """A step of a run failed its account [nsd-step(1)]: it has not converged, bodies overlap, or one went through another."""


class Cell(NamedTuple):
    """The periodic cell: a body at x exists at x + edges[k] as well, with its velocity plus rates[k], for each k with periodic[k]."""

    origin: NDArray[np.float64]  # [3] m: the corner from which the edges start
    edges: NDArray[np.float64]  # [3, 3] m: one edge per row
    rates: NDArray[np.float64]  # [3, 3] m/s: their velocities
    periodic: NDArray[np.bool_]  # [3]


class _Handle:
    """The run of the library, freed when neither Run nor arrays need it."""

    def __init__(self, pointer: int | None):
        self.pointer = RUN(pointer)
        self.maker = os.getpid()
        self._lock = threading.RLock()
        self.views: weakref.WeakSet[_Owner] = weakref.WeakSet()

    @property
    def lock(self) -> Any:
        """Keeps other threads out. In a child of fork() one of the parent's threads may hold it for ever; there the library refuses
        each call."""
        return self._lock if self.maker == os.getpid() else contextlib.nullcontext()

    def call(self, name: str, *arguments: Any) -> None:
        """A function of the library with the run; the arguments stay referenced until it returns."""
        with self.lock:
            status = getattr(library, name)(self.pointer, *arguments)
            text = library.nsd_error(self.pointer) if status else b""
        if status:
            fail(status, text)

    def unused(self) -> None:
        """Before bodies are added or removed, under the lock: no array may be in use."""
        if len(self.views):
            raise BufferError("arrays of this run are in use while bodies are added or removed: keep copies instead (x.copy(), del x)")

    def array(self, name: bytes) -> NDArray[Any]:
        """A view of an array of bodies, a copy of any other, made while the lock is held"""
        described = Array(ctypes.sizeof(Array))
        with self.lock:
            self.call("nsd_read", name, ctypes.byref(described))
            owner = _Owner(self, described)
            if 0 in described.shape[:described.rank]:
                return np.zeros(tuple(described.shape[:described.rank]), _DTYPES[described.type])
            view = np.asarray(owner)
            if name.startswith((b"contact_", b"wall_", b"cell_")):
                return view.copy()
            self.views.add(owner)
        return view

    def text(self, name: str, *arguments: Any) -> Any:
        """JSON that a function returns, taken over while the lock is held"""
        text = ctypes.c_char_p()
        with self.lock:
            self.call(name, *arguments, ctypes.byref(text))
            words = text.value or b"null"
        return json.loads(words)

    def number(self, name: bytes) -> float:
        x = ctypes.c_double()
        self.call("nsd_number", name, ctypes.byref(x))
        return x.value

    def advance(self, some: Callable[[int], bool], stopped: Callable[[], bool]) -> None:
        """Calls some(k), which makes up to k steps and returns whether more are to be made, with k so that a call takes some 30 ms."""
        k, more = 1, True
        with self.lock:
            if library.nsd_resizes(self.pointer):
                self.unused()
            while more and not stopped():
                begun = time.perf_counter()
                more = some(k)
                took = time.perf_counter() - begun
                k = min(2 * k, 1 << 20) if took < _CHUNK / 2 else max(k // 2, 1) if took > _CHUNK else k

    def __del__(self, close: Any = library.nsd_close, byref: Any = ctypes.byref) -> None:
        close(byref(self.pointer))  # names of the module may be gone by now


class _Owner:
    """What numpy keeps alive with an array of the library."""

    def __init__(self, handle: _Handle, array: Array):
        self._handle = handle
        dtype = np.dtype(_DTYPES[array.type])
        rank = array.rank
        self.__array_interface__ = {
            "version": 3, "typestr": dtype.str, "shape": tuple(array.shape[:rank]),
            "strides": tuple(array.stride[:rank]), "data": (array.data or 0, array.writable == b"\0"),
        }


def _vector(x: ArrayLike | None, name: str) -> Any:
    return None if x is None else check.vector(x, name).ctypes.data_as(VECTOR)  # which keeps the array


_WIDTHS = {"position": 3, "orientation": 4, "velocity": 3, "angular_velocity": 3,
           "radius": 1, "mass": 1, "inertia": 1, "material": 1}


def _bodies(columns: Mapping[str, ArrayLike | None], density: float | None) -> tuple[Bodies, list]:
    """The struct, and the arrays that it points into"""
    bodies, kept = Bodies(ctypes.sizeof(Bodies)), []
    n = None
    for name, x in columns.items():
        if x is None:
            continue
        width = _WIDTHS[name]
        a = (check.integers if name == "material" else check.numbers)(x, name)
        n = len(a) if n is None and a.ndim else n
        shape = (n,) if width == 1 else (n, width)
        if a.shape != shape:
            raise ValueError(f"{name} is of shape {a.shape}, not {shape}")
        kept.append(a)
        setattr(bodies, name, a.ctypes.data)
    bodies.n, bodies.density = n or 0, 0.0 if density is None else check.real(density, "density")
    return bodies, kept


class Run:
    """A run: bodies and walls, stepped by this program. SI units throughout.

        with nsd.Run.from_scene("scene.json") as run:
            run.set(tolerance=1e-6)
            for _ in run.steps(until=0.5):
                run.force[:, 2] = -6e-3 * run.velocity[:, 2]    # N, until it is changed
            run.save("out.h5")

    Arrays of bodies (`position`, `force` ...) are views of the run's own memory: they show the state after each step,
    and keep that memory alive, also after close(). While any of them is in use bodies cannot be added or removed
    (BufferError); `.copy()` makes an independent array. Arrays of contacts, walls and the cell are copies, of the last step.

    Threads may share a run: a call waits until that of another thread has ended, and what it returns is a copy, except the arrays of
    bodies, which change while another thread makes steps. After fork() a run belongs to the parent: in the child its calls
    raise Error.

    Arguments that are no numbers of their kind (True, "1", 1.5 for an id) raise TypeError or ValueError, with the name of the
    argument.
    """

    # Properties, which are made from tables below
    position: NDArray[np.float64]
    orientation: NDArray[np.float64]
    velocity: NDArray[np.float64]
    angular_velocity: NDArray[np.float64]
    radius: NDArray[np.float64]
    mass: NDArray[np.float64]
    inertia: NDArray[np.float64]
    id: NDArray[np.int32]
    material: NDArray[np.int32]
    shape: NDArray[np.int32]
    group: NDArray[np.int32]
    image: NDArray[np.int32]
    force: Any  # NDArray[np.float64], to which anything like an array may be assigned
    torque: Any
    force_once: Any
    torque_once: Any
    contact_body: NDArray[np.int32]
    contact_point: NDArray[np.float64]
    contact_normal: NDArray[np.float64]
    contact_gap: NDArray[np.float64]
    contact_friction: NDArray[np.float64]
    contact_force: NDArray[np.float64]
    contact_velocity: NDArray[np.float64]
    contact_status: NDArray[np.int8]
    wall_position: NDArray[np.float64]
    wall_normal: NDArray[np.float64]
    wall_velocity: NDArray[np.float64]
    wall_angular_velocity: NDArray[np.float64]
    wall_force: NDArray[np.float64]
    wall_torque: NDArray[np.float64]
    cell_origin: NDArray[np.float64]
    cell_edges: NDArray[np.float64]
    cell_rates: NDArray[np.float64]
    cell_periodic: NDArray[np.int8]
    time: float
    dt: float
    step_number: int
    dim: int
    contacts: int

    def __init__(self, handle: _Handle):
        self._closed: _Handle | None = handle
        self._paces: dict[str, Pace] = {}
        self._warned = False

    # ---- made, and closed ----

    @staticmethod
    def _make(name: str, *arguments: Any) -> "Run":
        def make(_: Any) -> "Run":  # the reason is that of the thread
            pointer = RUN()
            status = getattr(library, name)(ctypes.byref(pointer), *arguments)
            if status:
                fail(status, library.nsd_error(None))
            return Run(_Handle(pointer.value))
        return Pace().make(make)

    @classmethod
    def from_scene(cls, scene: Path | Mapping[str, Any], folder: Path | None = None) -> "Run":
        """A run from a scene [nsd-scene(5)]: a dict, its JSON, or the path of a file. File names in it are relative to folder, or to the file.

        Raises Error: the scene is invalid (status 65), or there is no such file (66)."""
        if isinstance(scene, Mapping):
            scene = json.dumps(scene)
        if isinstance(scene, str) and scene.lstrip().startswith("{"):
            return cls._make("nsd_from_scene", check.text(scene, "scene"), None if folder is None else check.path(folder, "folder"))
        return cls._make("nsd_from_scene_file", check.path(scene, "scene"))

    @classmethod
    def from_document(cls, document: Path | bytes) -> "Run":
        """A run from the last frame of a document [nsd-format(5)]: the path of a file, or its bytes.

        Raises Error: the document is damaged or of no packing (status 65), or there is no such file (66)."""
        if isinstance(document, (bytes, bytearray, memoryview)):
            document = bytes(document)
            return cls._make("nsd_from_memory", document, len(document))
        return cls._make("nsd_from_document", check.path(document, "document"))

    @classmethod
    def from_arrays(cls, scene: Path | Mapping[str, Any], *, position: ArrayLike, radius: ArrayLike,
                    orientation: ArrayLike | None = None, velocity: ArrayLike | None = None,
                    angular_velocity: ArrayLike | None = None, mass: ArrayLike | None = None,
                    inertia: ArrayLike | None = None, material: ArrayLike | None = None,
                    density: float | None = None, folder: Path | None = None) -> "Run":
        """A run from a scene without bodies, to which these are added: see add()."""
        run = cls.from_scene(scene, folder)
        if run.number("bodies"):
            raise ValueError("the scene has bodies of its own: arrays are for one without")
        run.add(position=position, radius=radius, orientation=orientation, velocity=velocity,
                angular_velocity=angular_velocity, mass=mass, inertia=inertia, material=material, density=density)
        return run

    @property
    def _handle(self) -> _Handle:
        if self._closed is None:
            raise ValueError("the run is closed")
        return self._closed

    def close(self) -> None:
        """Ends a trajectory begun by append(), and the run. Arrays that are in use stay valid. In a child of fork() it leaves the
        parent's trajectory as it is."""
        handle = self._closed
        if handle is None:
            return
        if handle.maker == os.getpid():
            try:
                self.finish()
            except KeyboardInterrupt:
                raise  # it may be closed again
            except BaseException:
                self._closed = None
                raise
        self._closed = None

    def __enter__(self) -> "Run":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        handle = self._closed
        if handle is None:
            return "<nsd run, closed>"
        if handle.maker != os.getpid():
            return f"<nsd run of process {handle.maker}>"
        return f"<nsd run at step {self.step_number}, {self.time:g} s: {self.number('bodies'):.0f} bodies>"

    def _call(self, name: str, *arguments: Any) -> None:
        self._handle.call(name, *arguments)

    def _long(self, kind: str, call: Callable[[_Handle, Callable[[], bool]], Any]) -> Any:
        """call(handle, stopped), which may take long; kind: of which the last one took about as long"""
        handle = self._handle
        return self._paces.setdefault(kind, Pace()).make(lambda stopped: call(handle, stopped))

    def _writes(self, name: str, *arguments: Any) -> None:
        """The same with a function that writes, which the disk may hold up at any time"""
        handle = self._handle
        Pace().make(lambda stopped: None if stopped() else handle.call(name, *arguments))

    # ---- options and steps ----

    def set(self, **options: Any) -> "Run":
        """Sets options of nsd-step(1) and nsd-stat(1) by their names, with _ instead of -: tolerance=1e-6, local="exact", dt=1e-4 (s), threads=2,
        small_steps=0.01, contacts=True ...; returns the run. Raises Error (status 64) if there is no such option or value; those before it are set."""
        for name, value in options.items():
            if not isinstance(value, (bool, np.bool_, int, float, np.number, str)):
                raise TypeError(f"{name}: an option is a number, a text, True or False, not {type(value).__name__}")
            text = str(value).lower() if isinstance(value, (bool, np.bool_)) else str(value)
            self._call("nsd_set", check.text(name.replace("_", "-"), "option"), check.text(text, name))
        self._paces.clear()
        return self

    def step(self, n: int = 1) -> None:
        """Makes n steps. Raises Error, or Diverged, if a step fails, which the message names: that step is not made, the steps before
        it are. Ctrl-C raises KeyboardInterrupt at once; the run ends the step in hand, and can be used after it."""
        left = check.whole(n, "n", check.INT64)

        def make(handle: _Handle, stopped: Callable[[], bool]) -> None:
            def some(k: int) -> bool:
                nonlocal left
                k = min(k, left)
                handle.call("nsd_step", k)
                left -= k
                return left > 0
            handle.advance(some, stopped)
        try:
            self._long("step", make)
        finally:
            self._warn()

    def until(self, time: float) -> None:
        """Makes steps until this time (s); otherwise as step()."""
        t = check.real(time, "time")

        def make(handle: _Handle, stopped: Callable[[], bool]) -> None:
            def some(k: int) -> bool:
                now, dt = handle.number(b"time"), handle.number(b"dt")
                far = now + k * dt < t and (t - now) / dt < 1e15  # beyond, and for what is no number, the library has the words
                handle.call("nsd_until", now + k * dt if far and math.isfinite(t) else t)
                return far and math.isfinite(t)
            handle.advance(some, stopped)
        try:
            self._long("step", make)
        finally:
            self._warn()

    def steps(self, n: int | None = None, until: float | None = None) -> Iterator[int]:
        """Makes n steps, or steps until a time (s), or without either without end; yields the number of each after it was made."""
        most = None if n is None else check.whole(n, "n", check.INT64)
        end = None if until is None else check.real(until, "until")
        if end is not None and math.isnan(end):
            raise ValueError("until: nan is no time")
        return self._steps(most, end)

    def _steps(self, n: int | None, until: float | None) -> Iterator[int]:
        made = 0
        while (n is None or made < n) and (until is None or self.time < until - 1e-6 * self.dt):
            self.step()
            made += 1
            yield self.step_number

    def __iter__(self) -> Iterator[int]:
        return self.steps()

    def _warn(self) -> None:
        """Warns once in a run, when a step has failed; the run continues."""
        if self._warned or self._closed is None or self._closed.maker != os.getpid() or not (failure := self.failure):
            return
        self._warned = True
        level, frame = 2, sys._getframe(1)
        while frame.f_back and frame.f_code.co_filename == __file__:  # to the line of the program
            level, frame = level + 1, frame.f_back
        warnings.warn(f"a step of the run failed, and the run continues: {failure}", FailedStep, stacklevel=level)

    @property
    def failure(self) -> str:
        """Which steps of this run failed their account, in words: "2 steps not converged (first step 7, ...)"; "": none."""
        text = ctypes.c_char_p()
        with self._handle.lock:
            self._call("nsd_failure", ctypes.byref(text))
            return (text.value or b"").decode(errors="replace")

    @property
    def converged(self) -> bool | None:
        """Has the last step converged? None: no step was made."""
        known = self.number("converged")
        return None if known != known else bool(known)

    @property
    def account(self) -> dict[str, Any]:
        """The account of all steps, as that of nsd-info(1); {}: no step was made."""
        return {} if self.converged is None else self.report["account"]

    # ---- reading ----

    def array(self, name: str) -> NDArray[Any]:
        """An array by its name in nsd(3): "position", "contact_force" ... Those of bodies are views, all others copies."""
        return self._handle.array(check.text(name, "name"))

    def number(self, name: str) -> float:
        """A number by its name in nsd(3), in SI units: "time", "contacts", "natural" ...; nan: not defined yet."""
        return self._handle.number(check.text(name, "name"))

    @property
    def cell(self) -> Cell | None:
        """The periodic cell: origin [3] m, edges [3, 3] m, rates [3, 3] m/s, periodic [3]; None: no direction is periodic."""
        with self._handle.lock:
            origin, edges, rates, periodic = (self.array("cell_" + name) for name in Cell._fields)
        return Cell(origin, edges, rates, periodic.astype(bool)) if len(edges) else None

    @property
    def report(self) -> dict[str, Any]:
        """The report of the last solve, with the keys of nsd-info(1). Raises Error (status 64) before the first step."""
        return self._handle.text("nsd_report")

    @property
    def names(self) -> dict[str, Any]:
        """{"materials": [...], "shapes": [...], "walls": [name or None, ...], "groups": [...], "named": {name: [wall, ...]}}: walls are in their
        order; named: the walls that have a name, or a part that has it."""
        names = self._handle.text("nsd_names")
        return {**names, "kinds": names["materials"]}  # "kinds": of version 1

    def walls(self, name: int | str) -> list[int]:
        """The numbers of the walls that have this name, or of which a part has it, in order; a number stands for that wall.
        Raises KeyError, which is a ValueError too."""
        return _walls(name, int(self.number("walls")), self.names["named"])

    def _whole_walls(self, wall: int | str) -> list[int]:
        """Those that something is done to: a part cannot move without its wall"""
        if not isinstance(wall, str):
            return [check.whole(wall, "wall")]
        names = self.names
        found = [k for k, own in enumerate(names["walls"]) if own == wall]
        if not found and wall in names["named"]:
            raise ValueError(f"'{wall}' is a part of wall {names['named'][wall][0]}, which moves as a whole: use its number")
        return found or self.walls(wall)

    def measure(self, *names: str) -> dict[str, Any]:
        """Measures of nsd-stat(1), in SI units: one line of that program as a dict, with the keys "step", "time" (s), "bodies",
        "contacts" and the name of each measure.

        run.measure("stress")["stress"]["pressure"] is in Pa; nsd-stat(1) has the names, their numbers and units, and set() takes
        its options. "all" stands for all of them. Raises Error (status 64) if there is no measure of a name."""
        wanted = check.text(",".join(_texts(names, "names")), "names")
        return self._long("measure " + wanted.decode(), lambda handle, stopped: None if stopped() else handle.text("nsd_measure", wanted))

    # ---- acting ----

    def apply_force(self, id: int, force: ArrayLike | None = None, torque: ArrayLike | None = None, *,
                    once: bool = False) -> None:
        """Applies a force [3] (N) and a torque [3] (N m), in the axes of space, to the body with this id, in the next step only or
        until they are changed; None: zero. Raises Error (status 65) if there is no such body."""
        self._call("nsd_force", check.whole(id, "id"), _vector(force, "force"), _vector(torque, "torque"),
                   _ONCE if once else _LASTING)

    def push_wall(self, wall: int | str, force: float, *, once: bool = False) -> None:
        """Adds a force (N) along the axis of the wall's load, or a torque (N m) about it, to the load. A name stands for each
        wall that has it. Raises Error (status 65) if the wall has no load."""
        force = check.real(force, "force")
        for number in self._whole_walls(wall):
            self._call("nsd_wall_force", number, force, _ONCE if once else _LASTING)

    def move_wall(self, wall: int | str, velocity: ArrayLike) -> None:
        """Prescribes the wall's velocity [3] (m/s) from now on; a name stands for each wall that has it. Raises Error
        (status 65) if there is no such wall, or if it rotates."""
        vector = _vector(velocity, "velocity")
        for number in self._whole_walls(wall):
            self._call("nsd_wall_velocity", number, vector)

    def set_velocity(self, id: int, velocity: ArrayLike | None = None, angular_velocity: ArrayLike | None = None) -> None:
        """Gives the body with this id a velocity [3] (m/s) and an angular velocity [3] (rad/s), in the axes of space; None: unchanged."""
        self._call("nsd_velocity", check.whole(id, "id"), _vector(velocity, "velocity"),
                   _vector(angular_velocity, "angular_velocity"))

    # names of version 1, for programs that have them
    push, throw, push_boundary, move_boundary = apply_force, set_velocity, push_wall, move_wall

    def gravity(self, g: ArrayLike) -> None:
        """Sets gravity, [3] m/s^2."""
        self._call("nsd_gravity", _vector(g, "g"))

    def friction(self, material: str, other: str, mu: float) -> None:
        """Sets the coefficient of friction, at least 0, between two materials, by their names."""
        self._call("nsd_friction", check.text(material, "material"), check.text(other, "other"), check.real(mu, "mu"))

    def add(self, *, position: ArrayLike, radius: ArrayLike, orientation: ArrayLike | None = None,
            velocity: ArrayLike | None = None, angular_velocity: ArrayLike | None = None,
            mass: ArrayLike | None = None, inertia: ArrayLike | None = None,
            material: ArrayLike | None = None, density: float | None = None) -> NDArray[np.int32]:
        """Adds n balls, in 2D discs; returns their ids [n].

        position [n, 3] m, radius [n] m, orientation [n, 4] unit quaternions (w, x, y, z), velocity [n, 3] m/s,
        angular_velocity [n, 3] rad/s, mass [n] kg (0: fixed) or one density (kg/m^3, in 2D kg/m^2), inertia [n]
        kg m^2 [that of solid balls], material [n] number of the material [0].

        Raises BufferError while an array of bodies is in use, Error (status 65) if a number is out of range.
        """
        columns = {"position": position, "radius": radius, "orientation": orientation, "velocity": velocity,
                   "angular_velocity": angular_velocity, "mass": mass, "inertia": inertia, "material": material}
        bodies, _kept = _bodies(columns, density)
        ids = np.empty(bodies.n, np.int32)
        handle = self._handle
        with handle.lock:
            handle.unused()
            handle.call("nsd_add", ctypes.byref(bodies), ids.ctypes.data)
        return ids

    def remove(self, ids: Iterable[int] | int) -> None:
        """Removes the bodies with these ids, one or [n]. Raises BufferError while an array of bodies is in use, Error (status 65)
        if there is no such body, or one occurs twice."""
        a = check.ids(ids, "ids")
        handle = self._handle
        with handle.lock:
            handle.unused()
            handle.call("nsd_remove", len(a), a.ctypes.data)

    # ---- saving ----

    def note(self, line: Mapping[str, Any] | str) -> None:
        """Sets the run's line in the history of its documents, a JSON object; call it before the first is written."""
        self._call("nsd_note", check.text(json.dumps(line, separators=(",", ":")) if isinstance(line, Mapping) else line, "line"))

    def save(self, path: Path) -> None:
        """Writes a document of the current state; replaces an existing file when it is complete. Raises Error (status 74) if it
        cannot be written."""
        self._writes("nsd_save", check.path(path))

    def append(self, path: Path) -> None:
        """Appends a frame to the trajectory, which the first call begins.

        An existing file is resumed. Raises Error, and leaves the file unchanged, if the file belongs to another scene, has this
        step or a later one, is damaged, or is being written. Remove the file to begin again.
        """
        self._writes("nsd_append", check.path(path))

    def finish(self) -> None:
        """Ends the trajectory."""
        self._writes("nsd_finish")


def _texts(names: Iterable[Any], what: str) -> Iterator[str]:
    for name in names:
        check.text(name, what)
        yield name


def _walls(name: Any, count: int, named: Mapping[str, list[int]]) -> list[int]:
    """The numbers of walls by a name or a number: of runs and of documents"""
    if not isinstance(name, str):
        k = check.whole(name, "name")
        if 0 <= k < count:
            return [k]
        raise check.NoWall(f"no wall {k}, but {count} walls, from 0")
    if name in named:
        return list(named[name])
    raise check.NoWall(f"no wall '{name}', but {', '.join(named) or 'none has a name'}")


def _number(name: str, text: str, kind: type) -> property:
    return property(lambda run: kind(run.number(name)), doc=text)


def _view(name: str, text: str, writable: bool = False) -> property:
    def put(run: Run, x: ArrayLike) -> None:
        new = check.numbers(x, name)
        with run._handle.lock:
            run.array(name)[...] = new
    return property(lambda run: run.array(name), put if writable else None, doc=text)


for _name, _text in {
    "position": "[n, 3] m: of the bodies' centres", "orientation": "[n, 4] unit quaternions (w, x, y, z)",
    "velocity": "[n, 3] m/s", "angular_velocity": "[n, 3] rad/s", "radius": "[n] m: of the circumscribed ball",
    "mass": "[n] kg; 0: fixed", "inertia": "[n] kg m^2", "id": "[n] numbers that stay with bodies", "material": "[n] number of the material",
    "shape": "[n] number of the shape, 0: a ball", "group": "[n] 1 + number of the group's name, 0: none",
    "image": "[n, 3] edges of the periodic cell to add to position",
    "contact_body": "[c, 2] ids of bodies a and b; -1-w: wall w", "contact_point": "[c, 3] m",
    "contact_normal": "[c, 3] unit vectors from a to b", "contact_gap": "[c] m; negative: overlap",
    "contact_friction": "[c] coefficients", "contact_force": "[c, 3] N: on b",
    "contact_velocity": "[c, 3] m/s: of b relative to a, as it enters the contact law", "contact_status": "[c] 0 free, 1 stick, 2 slide",
    "wall_position": "[b, 3] m", "wall_normal": "[b, 3] unit normals or axes", "wall_velocity": "[b, 3] m/s",
    "wall_angular_velocity": "[b, 3] rad/s", "wall_force": "[b, 3] N: force of the bodies on the wall",
    "wall_torque": "[b, 3] N m: torque of the same about wall_position, rolling and pivoting included",
    "cell_origin": "[3] m: of the periodic cell, see cell; [0]: none", "cell_edges": "[3, 3] m: one per row; [0, 3]: none",
    "cell_rates": "[3, 3] m/s: velocities of the edges; [0, 3]: none", "cell_periodic": "[3] 1: periodic along this edge; [0]: none",
}.items():
    setattr(Run, _name, _view(_name, _text))
    if _name.startswith("wall_") or _name == "material":  # and by their names of version 1
        setattr(Run, _name.replace("wall_", "boundary_").replace("material", "kind"), getattr(Run, _name))
for _name, _text in {
    "force": "[n, 3] N: on each body, until changed", "torque": "[n, 3] N m: on each body, until changed",
    "force_once": "[n, 3] N: in the next step", "torque_once": "[n, 3] N m: in the next step",
}.items():
    setattr(Run, _name, _view(_name, _text, True))
for _k in itertools.count():  # numbers of bodies that no line above describes
    if (_bytes := library.nsd_array_name(_k)) is None:
        break
    if not hasattr(Run, _bytes.decode()):
        setattr(Run, _bytes.decode(), _view(_bytes.decode(), "[n]: a number of each body, see nsd-format(5)"))
for _name, _number_name, _kind, _text in (
    ("time", "time", float, "s"), ("dt", "dt", float, "s: the time step"), ("step_number", "step", int, "steps made"),
    ("dim", "dim", int, "2 or 3"), ("contacts", "contacts", int, "number of contacts of the last step"),
):
    setattr(Run, _name, _number(_number_name, _text, _kind))
