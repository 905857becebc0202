"""Arrays on their way to the program, in memory that both share."""
from __future__ import annotations

import errno
import fcntl
import mmap
import os
import secrets
import tempfile
from types import TracebackType
from typing import Any, Dict, Optional, Tuple, Type

import numpy
from numpy.typing import NDArray

from ._errors import Error

# So many bytes apart, arrays are where any machine reads them fast.
ALIGNMENT = 64

_KINDS = {"b1": "uint8", "i1": "int32", "i2": "int32", "u4": "uint32", "i4": "int32", "u8": "int64", "i8": "int64",
          "u1": "uint8", "u2": "uint16", "f2": "float16", "f4": "float32", "f8": "float64"}


def type_of(array: NDArray[Any], name: str) -> numpy.dtype[Any]:
    """The type that the program gets: the array's own where the program knows it."""
    kind = _KINDS.get(f"{array.dtype.kind}{array.dtype.itemsize}")
    if kind is None:
        raise Error(f"{name}: expected an array of numbers, found one of the type {array.dtype}; use float32, int64 or uint8",
                    "usage", 2)
    return numpy.dtype(kind)


class SharedArrays:
    """Copies arrays into a file in memory, or else among the temporary files, as long as the program reads it:

        with SharedArrays({"a": array}) as described:
            ...  # What the protocol calls "arrays".
    """

    def __init__(self, arrays: Dict[str, Tuple[NDArray[Any], Optional[str]]]) -> None:
        """arrays: by name, each with the type to convert it to, if it is not to stay as it is."""
        self._places: Dict[str, Tuple[NDArray[Any], numpy.dtype[Any], int]] = {}
        self._size = 0
        self._path = ""
        self._file = -1
        for name, (array, wanted) in arrays.items():
            kind = type_of(array, name) if wanted is None else numpy.dtype(wanted)
            self._places[name] = (array, kind, self._size)
            self._size += -(-array.size * kind.itemsize // ALIGNMENT) * ALIGNMENT

    def __enter__(self) -> Dict[str, Any]:
        if not self._places:
            return {}
        try:
            self._make_file()
            if self._size > 0:
                self._fill()
        except BaseException:
            self._remove()
            raise
        return {name: {"file": self._path, "offset": offset, "type": kind.name, "shape": list(array.shape)}
                for name, (array, kind, offset) in self._places.items()}

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self._remove()

    def _make_file(self) -> None:
        for folder in ("/dev/shm", tempfile.gettempdir()):
            try:
                self._path, self._file = _new_file(folder)
                if self._size > 0:
                    os.posix_fallocate(self._file, 0, self._size)
                return
            except OSError:
                self._remove()
        raise Error(f"cannot share {self._size} bytes of memory with the program: neither /dev/shm nor the folder of temporary "
                    "files has the room; make some, or name another folder (TMPDIR)", "out_of_memory", 5)

    def _fill(self) -> None:
        with mmap.mmap(self._file, self._size) as memory:
            for array, kind, offset in self._places.values():
                target: Optional[NDArray[Any]] = numpy.frombuffer(memory, kind, array.size, offset).reshape(array.shape)
                assert target is not None
                with numpy.errstate(over="ignore"):
                    numpy.copyto(target, array, casting="unsafe")
                target = None  # The memory cannot be closed before.

    def _remove(self) -> None:
        if self._path:
            try:
                os.unlink(self._path)
            except OSError:
                pass
            self._path = ""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1


def _new_file(folder: str) -> Tuple[str, int]:
    """A new file for this user alone. It is locked as long as this process lives: who finds it without a lock removes it."""
    while True:
        path = os.path.join(folder, f"candela-shared-{os.getpid()}-{secrets.token_hex(12)}")
        file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC | os.O_NOFOLLOW, 0o600)
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if os.fstat(file).st_nlink > 0:
                return path, file
        except OSError as error:
            if error.errno not in (errno.EAGAIN, errno.EACCES):
                os.close(file)
                os.unlink(path)
                raise
        os.close(file)
