"""How drafts of scenes differ, as a change that a loaded scene can take."""
from __future__ import annotations

from typing import Any, Dict, Optional

import numpy

from ._draft import Draft
from ._values import Texture

_ARRAYS = ("vertices", "faces", "normals", "uvs", "uvs1", "colors")
_FIXED = ("emission", "two_sided", "spread", "material", "shadow_catcher", "visible_to_camera")


def change_between(before: Draft, now: Draft) -> Optional[Dict[str, Any]]:
    """What Scene.change() takes to make `now` of a scene of `before`; None if it has to be loaded anew. What is the same object
    in both is not looked at."""
    if before.film != now.film or any(list(getattr(before, kind)) != list(getattr(now, kind)) for kind in ("meshes", "shapes")):
        return None
    if set(before.materials) != set(now.materials) or set(before.cameras) != set(now.cameras):
        return None
    if (now.environment is None and now.sky is None) != (before.environment is None and before.sky is None):
        return None
    change: Dict[str, Any] = {
        "cameras": _different(before.cameras, now.cameras), "materials": _different(before.materials, now.materials),
        "objects": {}, "meshes": {}}
    for name, mesh in now.meshes.items():
        if not _is_followed(before.meshes[name], mesh, name, change):
            return None
    for name, shape in now.shapes.items():
        old, new = ({key: value for key, value in one.items() if key != "transform"} for one in (before.shapes[name], shape))
        if not is_same(old, new):
            return None
        _note_place(before.shapes[name].get("transform"), shape.get("transform"), name, change)
    change = {key: value for key, value in change.items() if value}
    if not is_same(before.lights, now.lights):
        change["lights"] = now.lights
    for key in ("environment", "sky"):
        if getattr(now, key) is not None and not is_same(getattr(before, key), getattr(now, key)):
            change[key] = getattr(now, key)
    return change


def is_same(a: Any, b: Any) -> bool:
    """Whether two values of a draft are equal: numbers, texts, arrays, textures, and lists and dictionaries of these."""
    if a is b:
        return True
    if isinstance(a, numpy.ndarray) or isinstance(b, numpy.ndarray):
        if a is None or b is None:
            return False
        one, other = numpy.asarray(a), numpy.asarray(b)
        return one.dtype == other.dtype and numpy.array_equal(one, other)
    if isinstance(a, Texture) and isinstance(b, Texture):
        return is_same(a.keys, b.keys) and is_same(a.image, b.image)
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(is_same(value, b[key]) for key, value in a.items())
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(is_same(one, other) for one, other in zip(a, b))
    return type(a) is type(b) and bool(a == b)


def _different(before: Dict[str, Any], now: Dict[str, Any]) -> Dict[str, Any]:
    return {name: value for name, value in now.items() if not is_same(before[name], value)}


def _is_followed(before: Dict[str, Any], now: Dict[str, Any], name: str, change: Dict[str, Any]) -> bool:
    """Notes how a mesh differs; False if that cannot be said."""
    if not all(is_same(before[key], now[key]) for key in _FIXED):
        return False
    if not all(is_same(before[key], now[key]) for key in _ARRAYS):
        change["meshes"][name] = {key: now[key] for key in _ARRAYS}
    old, new = before["transforms"], now["transforms"]
    if old is None and new is None:
        _note_place(before["transform"], now["transform"], name, change)
        return True
    if old is None or new is None or len(old) != len(new):
        return False
    moved = {str(i): {"transform": new[i]} for i in range(len(new)) if not is_same(numpy.asarray(old[i]), numpy.asarray(new[i]))}
    if moved:
        change["objects"][name] = {"instances": moved}
    return True


def _note_place(before: Any, now: Any, name: str, change: Dict[str, Any]) -> None:
    if not is_same(before, now):
        change["objects"][name] = {"transform": numpy.eye(4) if now is None else now}
