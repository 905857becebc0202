"""Scenes that stay loaded, and what is rendered of them."""
from __future__ import annotations

import functools
import importlib
import os
import shutil
import threading
import warnings
import weakref
from typing import Any, Callable, Dict, Iterator, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import NDArray

from candela._camera import Camera, _plain
from candela._connection import Connection
from candela._image import Image

Progress = Union[bool, Callable[[float], None], None]


class Scene:
    """A scene of a session, by candela.load(). After a change, only what depends on it is made again. Threads may share
    it; a picture at a time is rendered."""

    def __init__(self, connection: Connection, description: Dict[str, Any]) -> None:
        self._connection = connection
        self._id: str = description["scene"]
        self._finalizer = weakref.finalize(self, connection.call_later, "close", {"scene": self._id})
        self._folder: Optional[Callable[[], object]] = None
        self._lock = threading.RLock()
        self._description: Optional[Dict[str, Any]] = description  # None: it has to be asked for.
        self._cameras: Dict[str, Camera] = {}
        self._add_cameras(description["cameras"])
        _warn(description)

    def _describe(self) -> Dict[str, Any]:
        with self._lock:
            if self._description is None:
                self._description = self._connection.call("scene", {"scene": self._id})
            return self._description

    def _add_cameras(self, cameras: Dict[str, Any]) -> None:
        """Takes over what the scene's cameras are now. Cameras that the user holds stay those of the scene."""
        for name, keys in cameras.items():
            if name in self._cameras:
                self._cameras[name]._keys = dict(keys)
            else:
                self._cameras[name] = Camera._of(keys, functools.partial(_change_camera, weakref.ref(self), name))

    @property
    def cameras(self) -> Dict[str, Camera]:
        """The cameras by name, the default first."""
        return dict(self._cameras)

    @property
    def camera(self) -> Camera:
        """The default camera. Set its attributes, or set another one in its place."""
        return next(iter(self._cameras.values()))

    @camera.setter
    def camera(self, camera: Camera) -> None:
        name = next(iter(self._cameras))
        self.change(cameras={name: camera.to_dict()})

    @property
    def materials(self) -> Tuple[str, ...]:
        """The names of the materials."""
        return tuple(self._describe()["materials"])

    @property
    def objects(self) -> Tuple[str, ...]:
        """The names of the objects."""
        return tuple(self._describe()["objects"])

    @property
    def lights(self) -> Tuple[str, ...]:
        """The names of the point, spot and directional lights."""
        return tuple(self._describe()["lights"])

    @property
    def bounds(self) -> Optional[NDArray[numpy.float64]]:
        """(2, 3): the least and the greatest coordinates of the scene [m]; None if it shows nothing."""
        box = self._describe()["bounds"]
        return None if box is None else numpy.array(box, numpy.float64)

    @property
    def size(self) -> Tuple[int, int]:
        """The (width, height) of a picture that does not say otherwise."""
        width, height = self._describe()["size"]
        return width, height

    def change(self, *, cameras: Optional[Dict[str, Any]] = None, materials: Optional[Dict[str, Any]] = None,
               environment: Any = None, sky: Any = None) -> None:
        """Replaces cameras, materials, the environment or the sky, in the syntax of scene files (docs/scene-format.md).
        If it fails, the scene is as before."""
        given = {"cameras": cameras, "materials": materials, "environment": environment, "sky": sky}
        change = {key: _plain(value) for key, value in given.items() if value is not None}
        with self._lock:
            _warn(self._connection.call("set", {"scene": self._id, "change": change}))
            self._add_cameras(change.get("cameras", {}))

    def pose(self, time: Optional[float], animation: Optional[str] = None) -> None:
        """Shows a glTF scene at that time [s] of its animation with that name or index (by default the first); None: as
        the file has it at rest."""
        params: Dict[str, Any] = {"time": time} if animation is None else {"time": time, "animation": animation}
        with self._lock:
            _warn(self._connection.call("set", {"scene": self._id, **params}))
            self._description = None

    def render(self, spp: Optional[int] = None, size: Optional[Tuple[int, int]] = None,
               camera: Union[str, Camera, None] = None, crop: Optional[Tuple[int, int, int, int]] = None,
               seed: Optional[int] = None, progress: Progress = None, *, target_error: Optional[float] = None,
               time_limit: Optional[float] = None, layers: Union[str, Sequence[str]] = "all", transparent: bool = False,
               **options: Any) -> Image:
        """Renders a picture. What is not given is what the scene proposes. If this is interrupted, image() is the picture
        so far, and the same call goes on to the same bits.

        spp: samples per pixel. size: (width, height) in pixels. camera: a name, or a Camera. crop: (x0, y0, x1, y1), only
        these pixels; x1 and y1 are exclusive. seed: each gives different noise. progress: True shows a bar, by tqdm if
        that is installed; or a function that gets the fraction that is done. target_error: ends at this estimated
        relative error. time_limit: ends after these seconds. layers: names, or "all". transparent: before nothing
        instead of the sky. Further options are those of docs/protocol.md: estimator, sampler, max_depth.
        """
        given = {"spp": spp, "size": size, "crop": crop, "seed": seed, "target_error": target_error,
                 "time_limit": time_limit, "camera": self._name_of(camera), "layers": layers if isinstance(layers, str) else list(layers),
                 "background": "transparent" if transparent else None, "progress": bool(progress) or None, **options}
        params = {key: _plain(value) for key, value in given.items() if value is not None}
        with self._lock, _Bar(progress) as bar:
            outcome = self._connection.call("render", {"scene": self._id, **params}, bar)
            _warn(outcome)
            if outcome["complete"]:
                bar.finish()
            return self.image()

    def image(self) -> Image:
        """The picture that was rendered last, as far as it has got."""
        with self._lock:
            return Image(self._connection, self._connection.call("image", {"scene": self._id}))

    def accumulate(self, spp: Optional[int] = None, **options: Any) -> Iterator[Image]:
        """Pictures of 1, 2, 4, ... and at last `spp` samples per pixel, each of which goes on from the one before."""
        end = self._describe()["spp"] if spp is None else spp
        now = 1
        while now < end:
            yield self.render(spp=now, **options)
            now *= 2
        yield self.render(spp=end, **options)

    def views(self, directions: Sequence[Tuple[float, float]], *, vertical_fov: Optional[float] = None,
              margin: Optional[float] = None, **options: Any) -> Iterator[Image]:
        """Pictures from (azimuth, elevation) [degrees], each of all that the scene shows: azimuth 0 is the side of +Z, 90
        that of +X. margin: the share of the picture's shorter side to leave free. options: those of render()."""
        return self._around({"views": [list(direction) for direction in directions]}, vertical_fov, margin, options)

    def turntable(self, count: int, elevation: float = 20.0, *, vertical_fov: Optional[float] = None,
                  margin: Optional[float] = None, **options: Any) -> Iterator[Image]:
        """Pictures from `count` even azimuths, at one elevation [degrees]; see views()."""
        return self._around({"turntable": count, "elevation": elevation}, vertical_fov, margin, options)

    def dome(self, count: int, *, vertical_fov: Optional[float] = None, margin: Optional[float] = None,
             **options: Any) -> Iterator[Image]:
        """Pictures from `count` directions that are spread evenly over the upper half sphere; see views()."""
        return self._around({"dome": count}, vertical_fov, margin, options)

    def _around(self, which: Dict[str, Any], vertical_fov: Optional[float], margin: Optional[float],
                options: Dict[str, Any]) -> Iterator[Image]:
        given = {"size": options.get("size"), "vertical_fov": vertical_fov, "margin": margin, **which}
        params = {key: _plain(value) for key, value in given.items() if value is not None}
        for keys in self._connection.call("views", {"scene": self._id, **params})["cameras"]:
            yield self.render(camera=Camera._of(keys), **options)

    def _name_of(self, camera: Union[str, Camera, None]) -> Union[str, Dict[str, Any], None]:
        if not isinstance(camera, Camera):
            return camera
        known = [name for name, ours in self._cameras.items() if ours is camera]
        return known[0] if known else camera.to_dict()

    def keep(self, folder: str) -> None:
        """Removes the folder with the scene, whose poses may read it."""
        self._folder = weakref.finalize(self, shutil.rmtree, folder, True)

    def close(self) -> None:
        """Frees the scene, as it is when nothing uses it any more."""
        if self._finalizer.detach() and self._connection.is_open:
            self._connection.call("close", {"scene": self._id})
        if self._folder is not None:
            self._folder()

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<candela.Scene {self._id}: {len(self.objects)} objects, cameras {', '.join(self._cameras)}>"


class _Bar:
    """Shows progress as the caller wants it."""

    def __init__(self, progress: Progress) -> None:
        self._tell = progress if callable(progress) else None
        self._bar: Any = None
        self._done = 0.0
        if progress is True:
            try:
                self._bar = importlib.import_module("tqdm.auto").tqdm(total=100, unit="%", leave=False)
            except ImportError:
                pass

    def __enter__(self) -> _Bar:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def finish(self) -> None:
        """The program reports often, but not every step."""
        if self._done < 1.0:
            self({"done": 1.0})

    def __call__(self, told: Dict[str, Any]) -> None:
        self._done = told["done"]
        if self._tell is not None:
            self._tell(told["done"])
        if self._bar is not None:
            self._bar.update(100.0 * told["done"] - self._bar.n)


def _change_camera(scene: weakref.ref[Scene], name: str, keys: Dict[str, Any]) -> None:
    """Changes a camera of a scene that is still used: cameras alone do not keep it."""
    known = scene()
    if known is not None:
        known.change(cameras={name: keys})


def _warn(result: Dict[str, Any]) -> None:
    for warning in result.get("warnings", ()):
        warnings.warn(warning, stacklevel=4)


def absolute(path: Union[str, os.PathLike[str]]) -> str:
    """The path for a program that may have another working folder."""
    return os.path.abspath(path)
