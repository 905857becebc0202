"""Scenes that are built from arrays, before the program has them."""
from __future__ import annotations

import json
from typing import Any, Dict, List, Optional, Tuple

import numpy

from ._camera import _plain
from ._errors import Error
from ._values import AnyArray, Converter, environment_of, steps_of

# What stands in for a camera until one is placed around the scene.
_PLACEHOLDER = {"position": [0, 0, 1], "look_at": [0, 0, 0], "vertical_fov": 40}


class Draft:
    """The parts of a scene file, some of them arrays."""

    def __init__(self, size: Tuple[int, int], film: Optional[Dict[str, Any]] = None) -> None:
        self.film = {**(film or {}), "size": list(size)}
        self.size = size
        self.cameras: Dict[str, Any] = {}
        self.materials: Dict[str, Any] = {}
        self.meshes: Dict[str, Dict[str, Any]] = {}
        self.shapes: Dict[str, Dict[str, Any]] = {}
        self.lights: List[Dict[str, Any]] = []
        self.environment: Optional[Dict[str, Any]] = None
        self.sky: Optional[Dict[str, Any]] = None

    def free_name(self, name: Optional[str], kind: str) -> str:
        """The name of a new object."""
        taken = {**self.meshes, **self.shapes}
        if name is None:
            number = len(taken)
            while f"{kind} {number}" in taken:
                number += 1
            return f"{kind} {number}"
        if name in taken:
            raise Error(f"there is an object {name!r} already; choose another name", "usage", 2)
        return name

    def to_text(self) -> Tuple[str, Dict[str, Tuple[AnyArray, Optional[str]]]]:
        """The scene in JSON, and the arrays that it names."""
        convert = Converter()
        scene: Dict[str, Any] = {"film": self.film,
                                 "cameras": _plain(self.cameras or {"main": _PLACEHOLDER}),
                                 "materials": convert(self.materials, "materials"),
                                 "lights": _plain(self.lights), "objects": {}, "shapes": []}
        for name, mesh in self.meshes.items():
            shape = _mesh(convert, name, mesh)
            if mesh["transforms"] is None:
                scene["shapes"].append({"name": name, **shape, **_placed(mesh["transform"], name)})
                continue
            scene["objects"][name] = [shape]
            matrices = numpy.asarray(mesh["transforms"])
            scene["shapes"].append({"type": "instance", "name": name, "object": name,
                                    "transforms": convert.array(matrices, f"{name}.transforms", (None, 4, 4))})
        for name, shape in self.shapes.items():
            keys = {key: convert(value, f"{name}.{key}") if key == "emission" else _plain(value)
                    for key, value in shape.items() if key != "transform"}
            scene["shapes"].append({"name": name, **keys, **_placed(shape.get("transform"), name)})
        if self.sky is not None:
            scene["sky"] = convert(self.sky, "sky")
        elif self.environment is not None:
            scene["environment"] = environment_json(convert, self.environment)
        return json.dumps(scene), convert.arrays


def environment_json(convert: Converter, value: Any) -> Dict[str, Any]:
    """The environment, whose radiance may be a map of (H, W, 3) numbers."""
    keys = dict(environment_of(value))
    radiance = keys.get("radiance")
    if isinstance(radiance, numpy.ndarray) and radiance.ndim > 1:
        keys["radiance"] = convert.array(radiance, "environment", (None, None, 3))
    converted: Dict[str, Any] = convert(keys, "environment")
    return converted


def mesh_json(convert: Converter, name: str, mesh: Dict[str, Any]) -> Dict[str, Any]:
    """The triangles of a mesh, and what their corners have, as arrays by reference."""
    if mesh.get("vertices") is None or mesh.get("faces") is None:
        raise Error(f"{name}: a mesh needs vertices and faces", "usage", 2)
    keys: Dict[str, Any] = {"positions": convert.array(mesh["vertices"], f"{name}.vertices", (None, 3)),
                            "triangles": convert.array(_indices(mesh["faces"], name), f"{name}.faces", (None, 3))}
    for key, columns in (("normals", 3), ("uvs", 2), ("uvs1", 2)):
        if mesh.get(key) is not None:
            keys[key] = convert.array(mesh[key], f"{name}.{key}", (None, columns))
    if mesh.get("colors") is not None:
        colors = numpy.asarray(mesh["colors"])
        if colors.dtype.kind not in "f":
            raise Error(f"{name}.colors: expected linear floats from 0 to 1, found {colors.dtype}; divide them by their range",
                        "usage", 2)
        keys["colors"] = convert.array(colors, f"{name}.colors", (None, 4 if colors.shape[-1:] == (4,) else 3))
    return keys


def _mesh(convert: Converter, name: str, mesh: Dict[str, Any]) -> Dict[str, Any]:
    shape = {"type": "mesh", **mesh_json(convert, name, mesh)}
    for key in ("material", "emission", "two_sided", "spread", "shadow_catcher", "visible_to_camera"):
        if mesh[key] is not None:
            shape[key] = convert(mesh[key], f"{name}.{key}")
    return shape


def _indices(faces: Any, name: str) -> AnyArray:
    array = numpy.asarray(faces)
    if array.dtype.kind not in "ui":
        raise Error(f"{name}.faces: expected indices, of an integer type, found {array.dtype}; use int64", "usage", 2)
    return array


def _placed(transform: Any, name: str) -> Dict[str, Any]:
    return {} if transform is None else {"transform": steps_of(transform, f"{name}.transform")}
