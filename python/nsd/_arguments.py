"""Arguments as the library takes them: whole numbers, reals, vectors, texts, paths. What it would not get unchanged is refused, by the
name of the argument: TypeError if it is of another kind (a bool, a text), ValueError if it is out of range."""
from __future__ import annotations

import operator
import os
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

INT32 = (-(1 << 31), (1 << 31) - 1)
INT64 = (-(1 << 63), (1 << 63) - 1)
_BOOLS = (bool, np.bool_)


class NoWall(KeyError, ValueError):
    """There is no such wall."""

    def __str__(self) -> str:
        return str(self.args[0])


def whole(x: Any, name: str, bounds: tuple[int, int] = INT32) -> int:
    """A whole number within bounds; 2.0 is one, 2.5, True and "2" are none."""
    if isinstance(x, _BOOLS):
        raise TypeError(f"{name}: {x} is no number")
    try:
        n = operator.index(x)
    except TypeError:
        if not isinstance(x, (float, np.floating)):
            raise TypeError(f"{name}: a whole number is needed, not {type(x).__name__}") from None
        if not float(x).is_integer():
            raise ValueError(f"{name}: {x} is no whole number") from None
        n = int(x)
    if not bounds[0] <= n <= bounds[1]:
        raise ValueError(f"{name}: {n:.6g} is not between {bounds[0]} and {bounds[1]}")
    return n


def real(x: Any, name: str) -> float:
    """A number; what is no number (nan) the library refuses."""
    if isinstance(x, (*_BOOLS, str, bytes, bytearray)):
        raise TypeError(f"{name}: a number is needed, not {type(x).__name__}")
    try:
        return float(x)
    except OverflowError:
        raise ValueError(f"{name}: the number is too large") from None
    except TypeError:
        raise TypeError(f"{name}: a number is needed, not {type(x).__name__}") from None


def numbers(x: Any, name: str) -> NDArray[np.float64]:
    """An array of reals, in one piece"""
    a = np.asarray(x)
    if a.size and a.dtype.kind not in "iuf":
        raise TypeError(f"{name}: numbers are needed, not {a.dtype}")
    return np.ascontiguousarray(a, dtype=np.float64)


def integers(x: Any, name: str) -> NDArray[np.int32]:
    """An array of whole numbers of 32 bits, in one piece"""
    if isinstance(x, (list, tuple)) and any(isinstance(i, _BOOLS) for i in x):
        raise TypeError(f"{name}: whole numbers are needed, not bool")
    a = np.asarray(x)
    if a.size and a.dtype.kind not in "iuf" and not _too_large(a):
        raise TypeError(f"{name}: whole numbers are needed, not {a.dtype}")
    if a.size and (a.dtype.kind == "O" or not ((INT32[0] <= a) & (a <= INT32[1])).all()):
        raise ValueError(f"{name}: one is not between {INT32[0]} and {INT32[1]}")
    if a.size and a.dtype.kind == "f" and not (a == np.floor(a)).all():
        raise ValueError(f"{name}: one is no whole number")
    return np.ascontiguousarray(a, dtype=np.int32)


def _too_large(a: NDArray[Any]) -> bool:
    """Are they whole numbers beyond 64 bits, of which numpy makes objects?"""
    return a.dtype.kind == "O" and all(isinstance(i, int) for i in a.flat)


def ids(x: Any, name: str) -> NDArray[np.int32]:
    """One id, or several, [n]"""
    if isinstance(x, (str, bytes)):
        raise TypeError(f"{name}: whole numbers are needed, not {type(x).__name__}")
    several = x if isinstance(x, np.ndarray) else list(x) if isinstance(x, Iterable) else [whole(x, name)]
    a = np.atleast_1d(integers(several, name))
    if a.ndim != 1:
        raise ValueError(f"{name} are of shape {a.shape}, not (n,)")
    return a


def vector(x: Any, name: str) -> NDArray[np.float64]:
    """[3] numbers"""
    a = numbers(x, name)
    if a.shape != (3,):
        raise ValueError(f"{name} is a vector of 3 numbers, not of shape {a.shape}")
    return a


def _ends(b: bytes, name: str) -> bytes:
    if b"\0" in b:
        raise ValueError(f"{name}: it has a zero byte in it")
    return b


def text(x: Any, name: str) -> bytes:
    """A text without a zero, in UTF-8"""
    if not isinstance(x, str):
        raise TypeError(f"{name}: a text is needed, not {type(x).__name__}")
    return _ends(x.encode(), name)


def path(x: Any, name: str = "path") -> bytes:
    """A path without a zero, as the system has it"""
    if not isinstance(x, (str, bytes, os.PathLike)):
        raise TypeError(f"{name}: a path is needed, not {type(x).__name__}")
    return _ends(os.fsencode(x), name)
