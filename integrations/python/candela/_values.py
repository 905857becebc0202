"""What Python has, as values of scene files."""
from __future__ import annotations

import os
from typing import Any, Dict, Optional, Tuple, Union

import numpy
from numpy.typing import NDArray

from ._errors import Error

AnyArray = NDArray[Any]


class Texture:
    """An image for a value of a material, such as Scene.add_material(..., reflectance=Texture(...)).

    image: (H, W), (H, W, 1) to (H, W, 4), rows from the top; uint8 and uint16 stand for 0 to 1, floats for themselves; or
    the path of an image file. factor: what it is multiplied by. encoding: "srgb" or "linear"; by default "srgb" for colours
    that are not floats. wrap: "repeat", "mirror" or "clamp". filter: "bilinear" or "nearest". Further keys are those of
    textures in docs/scene-format.md, such as channel, uv_set, uv_scale, and the scale of a normal map.
    """

    def __init__(self, image: Union[AnyArray, str, os.PathLike[str]], **keys: Any) -> None:
        self.image = image
        self.keys = keys


class Converter:
    """Turns values into what JSON can hold, and collects the arrays among them."""

    def __init__(self) -> None:
        self.arrays: Dict[str, Tuple[AnyArray, Optional[str]]] = {}

    def __call__(self, value: Any, name: str = "array") -> Any:
        """name: what messages call an array."""
        if isinstance(value, Texture):
            return {"image": self._image(value.image, name), **{key: self(part, name) for key, part in value.keys.items()}}
        if isinstance(value, numpy.ndarray) and value.ndim >= 2:
            return {"image": self._image(value, name)}
        if isinstance(value, (numpy.ndarray, numpy.generic)):
            return value.tolist()
        if isinstance(value, (list, tuple)):
            return [self(element, name) for element in value]
        if isinstance(value, dict):
            return {key: self(element, f"{name}.{key}") for key, element in value.items()}
        if isinstance(value, os.PathLike):
            return os.fspath(value)
        return value

    def array(self, value: Any, name: str, shape: Tuple[Optional[int], ...], kind: Optional[str] = None) -> Dict[str, str]:
        """An array by reference. shape: None is any length. kind: the type that the program gets, if not the array's own."""
        array = numpy.asarray(value)
        if array.ndim != len(shape) or any(side not in (None, found) for side, found in zip(shape, array.shape)):
            wanted = " x ".join("N" if side is None else str(side) for side in shape)
            found = " x ".join(map(str, array.shape)) or "a number"
            raise Error(f"{name}: expected an array of {wanted} numbers, found {found}", "usage", 2)
        return self._add(array, name, kind)

    def _add(self, array: AnyArray, name: str, kind: Optional[str]) -> Dict[str, str]:
        if array.dtype.kind not in "buif":
            raise Error(f"{name}: expected an array of numbers, found one of the type {array.dtype}; convert it", "usage", 2)
        unique, number = name, 2
        while unique in self.arrays:
            unique, number = f"{name} {number}", number + 1
        self.arrays[unique] = (array, kind)
        return {"array": unique}

    def _image(self, image: Union[AnyArray, str, os.PathLike[str]], name: str) -> Any:
        if not isinstance(image, numpy.ndarray):
            return os.path.abspath(image)
        if image.dtype.kind == "f":
            return self._add(image, name, "float16")
        if image.dtype not in (numpy.uint8, numpy.uint16):
            raise Error(f"{name}: an image is an array of uint8, uint16 or floats, not of {image.dtype}; convert it", "usage", 2)
        return self._add(image, name, None)


def steps_of(transform: Any, name: str) -> Any:
    """The transform of a scene file: a (4, 4) matrix, or the steps themselves."""
    if isinstance(transform, (list, tuple)) and all(isinstance(step, dict) for step in transform):
        return list(transform)
    matrix = numpy.asarray(transform, numpy.float64)
    if matrix.shape != (4, 4):
        raise Error(f"{name}: expected a matrix of 4 x 4 numbers, found {' x '.join(map(str, matrix.shape)) or 'a number'}",
                    "usage", 2)
    return [{"matrix": matrix.ravel().tolist()}]


def object_changes(objects: Dict[str, Any]) -> Dict[str, Any]:
    """The same with transforms as in scene files."""
    changes = {}
    for name, change in objects.items():
        changes[name] = dict(change)
        if "transform" in change:
            changes[name]["transform"] = steps_of(change["transform"], f"the transform of {name!r}")
        if "instances" in change:
            changes[name]["instances"] = object_changes({str(key): one for key, one in change["instances"].items()})
    return changes


def environment_of(value: Any) -> Dict[str, Any]:
    """The environment of a scene file: its keys, or radiance, or an image or its file."""
    if isinstance(value, dict):
        return value
    if isinstance(value, (str, os.PathLike)):
        return {"file": os.path.abspath(value)}
    return {"radiance": value}


def merge(edits: Dict[str, Any], later: Dict[str, Any]) -> None:
    """Adds a change to those before it, as Scene.change() takes them."""
    for kind, change in later.items():
        if kind in ("environment", "sky"):
            edits.pop("environment", None)
            edits.pop("sky", None)
            edits[kind] = change
            continue
        if kind == "lights":
            edits[kind] = change
            continue
        known = edits.setdefault(kind, {})
        for name, value in change.items():
            replaces = kind in ("cameras", "meshes") or (kind == "materials" and "type" in value)
            known[name] = dict(value) if replaces else _merged(known.get(name, {}), value)


def _merged(before: Dict[str, Any], later: Dict[str, Any]) -> Dict[str, Any]:
    merged = {**before, **later}
    if "instances" in before and "instances" in later:
        merged["instances"] = dict(before["instances"])
        for number, value in later["instances"].items():
            merged["instances"][number] = {**merged["instances"].get(number, {}), **value}
    return merged
