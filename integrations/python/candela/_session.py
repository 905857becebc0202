"""Sessions: running programs."""
from __future__ import annotations

import atexit
import json
import os
import shutil
import tempfile
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence, Union

from ._connection import Connection
from ._errors import Error
from ._scene import Scene, absolute

Source = Union[str, "os.PathLike[str]", bytes, Dict[str, Any]]


@dataclass(frozen=True)
class Device:
    """A Vulkan device. `reason` says why it cannot be used, if it cannot."""

    index: int
    name: str
    type: str
    driver: str
    usable: bool
    default: bool
    reason: str
    memory_bytes: int


class Session:
    """A running program, with scenes of its own. Most users need none: candela.load() uses one for all.

    device: index or a part of the name; by default the best. memory_limit: such as "4GiB", for all scenes together; by
    default three quarters of the machine's.
    """

    def __init__(self, device: Union[int, str, None] = None, memory_limit: Optional[str] = None) -> None:
        options = [] if device is None else ["--device", str(device)]
        options += [] if memory_limit is None else ["--memory-limit", memory_limit]
        self._connection = Connection(options)

    def load(self, source: Source, *, folder: Union[str, os.PathLike[str], None] = None,
             folders: Sequence[Union[str, os.PathLike[str]]] = (), time: Optional[float] = None,
             animation: Optional[str] = None, timeout: Optional[float] = None) -> Scene:
        """A scene from a file, the bytes of a file (.glb, .ply, or a scene in JSON), or a dictionary as in scene files.

        folder: where the files are that a dictionary names; by default the working folder. folders: further folders
        from which files may be read. time, animation: see Scene.pose(). timeout: raises Error after these seconds.
        """
        params: Dict[str, Any] = {"folders": [absolute(path) for path in folders]}
        if time is not None:
            params["time"] = float(time)
        if animation is not None:
            params["animation"] = animation
        if isinstance(source, dict):
            return self._load({**params, "text": json.dumps(source), "folder": absolute(folder or ".")}, timeout)
        if not isinstance(source, bytes):
            return self._load({**params, "file": absolute(source)}, timeout)
        temporary = tempfile.mkdtemp(prefix="candela-")
        try:
            file = Path(temporary) / "scene"
            file.write_bytes(source)
            scene = self._load({**params, "file": str(file)}, timeout)
        except BaseException:
            shutil.rmtree(temporary, ignore_errors=True)
            raise
        scene.keep(temporary)
        return scene

    def _load(self, params: Dict[str, Any], timeout: Optional[float]) -> Scene:
        return Scene._of(self._connection, self._connection.call("load", params, timeout=timeout))

    def devices(self) -> List[Device]:
        """All Vulkan devices."""
        found = self._connection.call("devices", {})["devices"]
        return [Device(**{key: device[key] for key in Device.__dataclass_fields__}) for device in found]

    def close(self) -> None:
        """Ends the program, whatever it does."""
        self._connection.close()

    @property
    def is_open(self) -> bool:
        """Whether the program still runs."""
        return self._connection.is_open

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


_default: Optional[Session] = None
_lock = threading.Lock()


def default_session() -> Session:
    """The session of this process, which begins when it is first needed, and again after it has ended."""
    global _default
    with _lock:
        if _default is None or not _default.is_open:
            _default = Session()
        return _default


def _close_default() -> None:
    if _default is not None and _default.is_open:
        _default.close()


def _forget_default() -> None:
    global _default, _lock
    _default = None
    _lock = threading.Lock()


atexit.register(_close_default)
os.register_at_fork(after_in_child=_forget_default)


def load(source: Source, **options: Any) -> Scene:
    """Session.load() of a session that all share."""
    return default_session().load(source, **options)


def devices() -> List[Device]:
    """All Vulkan devices."""
    return default_session().devices()


__all__ = ["Device", "Error", "Session", "default_session", "devices", "load"]
