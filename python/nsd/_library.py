"""libnsd.so.2 by ctypes: what nsd.h declares."""
from __future__ import annotations

import _thread
import ctypes
import os
import sys
import threading
import time
from collections.abc import Callable
from typing import Any
from ctypes import POINTER, c_char, c_char_p, c_double, c_int, c_int32, c_int64, c_size_t, c_void_p
from pathlib import Path


class Bodies(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("n", c_int64), ("position", c_void_p), ("radius", c_void_p),
                ("orientation", c_void_p), ("velocity", c_void_p), ("angular_velocity", c_void_p),
                ("mass", c_void_p), ("inertia", c_void_p), ("material", c_void_p), ("density", c_double)]


class Array(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("data", c_void_p), ("unit", c_char_p), ("shape", c_int64 * 2),
                ("stride", c_int64 * 2), ("rank", c_int32), ("type", c_char), ("writable", c_char)]


RUN = DOCUMENT = c_void_p
VECTOR = POINTER(c_double)
_functions = {  # name: what it takes; each returns a status but for those below
    "nsd_from_scene": (POINTER(RUN), c_char_p, c_char_p),
    "nsd_from_scene_file": (POINTER(RUN), c_char_p),
    "nsd_from_document": (POINTER(RUN), c_char_p),
    "nsd_from_memory": (POINTER(RUN), c_char_p, c_size_t),
    "nsd_from_arrays": (POINTER(RUN), c_char_p, c_char_p, POINTER(Bodies)),
    "nsd_set": (RUN, c_char_p, c_char_p),
    "nsd_step": (RUN, c_int64),
    "nsd_until": (RUN, c_double),
    "nsd_read": (RUN, c_char_p, POINTER(Array)),
    "nsd_resizes": (RUN,),
    "nsd_number": (RUN, c_char_p, POINTER(c_double)),
    "nsd_report": (RUN, POINTER(c_char_p)),
    "nsd_failure": (RUN, POINTER(c_char_p)),
    "nsd_names": (RUN, POINTER(c_char_p)),
    "nsd_measure": (RUN, c_char_p, POINTER(c_char_p)),
    "nsd_force": (RUN, c_int32, VECTOR, VECTOR, c_int),
    "nsd_wall_force": (RUN, c_int32, c_double, c_int),
    "nsd_wall_velocity": (RUN, c_int32, VECTOR),
    "nsd_velocity": (RUN, c_int32, VECTOR, VECTOR),
    "nsd_gravity": (RUN, VECTOR),
    "nsd_friction": (RUN, c_char_p, c_char_p, c_double),
    "nsd_add": (RUN, POINTER(Bodies), c_void_p),
    "nsd_remove": (RUN, c_int64, c_void_p),
    "nsd_note": (RUN, c_char_p),
    "nsd_save": (RUN, c_char_p),
    "nsd_append": (RUN, c_char_p),
    "nsd_finish": (RUN,),
    "nsd_open": (POINTER(DOCUMENT), c_char_p),
    "nsd_next": (DOCUMENT, POINTER(c_int)),
    "nsd_objects": (DOCUMENT, POINTER(c_char_p)),
    "nsd_attributes": (DOCUMENT, c_char_p, POINTER(c_char_p)),
    "nsd_text": (DOCUMENT, c_char_p, POINTER(c_char_p)),
    "nsd_rows": (DOCUMENT, c_char_p, c_int64, c_int64, POINTER(Array)),
}


def _load() -> ctypes.CDLL:
    """NSD_LIBRARY; else the library next to the installed or built module; else that of the system."""
    here = Path(__file__).resolve()
    near = [here.parents[3] / "libnsd.so.2", here.parents[2] / "build" / "libnsd.so.2"]
    named = os.environ.get("NSD_LIBRARY")
    found = named or next((str(path) for path in near if path.exists()), "libnsd.so.2")
    library = ctypes.CDLL(found)
    for name, takes in _functions.items():
        function = getattr(library, name)
        function.argtypes, function.restype = takes, c_int
    library.nsd_close.argtypes, library.nsd_close.restype = (POINTER(RUN),), None
    library.nsd_shut.argtypes, library.nsd_shut.restype = (POINTER(DOCUMENT),), None
    library.nsd_error.argtypes, library.nsd_error.restype = (RUN,), c_char_p
    library.nsd_version.argtypes, library.nsd_version.restype = (), c_char_p
    library.nsd_array_name.argtypes, library.nsd_array_name.restype = (c_int,), c_char_p
    return library


library = _load()


class Error(RuntimeError):
    """An error of libnsd; `status` is that of nsd(3). The run is as it was before the call; of several steps those before the
    failed one remain made."""

    def __init__(self, status: int, text: str):
        super().__init__(text)
        self.status = status

    def __reduce__(self) -> Any:
        return type(self), (self.status, str(self))


class Diverged(Error):
    """The solve of a step diverged, or its result is not finite: the bodies have not moved."""


_DIVERGED, _SOFTWARE = 1, 70


def fail(status: int, text: bytes) -> None:
    """The exception of a status that is not 0"""
    words = text.decode(errors="replace")
    if status == _SOFTWARE:
        raise MemoryError(words)
    raise (Diverged if status == _DIVERGED else Error)(status, words)


# ---- calls that take long, and Ctrl-C ----

QUICK = 0.005  # s: a call that took less the last time is made by the calling thread itself


class Pace:
    """How long a kind of call takes, by the last one"""

    def __init__(self) -> None:
        self.seconds = float("inf")

    def make(self, call: Callable[[Callable[[], bool]], Any]) -> Any:
        """The result of call(stopped).

        Python handles a signal only in its main thread and not before a call of the library returns. A call that may take long
        is therefore made by a thread of its own, for which the main thread waits: an exception of a signal handler
        (KeyboardInterrupt) arrives at once. What the call does after that ends as soon as stopped() is looked at, and its
        result is dropped.
        """
        begun = time.perf_counter()
        if self.seconds < QUICK or threading.get_ident() != threading.main_thread().ident:
            result = call(lambda: False)
        else:
            result = _beside(call)
        self.seconds = time.perf_counter() - begun
        return result


class _Work:
    """What a thread does beside the one that waits for it"""

    def __init__(self, call: Callable[[Callable[[], bool]], Any]):
        self._call = call
        self.stopped = False
        self.result: list[Any] = []
        self.trouble: list[BaseException] = []

    def __call__(self, done: Any, token: object) -> None:
        try:
            self.result.append(self._call(lambda: self.stopped))
        except BaseException as e:  # for the thread that waits
            self.trouble.append(e)
        finally:
            done.release()


def _beside(call: Callable[[Callable[[], bool]], Any]) -> Any:
    done, token = threading.Lock(), object()
    work = _Work(call)
    done.acquire()
    try:
        _thread.start_new_thread(work, (done, token))
    except (RuntimeError, MemoryError):  # no thread can be had: then a signal waits
        return call(lambda: False)
    except BaseException:
        work.stopped = True
        raise
    try:
        while not done.acquire(timeout=1):
            if sys.getrefcount(token) < 3:  # the thread has ended without memory to say so
                break
    except BaseException:  # KeyboardInterrupt
        work.stopped = True
        raise
    if work.trouble:
        raise work.trouble.pop()
    if not work.result:
        raise MemoryError("no memory for a thread")
    return work.result.pop()
