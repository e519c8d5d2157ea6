"""Runs of nsd, stepped by a program."""
from __future__ import annotations

import ctypes
import json
import os
import threading
import weakref
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import Array, Bodies, RUN, library

Path = Union[str, "os.PathLike[str]"]

_ONCE, _LASTING = 0, 1
_DIVERGED, _SOFTWARE = 1, 70
_DTYPES = {b"d": np.float64, b"i": np.int32, b"b": np.int8}


class Error(RuntimeError):
    """An error of libnsd; `status` is that of nsd(3). The run is as it was before the call."""

    def __init__(self, status: int, text: str):
        super().__init__(text)
        self.status = status


class Diverged(Error):
    """The solve of a step diverged: the bodies have not moved."""


def _fail(status: int, text: str) -> None:
    if status == _SOFTWARE:
        raise MemoryError(text)
    raise (Diverged if status == _DIVERGED else Error)(status, text)


class _Handle:
    """The run of the library, freed when neither Run nor arrays need it."""

    def __init__(self, pointer: int | None):
        self.pointer = RUN(pointer)
        self.lock = threading.Lock()

    def call(self, name: str, *arguments: Any) -> None:
        with self.lock:
            status = getattr(library, name)(self.pointer, *arguments)
            text = library.nsd_error(self.pointer).decode(errors="replace") if status else ""
        if status:
            _fail(status, text)

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


def _vector(x: ArrayLike | None, what: str) -> Any:
    if x is None:
        return None
    a = np.ascontiguousarray(x, dtype=np.float64)
    if a.shape != (3,):
        raise ValueError(f"{what} is a vector of 3 numbers, not of shape {a.shape}")
    return a.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


def _bytes(path: Path) -> bytes:
    return os.fsencode(path)


_WIDTHS = {"position": 3, "orientation": 4, "velocity": 3, "angular_velocity": 3,
           "radius": 1, "mass": 1, "inertia": 1, "kind": 1}


def _bodies(columns: Mapping[str, ArrayLike | None], density: float | None) -> tuple[Bodies, list]:
    """The struct, and the arrays that it points into"""
    bodies, kept = Bodies(ctypes.sizeof(Bodies)), []
    n = None
    for name, x in columns.items():
        if x is None:
            continue
        width = _WIDTHS[name]
        a = np.ascontiguousarray(x, dtype=np.int32 if name == "kind" else np.float64)
        n = len(a) if n is None and a.ndim else n
        shape = (n,) if width == 1 else (n, width)
        if a.shape != shape:
            raise ValueError(f"{name} is of shape {a.shape}, not {shape}")
        kept.append(a)
        setattr(bodies, name, a.ctypes.data)
    bodies.n, bodies.density = n or 0, density or 0.0
    return bodies, kept


class Run:
    """A run: bodies and boundaries, stepped by this program. SI units throughout.

        with nsd.Run.from_scene("scene.json") as run:
            run.set(eps=1e-6)
            for _ in run.steps(until=0.5):
                run.force[:, 2] = -6e-3 * run.velocity[:, 2]    # N, until it is changed
            run.save("out.h5")

    Arrays of bodies (`position`, `force` ...) are views of the run's own memory: they show the state after each step,
    and keep that memory alive, also after close(). While any of them is in use bodies cannot be added or removed
    (BufferError); `.copy()` makes an independent array. Arrays of contacts and boundaries are copies, of the last step.
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
    kind: NDArray[np.int32]
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
    boundary_position: NDArray[np.float64]
    boundary_normal: NDArray[np.float64]
    boundary_velocity: NDArray[np.float64]
    boundary_angular_velocity: NDArray[np.float64]
    boundary_force: NDArray[np.float64]
    boundary_torque: NDArray[np.float64]
    time: float
    dt: float
    step_number: int
    dim: int
    contacts: int

    def __init__(self, handle: _Handle):
        self._handle: _Handle | None = handle
        self._views: weakref.WeakSet[_Owner] = weakref.WeakSet()

    # ---- made, and closed ----

    @staticmethod
    def _make(name: str, *arguments: Any) -> "Run":
        pointer = RUN()
        status = getattr(library, name)(ctypes.byref(pointer), *arguments)
        if status:
            _fail(status, library.nsd_error(None).decode(errors="replace"))
        return Run(_Handle(pointer.value))

    @classmethod
    def from_scene(cls, scene: Path | Mapping[str, Any], folder: Path | None = None) -> "Run":
        """A run from a scene [nsd-scene(5)]: a dict, its JSON, or the path of a file. File names in it are relative to folder, or to the file."""
        if isinstance(scene, Mapping):
            scene = json.dumps(scene)
        if isinstance(scene, str) and scene.lstrip().startswith("{"):
            return cls._make("nsd_from_scene", scene.encode(), None if folder is None else _bytes(folder))
        return cls._make("nsd_from_scene_file", _bytes(scene))

    @classmethod
    def from_document(cls, document: Path | bytes) -> "Run":
        """A run from the last frame of a document [nsd-format(5)]: the path of a file, or its bytes."""
        if isinstance(document, bytes):
            return cls._make("nsd_from_memory", document, len(document))
        return cls._make("nsd_from_document", _bytes(document))

    @classmethod
    def from_arrays(cls, scene: Path | Mapping[str, Any], *, position: ArrayLike, radius: ArrayLike,
                    orientation: ArrayLike | None = None, velocity: ArrayLike | None = None,
                    angular_velocity: ArrayLike | None = None, mass: ArrayLike | None = None,
                    inertia: ArrayLike | None = None, kind: ArrayLike | None = None,
                    density: float | None = None, folder: Path | None = None) -> "Run":
        """A run from a scene without bodies, to which these are added: see add()."""
        run = cls.from_scene(scene, folder)
        if len(run.id):
            raise ValueError("the scene has bodies of its own: arrays are for one without")
        run.add(position=position, radius=radius, orientation=orientation, velocity=velocity,
                angular_velocity=angular_velocity, mass=mass, inertia=inertia, kind=kind, density=density)
        return run

    def close(self) -> None:
        """Ends a trajectory begun by append(), and the run. Arrays that are in use stay valid."""
        if self._handle is None:
            return
        try:
            self.finish()
        finally:
            self._handle = None

    def __enter__(self) -> "Run":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._handle is None:
            return "<nsd run, closed>"
        return f"<nsd run at step {self.step_number}, {self.time:g} s: {len(self.id)} bodies>"

    def _call(self, name: str, *arguments: Any) -> None:
        if self._handle is None:
            raise ValueError("the run is closed")
        self._handle.call(name, *arguments)

    def _unused(self) -> None:
        """Before bodies are added or removed: no array may be in use."""
        if len(self._views):
            raise BufferError("arrays of this run are in use while bodies are added or removed: keep copies instead (x.copy(), del x)")

    # ---- options and steps ----

    def set(self, **options: Any) -> "Run":
        """Sets options of nsd-step(1) and nsd-stat(1) by their names, with _ instead of -: eps=1e-6, method="exact", dt=1e-4, threads=2,
        contacts=True ...; returns the run."""
        for name, value in options.items():
            text = str(value).lower() if isinstance(value, bool) else str(value)
            self._call("nsd_set", name.replace("_", "-").encode(), text.encode())
        return self

    def step(self, n: int = 1) -> None:
        """Makes n steps."""
        if self._resizes():
            self._unused()
        self._call("nsd_step", int(n))

    def until(self, time: float) -> None:
        """Makes steps until this time (s)."""
        if self._resizes():
            self._unused()
        self._call("nsd_until", float(time))

    def steps(self, n: int | None = None, until: float | None = None) -> Iterator[int]:
        """Makes n steps, or steps until a time (s), or without either without end; yields the number of each after it was made."""
        made = 0
        while (n is None or made < n) and (until is None or self.time < until - 1e-6 * self.dt):
            self.step()
            made += 1
            yield self.step_number

    def __iter__(self) -> Iterator[int]:
        return self.steps()

    def _resizes(self) -> bool:
        if self._handle is None:
            raise ValueError("the run is closed")
        return bool(library.nsd_resizes(self._handle.pointer))

    # ---- reading ----

    def array(self, name: str) -> NDArray[Any]:
        """An array by its name in nsd(3): "position", "contact_force" ..."""
        described = Array(ctypes.sizeof(Array))
        self._call("nsd_read", name.encode(), ctypes.byref(described))
        assert self._handle is not None
        owner = _Owner(self._handle, described)
        if 0 in described.shape[:described.rank]:
            return np.zeros(tuple(described.shape[:described.rank]), _DTYPES[described.type])
        view = np.asarray(owner)
        if name.startswith(("contact_", "boundary_")):
            return view.copy()
        self._views.add(owner)
        return view

    def number(self, name: str) -> float:
        """A number by its name in nsd(3): "time", "contacts", "natural" ...; nan: not defined yet."""
        x = ctypes.c_double()
        self._call("nsd_number", name.encode(), ctypes.byref(x))
        return x.value

    def _text(self, name: str, *arguments: Any) -> Any:
        text = ctypes.c_char_p()
        self._call(name, *arguments, ctypes.byref(text))
        return json.loads(text.value or b"null")

    @property
    def report(self) -> dict[str, Any]:
        """The report of the last solve, with the keys of nsd-info(1)."""
        return self._text("nsd_report")

    @property
    def names(self) -> dict[str, Any]:
        """{"kinds": [...], "shapes": [...], "walls": [name or None, ...], "groups": [...]}: walls are in their order."""
        return self._text("nsd_names")

    def walls(self, name: int | str) -> list[int]:
        """The numbers of the walls that have this name; a number stands for that wall."""
        if not isinstance(name, str):
            return [int(name)]
        known = self.names["walls"]
        found = [k for k, own in enumerate(known) if own == name]
        if not found:
            names = ", ".join(dict.fromkeys(own for own in known if own))
            raise ValueError(f"no wall '{name}', but {names or 'none has a name'}")
        return found

    def measure(self, *names: str) -> dict[str, Any]:
        """Measures of nsd-stat(1) by their names, with its keys: run.measure("stress")["stress"]["pressure"]."""
        return self._text("nsd_measure", ",".join(names).encode())

    # ---- acting ----

    def push(self, id: int, force: ArrayLike | None = None, torque: ArrayLike | None = None, *,
             once: bool = False) -> None:
        """Applies a force (N) and a torque (N m) to the body with this id, in the next step only or until they are changed."""
        self._call("nsd_force", int(id), _vector(force, "force"), _vector(torque, "torque"),
                   _ONCE if once else _LASTING)

    def push_boundary(self, boundary: int | str, force: float, *, once: bool = False) -> None:
        """Adds a force (N) along the axis of the boundary's load, or a torque (N m) about it, to the load. A name stands for each
        wall that has it."""
        for wall in self.walls(boundary):
            self._call("nsd_boundary_force", wall, float(force), _ONCE if once else _LASTING)

    def move_boundary(self, boundary: int | str, velocity: ArrayLike) -> None:
        """Prescribes the boundary's velocity (3 numbers, m/s) from now on; a name stands for each wall that has it."""
        for wall in self.walls(boundary):
            self._call("nsd_boundary_velocity", wall, _vector(velocity, "velocity"))

    def throw(self, id: int, velocity: ArrayLike | None = None, angular_velocity: ArrayLike | None = None) -> None:
        """Gives the body with this id a velocity (3 numbers, m/s) and an angular velocity (rad/s); None: unchanged."""
        self._call("nsd_velocity", int(id), _vector(velocity, "velocity"), _vector(angular_velocity, "angular_velocity"))

    def gravity(self, g: ArrayLike) -> None:
        """Sets gravity, 3 numbers, m/s^2."""
        self._call("nsd_gravity", _vector(g, "gravity"))

    def friction(self, kind: str, other: str, mu: float) -> None:
        """Sets the coefficient of friction between two kinds of material."""
        self._call("nsd_friction", kind.encode(), other.encode(), float(mu))

    def add(self, *, position: ArrayLike, radius: ArrayLike, orientation: ArrayLike | None = None,
            velocity: ArrayLike | None = None, angular_velocity: ArrayLike | None = None,
            mass: ArrayLike | None = None, inertia: ArrayLike | None = None,
            kind: ArrayLike | None = None, density: float | None = None) -> NDArray[np.int32]:
        """Adds n balls, in 2D discs; returns their ids [n].

        position [n, 3] m, radius [n] m, orientation [n, 4] unit quaternions (w, x, y, z), velocity [n, 3] m/s,
        angular_velocity [n, 3] rad/s, mass [n] kg (0: fixed) or one density (kg/m^3, in 2D kg/m^2), inertia [n]
        kg m^2 [that of solid balls], kind [n] number of the kind of material [0].
        """
        columns = {"position": position, "radius": radius, "orientation": orientation, "velocity": velocity,
                   "angular_velocity": angular_velocity, "mass": mass, "inertia": inertia, "kind": kind}
        bodies, _kept = _bodies(columns, density)
        ids = np.empty(bodies.n, np.int32)
        self._unused()
        self._call("nsd_add", ctypes.byref(bodies), ids.ctypes.data)
        return ids

    def remove(self, ids: Iterable[int] | int) -> None:
        """Removes the bodies with these ids."""
        a = np.ascontiguousarray(np.atleast_1d(np.asarray(ids if isinstance(ids, (int, np.ndarray)) else list(ids))),
                                 dtype=np.int32)
        if a.ndim != 1:
            raise ValueError(f"ids are of shape {a.shape}, not (n,)")
        self._unused()
        self._call("nsd_remove", len(a), a.ctypes.data)

    # ---- saving ----

    def note(self, line: Mapping[str, Any] | str) -> None:
        """Sets the run's line in the history of its documents, a JSON object; call it before the first is written."""
        self._call("nsd_note", (line if isinstance(line, str) else json.dumps(line, separators=(",", ":"))).encode())

    def save(self, path: Path) -> None:
        """Writes a document of the current state; replaces an existing file when it is complete."""
        self._call("nsd_save", _bytes(path))

    def append(self, path: Path) -> None:
        """Appends a frame to the trajectory, which the first call begins.

        An existing file is resumed. Raises Error, and leaves the file unchanged, if the file belongs to another scene, has this
        step or a later one, is damaged, or is being written. Remove the file to begin again.
        """
        self._call("nsd_append", _bytes(path))

    def finish(self) -> None:
        """Ends the trajectory."""
        self._call("nsd_finish")


def _number(name: str, text: str, kind: type) -> property:
    return property(lambda run: kind(run.number(name)), doc=text)


def _view(name: str, text: str, writable: bool = False) -> property:
    def put(run: Run, x: ArrayLike) -> None:
        run.array(name)[...] = x
    return property(lambda run: run.array(name), put if writable else None, doc=text)


for _name, _text in {
    "position": "[n, 3] m: of the bodies' centres", "orientation": "[n, 4] unit quaternions (w, x, y, z)",
    "velocity": "[n, 3] m/s", "angular_velocity": "[n, 3] rad/s", "radius": "[n] m: of the circumscribed ball",
    "mass": "[n] kg; 0: fixed", "inertia": "[n] kg m^2", "id": "[n] numbers that stay with bodies", "kind": "[n] number of the kind of material",
    "contact_body": "[c, 2] ids of bodies a and b; -1-w: boundary w", "contact_point": "[c, 3] m",
    "contact_normal": "[c, 3] unit vectors from a to b", "contact_gap": "[c] m; negative: overlap",
    "contact_friction": "[c] coefficients", "contact_force": "[c, 3] N: on b",
    "contact_velocity": "[c, 3] m/s: of b relative to a, as it enters the contact law", "contact_status": "[c] 0 free, 1 stick, 2 slide",
    "boundary_position": "[b, 3] m", "boundary_normal": "[b, 3] unit normals or axes", "boundary_velocity": "[b, 3] m/s",
    "boundary_angular_velocity": "[b, 3] rad/s", "boundary_force": "[b, 3] N: force of the bodies on the boundary",
    "boundary_torque": "[b, 3] N m: torque of the same about boundary_position, rolling and pivoting included",
}.items():
    setattr(Run, _name, _view(_name, _text))
for _name, _text in {
    "force": "[n, 3] N: on each body, until changed", "torque": "[n, 3] N m: on each body, until changed",
    "force_once": "[n, 3] N: in the next step", "torque_once": "[n, 3] N m: in the next step",
}.items():
    setattr(Run, _name, _view(_name, _text, True))
for _name, _number_name, _kind, _text in (
    ("time", "time", float, "s"), ("dt", "dt", float, "s: the time step"), ("step_number", "step", int, "steps made"),
    ("dim", "dim", int, "2 or 3"), ("contacts", "contacts", int, "number of contacts of the last step"),
):
    setattr(Run, _name, _number(_number_name, _text, _kind))
