"""Documents as groups and datasets, by libnsd: a process of its own reads and checks them as nsd's tools do, so that a damaged or
hostile document raises Error instead of harming the program; nothing outside the document is read."""
from __future__ import annotations

import collections
import ctypes
import json
import os
import stat
import struct
import sys
import threading
import weakref
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from typing import Any, BinaryIO, Union

import numpy as np
from numpy.typing import NDArray

from . import _arguments as check
from ._library import Array, DOCUMENT, Error, Pace, fail, library

MAGIC = b"\x89NSD\r\n\x1a\n"
HEADER = 512  # bytes in front of a document
UNFINISHED = 1  # flag: still being written, and as long as its file
PIECE = 1 << 20  # bytes of a stream that are read at once
OPEN_MOST = 16  # documents that a process reads at the same time; others are opened again when they are asked for
LARGE = 1 << 20  # bytes that take long enough to wait for in the way of Ctrl-C

Source = Union[str, "os.PathLike[str]", BinaryIO]
_DTYPES = {b"d": np.float64, b"i": np.int32, b"b": np.int8, b"l": np.int64}


class _Reader:
    """The documents of a file, one after another, by the library."""

    def __init__(self, path: bytes):
        self.maker, self.lock = os.getpid(), threading.RLock()
        self._pointer = DOCUMENT()
        self.call("nsd_open", ctypes.byref(self._pointer), path, opened=False)

    def next(self) -> dict[str, dict[str, Any]] | None:
        """The objects of the next document; None: there is none."""
        more = ctypes.c_int()
        with self.lock:
            self.call("nsd_next", ctypes.byref(more))
            return self.json("nsd_objects") if more.value else None

    def call(self, name: str, *arguments: Any, opened: bool = True) -> None:
        """The reason of a failure is that of the thread."""
        first = (self._pointer,) if opened else ()
        status = getattr(library, name)(*first, *arguments)
        if status:
            fail(status, library.nsd_error(None))

    def text(self, name: str, *arguments: Any) -> str:
        text = ctypes.c_char_p()
        with self.lock:
            self.call(name, *arguments, ctypes.byref(text))
            return (text.value or b"").decode(errors="replace")

    def json(self, name: str, *arguments: Any) -> Any:
        return json.loads(self.text(name, *arguments))

    def rows(self, path: bytes, first: int, n: int) -> NDArray[Any]:
        """[n, width] numbers"""
        array = Array(ctypes.sizeof(Array))
        with self.lock:
            self.call("nsd_rows", path, first, n, ctypes.byref(array))
            dtype = np.dtype(_DTYPES[array.type])
            shape = tuple(array.shape)
            if 0 in shape:
                return np.zeros(shape, dtype)
            return np.frombuffer(ctypes.string_at(array.data, shape[0] * shape[1] * dtype.itemsize), dtype).reshape(shape).copy()

    def __del__(self, shut: Any = library.nsd_shut, byref: Any = ctypes.byref) -> None:
        shut(byref(self._pointer))


# those that are being read, the last one used last
_open: collections.OrderedDict[int, "weakref.ref[_Filed]"] = collections.OrderedDict()
_lock = threading.RLock()


def _after_fork() -> None:
    """Another thread may have held it; what the parent reads it reads alone."""
    global _lock
    _lock = threading.RLock()
    _open.clear()


os.register_at_fork(after_in_child=_after_fork)


class Group(Mapping):
    """A group of a document: a mapping of the names, or paths, of what is in it to groups and datasets."""

    def __init__(self, document: "Document", path: str):
        self._document, self._path = document, path

    def _of(self, name: Any) -> str:
        return f"{'' if str(name).startswith('/') else self._path}/{name}".replace("//", "/").rstrip("/")

    def __contains__(self, name: Any) -> bool:
        return self._of(name) in self._document.objects

    def __getitem__(self, name: str) -> Any:
        path = self._of(name)
        known = self._document.objects.get(path)
        if known is None:
            raise KeyError(f"{self._document.name}: there is no {path}")
        return (Group if known["type"] == "group" else Dataset)(self._document, path)

    def __iter__(self) -> Iterator[str]:
        start = self._path + "/"
        return iter([p[len(start):] for p in self._document.objects if p.startswith(start) and "/" not in p[len(start):]])

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __eq__(self, other: object) -> bool:
        return self is other

    __hash__ = object.__hash__

    @cached_property
    def attrs(self) -> dict[str, Any]:
        """Attributes by their names: numbers, texts and lists of them; None: neither, or not finite"""
        return self._document.attributes(self._path)

    def __repr__(self) -> str:
        return f"<nsd group {self._path or '/'} of {self._document.name}>"


class Dataset:
    """A dataset of a document; [()] reads all of it, [k] and [k:l] rows of it."""

    def __init__(self, document: "Document", path: str):
        self._document, self._path = document, path
        known = document.objects[path]
        self.shape: tuple[int, ...] = tuple(known["shape"])
        self._type: str = known["type"]

    @property
    def dtype(self) -> np.dtype:
        return np.dtype(self._type) if self._type[0] in "fiu" else np.dtype(object)

    @property
    def ndim(self) -> int:
        return len(self.shape)

    @property
    def size(self) -> int:
        return int(np.prod(self.shape, dtype=object))

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError(f"{self._path} is a single value")
        return self.shape[0]

    @cached_property
    def attrs(self) -> dict[str, Any]:
        """As those of a group"""
        return self._document.attributes(self._path)

    def _read(self, first: int, n: int) -> NDArray[Any]:
        return self._document.rows(self._path, first, n).reshape((n, *self.shape[1:])).astype(self.dtype, copy=False)

    def __getitem__(self, key: Any) -> Any:
        if self._type == "s":
            text = self._document.text(self._path)
            return np.array(text.splitlines(), object)[key] if self.shape else text
        if not self.shape:
            return self._document.rows(self._path, 0, 1).astype(self.dtype).reshape(())[key]
        head, rest = (key[0], key[1:]) if isinstance(key, tuple) and key else (key, ())
        if isinstance(head, (int, np.integer)) and not isinstance(head, (bool, np.bool_)):
            k = range(len(self))[head]
            return self._read(k, 1)[(0, *rest)]
        if isinstance(head, slice):
            rows = range(len(self))[head]
            if rows.step == 1:
                return self._read(rows.start, len(rows))[(slice(None), *rest)]
        return self._read(0, len(self))[key]

    def __iter__(self) -> Iterator[Any]:
        return iter(self[()])

    def __array__(self, dtype: Any = None, copy: Any = None) -> NDArray[Any]:
        return np.asarray(self[()], dtype)

    def __repr__(self) -> str:
        return f"<nsd dataset {self._path} of {self._document.name}: {self._type}{list(self.shape)}>"


class Document(Group):
    """A document [nsd-format(5)]: its groups and datasets by their paths, as in document["nsd"].attrs["dt"] and
    document["particles/all/position/value"][-1]. Values are read when they are asked for."""

    name: str  # of its source, for messages
    objects: dict[str, dict[str, Any]]

    def __init__(self, name: str, reader: _Reader | None, objects: dict[str, dict[str, Any]]):
        self._path, self.name, self._reader, self.objects = "", name, reader, objects
        self._pace = Pace()
        self._kept: dict[tuple[str, str], Any] = {}  # what has been read, once the reader has gone on

    @property
    def _document(self) -> "Document":
        return self

    def _now(self) -> _Reader:
        assert self._reader is not None
        return self._reader

    def _value(self, kind: str, path: str) -> Any:
        """Its attributes ("nsd_attributes") or its text ("nsd_text")"""
        if self._reader is None and (kind, path) in self._kept:
            return self._kept[kind, path]
        reader = self._now()
        return (reader.json if kind == "nsd_attributes" else reader.text)(kind, path.encode())

    def attributes(self, path: str) -> dict[str, Any]:
        return self._value("nsd_attributes", path)

    def text(self, path: str) -> str:
        return self._value("nsd_text", path)

    def rows(self, path: str, first: int, n: int) -> NDArray[Any]:
        """[n, width] of a dataset"""
        known = self.objects[path]
        if self._reader is None and ("rows", path) in self._kept:
            return self._kept["rows", path][first:first + n].copy()
        reader = self._now()
        if n * int(np.prod(known["shape"][1:], dtype=object)) * 8 < LARGE:
            return reader.rows(path.encode(), first, n)
        return self._pace.make(lambda _: reader.rows(path.encode(), first, n))

    def _keep(self) -> None:
        """All of it, before the reader goes on to the next document of the stream"""
        for path, known in {"": {"type": "group", "shape": []}, **self.objects}.items():
            self._kept["nsd_attributes", path] = self.attributes(path)
            if known["type"] == "s":
                self._kept["nsd_text", path] = self.text(path)
            elif known["type"][0] in "fiu":
                self._kept["rows", path] = self.rows(path, 0, known["shape"][0] if known["shape"] else 1)
        self._reader = None

    def __repr__(self) -> str:
        return f"<nsd document {self.name}>"


class _Filed(Document):
    """The only document of a file, which may be opened again"""

    def __init__(self, path: bytes, name: str, keeps: Any = None):
        super().__init__(name, None, {})
        self._file, self._keeps, self._is = path, keeps, _identity(path)
        self._now()

    def _now(self) -> _Reader:
        """The reader, opened again where it has been closed for others, or is the parent's"""
        with _lock:
            reader = self._reader
            if reader is None or reader.maker != os.getpid():
                if _identity(self._file) != self._is:
                    raise Error(65, f"{self.name}: another file has taken its place")
                reader, objects = Pace().make(lambda _: _opened(self._file))
                self._reader, self.objects = reader, self.objects or objects
            _open[id(self)] = weakref.ref(self)
            _open.move_to_end(id(self))
            while len(_open) > OPEN_MOST:
                oldest = _open.popitem(last=False)[1]()
                if oldest is not None:
                    oldest._reader = None
            return reader

    def __del__(self, forget: Any = _open.pop) -> None:
        forget(id(self), None)


def _identity(path: bytes) -> tuple[int, int]:
    st = os.stat(path)
    return st.st_dev, st.st_ino


def _opened(path: bytes) -> tuple[_Reader, dict[str, dict[str, Any]]]:
    reader = _Reader(path)
    return reader, reader.next() or {}


# ---- the documents of a source ----

def _alone(path: bytes) -> bool:
    """Is there one document in the file, for the library to look at by its path? Else they are taken apart here."""
    with open(path, "rb") as f:
        head = f.read(HEADER)
        if len(head) < 24 or head[:8] != MAGIC:
            return True
        flags, length = struct.unpack("<IQ", head[12:24])
        return bool(flags & UNFINISHED) or length >= os.fstat(f.fileno()).st_size


def _readable(stream: BinaryIO) -> bytes | None:
    """The path by which the process that reads opens it, if nothing of it has been read; None: it has none"""
    try:
        fd = stream.fileno()
        mode = os.fstat(fd).st_mode
        if stat.S_ISFIFO(mode) or (stat.S_ISREG(mode) and os.lseek(fd, 0, os.SEEK_CUR) == 0):
            return b"/proc/self/fd/%d" % fd
    except (OSError, ValueError, AttributeError):
        pass
    return None


def _passing(path: bytes, name: str) -> Iterator[Document]:
    """Documents back to back: one reader for all of them"""
    pace = Pace()
    reader = pace.make(lambda _: _Reader(path))
    pace = Pace()
    number = 0
    while (objects := pace.make(lambda _: reader.next())) is not None:
        number += 1
        document = Document(name if number == 1 else f"{name}: document {number}", reader, objects)
        yield document
        left = weakref.ref(document)
        del document
        kept = left()
        if kept is not None:  # somebody has it still
            kept._keep()
        del kept


def _copied(stream: BinaryIO, name: str) -> Document | None:
    """The next document of a stream, in memory; None: there is none"""
    head = b""
    while len(head) < HEADER and (more := stream.read(HEADER - len(head))):
        head += more
    if not head:
        return None
    left = None  # no header of nsd's: an HDF5 file by itself, or nothing of ours
    if len(head) == HEADER and head[:8] == MAGIC:
        flags, length = struct.unpack("<IQ", head[12:24])
        left = None if flags & UNFINISHED else max(length - HEADER, 0)
    memory = open(os.memfd_create("document", os.MFD_CLOEXEC), "w+b")
    memory.write(head)
    while (left is None or left > 0) and (piece := stream.read(PIECE if left is None else min(PIECE, left))):
        memory.write(piece)
        left = None if left is None else left - len(piece)
    memory.flush()
    if left:
        raise EOFError(f"{name}: a document is cut off")
    return _Filed(b"/proc/self/fd/%d" % memory.fileno(), name, memory)


def documents(source: Source = "-") -> Iterator[Document]:
    """The documents of a file, an open binary stream, or standard input ("-"), as Document.

    Raises Error if a document is damaged or hostile (status 65), OSError if there is no such file, EOFError if a stream ends within a
    document."""
    if isinstance(source, (str, bytes, os.PathLike)) and source != "-":
        path = check.path(source, "source")
        if os.path.isfile(path) and _alone(path):
            yield _Filed(os.path.abspath(path), os.fsdecode(path))
            return
        os.stat(path)  # its OSError
        yield from _passing(os.path.abspath(path), os.fsdecode(path))
        return
    stream: Any = sys.stdin.buffer if isinstance(source, str) else source
    if not callable(getattr(stream, "read", None)):
        raise TypeError(f"source: a path or a stream is needed, not {type(source).__name__}")
    name = "standard input" if isinstance(source, str) else str(getattr(source, "name", "a stream"))
    start = _readable(stream) if isinstance(source, str) else None
    if start is not None:
        yield from _passing(start, name)
        return
    while (document := _copied(stream, name)) is not None:
        yield document
        del document
