"""nsd in Python: runs of the Non-Smooth Discrete Element Method, and their documents.

    import nsd
    run = nsd.Run.from_scene("scene.json")      # libnsd: stepped, read, acted on [nsd-python(7)]
    run.step(100)
    print(run.position[:, 2].max())
    for frame in nsd.frames("out.h5"):          # frames of documents [nsd-format(5)]
        print(frame.step, frame.time, frame.position[:, 2].max())

It needs libnsd.so.2 and numpy, which are loaded when they are first used.
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._documents import Contacts, Document, Frame, Problem, documents, fclib, frames, last
    from ._run import Cell, Diverged, Error, FailedStep, Run

_RUNS = ("Run", "Cell", "Error", "Diverged", "FailedStep")
_DOCUMENTS = ("Contacts", "Document", "Frame", "Problem", "documents", "frames", "last", "fclib")
__all__ = [*_RUNS, *_DOCUMENTS]


def __getattr__(name: str) -> Any:
    if name in _RUNS:
        from . import _run as module
    elif name in _DOCUMENTS:
        from . import _documents as module
    else:
        raise AttributeError(f"module 'nsd' has no attribute '{name}'")
    value = getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
