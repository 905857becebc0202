"""Scenes that stay loaded, and what is rendered of them."""
from __future__ import annotations

import functools
import os
import shutil
import threading
import warnings
import weakref
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterator, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import NDArray

from ._building import Building
from ._camera import Camera, _plain
from ._connection import Connection
from ._draft import Draft, environment_json, mesh_json
from ._errors import Error
from ._following import change_between
from ._image import Image
from ._parts import Materials, Objects
from ._progress import Bar, Progress
from ._shared import SharedArrays
from ._values import Converter, environment_of, merge, object_changes

if TYPE_CHECKING:
    from ._session import Session

# The azimuth and elevation of a camera that nobody has placed [degrees].
_FIRST_LOOK = [35, 20]


class Scene(Building):
    """A scene of a session: from a file, by candela.load(), or built of arrays:

        scene = candela.Scene(size=(640, 480))
        scene.add_material("clay", type="diffuse", reflectance=0.5)
        scene.add_mesh(vertices, faces, name="pot", material="clay")
        scene.environment = 1.0
        image = scene.render(spp=64)

    After a change, only what depends on it is made again. Threads may share it; a picture at a time is rendered.
    """

    def __init__(self, size: Tuple[int, int] = (640, 480), session: Optional[Session] = None, **film: Any) -> None:
        """A scene without anything in it. size: of its pictures, (width, height) in pixels. session: the one of
        candela.Session() that it belongs to; by default the one that all share. film: further keys of the film in scene files,
        such as filter="gaussian"."""
        if session is None:
            from ._session import default_session
            session = default_session()
        self._begin(session._connection)
        self._draft: Optional[Draft] = Draft(size, film)

    @classmethod
    def _of(cls, connection: Connection, description: Dict[str, Any]) -> Scene:
        """A scene that the program has loaded."""
        scene = cls.__new__(cls)
        scene._begin(connection)
        scene._draft = None
        scene._take(description)
        return scene

    def _begin(self, connection: Connection) -> None:
        self._connection = connection
        self._name = ""  # What the program calls it, once it is loaded.
        self._is_stale = False  # It has to be loaded again, with more in it.
        self._edits: Dict[str, Any] = {}  # All changes since the draft was loaded, for the next time.
        self._finalizer: Optional[weakref.finalize[[str, Dict[str, str]], Scene]] = None
        self._folder: Optional[Callable[[], object]] = None
        self._lock = threading.RLock()
        self._description: Optional[Dict[str, Any]] = None  # None: it has to be asked for.
        self._cameras: Dict[str, Camera] = {}
        self._environment: Optional[Dict[str, Any]] = None

    def _take(self, description: Dict[str, Any]) -> None:
        if not self._name:
            self._name = description["scene"]
            self._finalizer = weakref.finalize(self, self._connection.call_later, "close", {"scene": self._name})
        self._is_stale = False
        self._description = description
        self._add_cameras(description["cameras"])
        _warn(description)

    @property
    def _id(self) -> str:
        """What the program calls the scene, which it then has."""
        with self._lock:
            if self._draft is not None and (not self._name or self._is_stale):
                self._load(self._draft)
            return self._name

    def _load(self, draft: Draft) -> None:
        text, arrays = draft.to_text()
        with SharedArrays(arrays) as shared:
            params: Dict[str, Any] = {"text": text, "folder": absolute("."), "arrays": shared}
            if self._name:
                params["scene"] = self._name
            self._take(self._connection.call("load", params))
        edits, self._edits = self._edits, {}
        if edits:
            self.change(**edits)
        if not draft.cameras and "cameras" not in edits:
            looks = self._connection.call("views", {"scene": self._name, "views": [_FIRST_LOOK], "size": list(draft.size)})
            self.change(cameras={"main": looks["cameras"][0]})
            self._edits.pop("cameras")  # It follows what is added.

    def _call(self, method: str, **params: Any) -> Dict[str, Any]:
        with self._lock:
            return self._connection.call(method, {"scene": self._id, **params})

    def _describe(self) -> Dict[str, Any]:
        with self._lock:
            name = self._id
            if self._description is None:
                self._description = self._connection.call("scene", {"scene": name})
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
        with self._lock:
            self._describe()
            return dict(self._cameras)

    @property
    def camera(self) -> Camera:
        """The default camera. Set its attributes, or set another one in its place."""
        return next(iter(self.cameras.values()))

    @camera.setter
    def camera(self, camera: Camera) -> None:
        if self._draft is not None and not self._name and not self._draft.cameras:
            self.add_camera(camera)
            return
        self.change(cameras={next(iter(self.cameras)): camera.to_dict()})

    @property
    def materials(self) -> Materials:
        """The materials by name: scene.materials["clay"].reflectance = 0.2."""
        return Materials(self)

    @property
    def objects(self) -> Objects:
        """The objects by name: scene.objects["pot"].transform = matrix."""
        return Objects(self)

    @property
    def environment(self) -> Optional[Dict[str, Any]]:
        """The light from infinitely far away, as it was set: keys of docs/scene-format.md; None if there is none, and {} if it
        is that of a file. Set it to such keys; or to its radiance, a number or (3,); or to a map of (H, W, 3), or its file."""
        with self._lock:
            if self._environment is not None:
                return dict(self._environment)
            return {} if self._describe()["environment"] else None

    @environment.setter
    def environment(self, value: Any) -> None:
        keys = environment_of(value)
        with self._lock:
            if self._draft is not None and not self._name:
                self._draft.environment, self._draft.sky = keys, None
            else:
                self.change(environment=keys)
            self._environment = keys

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
               objects: Optional[Dict[str, Any]] = None, environment: Any = None, sky: Any = None,
               meshes: Optional[Dict[str, Any]] = None, lights: Optional[Sequence[Dict[str, Any]]] = None) -> None:
        """Replaces cameras, materials, the environment, the sky, or all lights without a surface, in the syntax of scene files
        (docs/scene-format.md); a material without a type keeps its other values. objects: by name, with "transform", "visible",
        or the "instances" that have them, by their numbers. meshes: by the name of their object, what add_mesh() takes:
        vertices, faces, normals, uvs, uvs1, colors. If it fails, the scene is as before."""
        given = {"cameras": cameras, "materials": materials, "objects": objects, "environment": environment, "sky": sky,
                 "meshes": meshes, "lights": lights}
        change = {key: value for key, value in given.items() if value is not None}
        if objects is not None:
            change["objects"] = object_changes(objects)
        convert = Converter()
        converted = {key: environment_json(convert, value) if key == "environment"
                     else {name: mesh_json(convert, name, mesh) for name, mesh in value.items()} if key == "meshes"
                     else _plain(value) if key == "cameras" else convert(value, key) for key, value in change.items()}
        with self._lock, SharedArrays(convert.arrays) as shared:
            params = {"scene": self._id, "change": converted}
            _warn(self._connection.call("set", {**params, "arrays": shared} if shared else params))
            if objects is not None or meshes is not None or lights is not None:
                self._description = None
            if self._draft is not None:
                merge(self._edits, change)
            self._add_cameras(converted.get("cameras", {}))

    def _follow(self, draft: Draft) -> None:
        """Makes the scene, which was built of arrays, that of another draft: by a change, if one can say how they differ;
        otherwise it is loaded anew. Drafts and their arrays must stay as they are."""
        with self._lock:
            change = None
            if self._draft is not None and self._name and not self._is_stale and not self._edits:
                change = change_between(self._draft, draft)
            try:
                if change:
                    self.change(**change)
            except Error as error:
                if not self._connection.is_open or error.kind == "cancelled":
                    raise
                change = None  # Such as a material that wants other meshes.
            self._draft, self._edits = draft, {}
            self._is_stale = self._is_stale or change is None
            self._id  # noqa: B018  (It is loaded now.)

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
               time_limit: Optional[float] = None, timeout: Optional[float] = None,
               layers: Union[str, Sequence[str]] = "all", transparent: bool = False, denoise: Optional[str] = None,
               **options: Any) -> Image:
        """Renders a picture. What is not given is what the scene proposes. If this is interrupted, image() is the picture
        so far, and the same call goes on to the same bits.

        spp: samples per pixel. size: (width, height) in pixels. camera: a name, or a Camera. crop: (x0, y0, x1, y1), only
        these pixels; x1 and y1 are exclusive. seed: each gives different noise. progress: True shows a bar, by tqdm if
        that is installed; or a function that gets the fraction that is done. target_error: ends at this estimated
        relative error. time_limit: ends after these seconds, with the picture so far. timeout: raises Error after these
        seconds. layers: names, or "all" but the ids, which take longer: object_id, instance_id, material_id.
        transparent: before nothing instead of the sky. denoise: "oidn" (Open Image Denoise), "variance" (candela itself), or
        "auto", the first of them that is there; the image then has `denoised`, too, which save() shows. Further options are those of docs/protocol.md: estimator, sampler, max_depth.
        """
        given = {"spp": spp, "size": size, "crop": crop, "seed": seed, "target_error": target_error,
                 "time_limit": time_limit, "camera": self._name_of(camera),
                 "layers": layers if isinstance(layers, str) else list(layers),
                 "background": "transparent" if transparent else None, "progress": bool(progress) or None,
                 "denoise": denoise is not None or None, **options}
        params = {key: _plain(value) for key, value in given.items() if value is not None}
        with self._lock, Bar(progress) as bar:
            outcome = self._connection.call("render", {"scene": self._id, **params}, bar, timeout)
            _warn(outcome)
            if outcome["complete"]:
                bar.finish()
            return self.image(denoise)

    def image(self, denoise: Optional[str] = None) -> Image:
        """The picture that was rendered last, as far as it has got. denoise: see render()."""
        with self._lock:
            params = {"scene": self._id} if denoise is None else {"scene": self._id, "denoise": denoise}
            return Image(self._connection, self._connection.call("image", params))

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
        known = [name for name, ours in self.cameras.items() if ours is camera]
        return known[0] if known else camera.to_dict()

    def keep(self, folder: str) -> None:
        """Removes the folder with the scene, whose poses may read it."""
        self._folder = weakref.finalize(self, shutil.rmtree, folder, True)

    def close(self) -> None:
        """Frees the scene, as it is when nothing uses it any more."""
        if self._finalizer is not None and self._finalizer.detach() and self._connection.is_open:
            self._connection.call("close", {"scene": self._name})
        if self._folder is not None:
            self._folder()

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._draft is not None and (not self._name or self._is_stale):
            return f"<candela.Scene of {len(self._draft.meshes) + len(self._draft.shapes)} objects, not loaded yet>"
        return f"<candela.Scene {self._name}: {len(self.objects)} objects, cameras {', '.join(self._cameras)}>"


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
