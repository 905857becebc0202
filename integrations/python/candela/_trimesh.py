"""Meshes of the package trimesh."""
from __future__ import annotations

from typing import Any, Dict, Optional, Tuple

import numpy

from ._scene import Scene
from ._values import AnyArray, Texture

_OPAQUE, _MASK = "OPAQUE", "MASK"


def from_trimesh(mesh: Any, size: Tuple[int, int] = (640, 480), session: Any = None) -> Scene:
    """A scene of a trimesh.Trimesh, or of a trimesh.Scene with all of its nodes, in a light from everywhere.

    Vertex and face colours, which are those of a screen (sRGB), PBR and simple materials with their textures, and texture
    coordinates are used. A camera sees all; set scene.camera and scene.environment for others.
    """
    scene = Scene(size, session)
    scene.environment = 1.0
    names: Dict[int, str] = {}  # Of materials, by the identity of the mesh that brought them.
    if not hasattr(mesh, "geometry"):
        _add(scene, mesh, "mesh", None, names)
        return scene
    places: Dict[str, Any] = {}
    for node in mesh.graph.nodes_geometry:
        transform, geometry = mesh.graph[node]
        places.setdefault(geometry, []).append(numpy.asarray(transform, numpy.float64))
    for geometry, transforms in places.items():
        if hasattr(mesh.geometry[geometry], "faces"):
            _add(scene, mesh.geometry[geometry], str(geometry), transforms, names)
    return scene


def _add(scene: Scene, mesh: Any, name: str, transforms: Optional[Any], names: Dict[int, str]) -> None:
    vertices, faces = numpy.asarray(mesh.vertices), numpy.asarray(mesh.faces)
    visual: Any = getattr(mesh, "visual", None)
    kind = getattr(visual, "kind", None)
    arrays: Dict[str, Any] = {}
    if kind == "vertex":
        arrays["colors"] = _linear(visual.vertex_colors)
    elif kind == "face":
        vertices, colors = vertices[faces].reshape(-1, 3), numpy.repeat(_linear(visual.face_colors), 3, axis=0)
        arrays["colors"], faces = colors, numpy.arange(len(vertices)).reshape(-1, 3)
    elif kind == "texture" and visual.uv is not None:
        arrays["uvs"] = numpy.asarray(visual.uv)
    material = f"{name} material"
    scene.add_material(material, **_values(visual if kind == "texture" else None, "uvs" in arrays,
                                           "colors" in arrays))
    placed = {"transform": transforms[0]} if transforms is not None and len(transforms) == 1 else {"transforms": transforms}
    scene.add_mesh(vertices, faces, name=name, material=material, **arrays, **placed)


def _values(visual: Any, has_uvs: bool, has_colors: bool) -> Dict[str, Any]:
    """The values of a principled material."""
    if has_colors:
        return {"base_color": 1.0, "roughness": 1.0, "specular": 0.0, "vertex_colors": True}
    if visual is None:
        return {"base_color": 0.5, "roughness": 1.0, "specular": 0.0}
    pbr = visual.material
    if not hasattr(pbr, "baseColorFactor") and hasattr(pbr, "to_pbr"):
        pbr = pbr.to_pbr()
    factor = _factor(getattr(pbr, "baseColorFactor", None), 4)
    values: Dict[str, Any] = {"base_color": factor[:3],
                              "metalness": _number(pbr, "metallicFactor", 1.0),
                              "roughness": _number(pbr, "roughnessFactor", 1.0),
                              "double_sided": bool(getattr(pbr, "doubleSided", False))}
    image = _image(pbr, "baseColorTexture") if has_uvs else None
    if image is not None:
        values["base_color"] = Texture(image[..., :3] if image.ndim == 3 else image, factor=factor[:3])
    mode = getattr(pbr, "alphaMode", None) or _OPAQUE
    if mode != _OPAQUE:
        values["opacity"] = _opacity(pbr, image, float(factor[3]), mode)
    rough = _image(pbr, "metallicRoughnessTexture") if has_uvs else None
    if rough is not None and rough.ndim == 3:
        values["metalness"] = Texture(rough[..., :3], factor=values["metalness"], channel="blue")
        values["roughness"] = Texture(rough[..., :3], factor=values["roughness"], channel="green")
    normals = _image(pbr, "normalTexture") if has_uvs else None
    if normals is not None and normals.ndim == 3:
        values["normal_map"] = Texture(normals[..., :3])
    emissive = getattr(pbr, "emissiveFactor", None)
    if emissive is not None and numpy.any(emissive):
        light = _factor(emissive, 3)
        glow = _image(pbr, "emissiveTexture") if has_uvs else None
        values["emission"] = light if glow is None else Texture(glow[..., :3] if glow.ndim == 3 else glow, factor=light)
    return values


def _opacity(pbr: Any, image: Optional[AnyArray], factor: float, mode: str) -> Any:
    cutoff = {"cutoff": _number(pbr, "alphaCutoff", 0.5)} if mode == _MASK else {}
    if image is None or image.ndim != 3 or image.shape[2] != 4:
        return factor if not cutoff else float(factor >= cutoff["cutoff"])
    return Texture(image, factor=factor, **cutoff)


def _number(material: Any, key: str, usual: float) -> float:
    value = getattr(material, key, None)
    return usual if value is None else float(value)


def _factor(value: Any, channels: int) -> AnyArray:
    """A colour from 0 to 1, linear, which trimesh keeps as floats or as whole numbers up to 255."""
    if value is None:
        return numpy.ones(channels)
    color = numpy.asarray(value)
    scaled = color / 255.0 if color.dtype.kind in "ui" else color.astype(numpy.float64)
    full = numpy.ones(channels)
    full[:min(channels, scaled.size)] = scaled.ravel()[:channels]
    return full


def _image(material: Any, key: str) -> Optional[AnyArray]:
    """The image, as (H, W) or (H, W, C) of uint8; palettes become colours."""
    image = getattr(material, key, None)
    if image is None:
        return None
    if hasattr(image, "convert") and getattr(image, "mode", "RGB") not in ("L", "RGB", "RGBA"):
        image = image.convert("RGBA")
    return numpy.asarray(image, numpy.uint8)


def _linear(colors: Any) -> AnyArray:
    """Colours of a screen (sRGB, up to 255) as linear floats; alpha is linear already."""
    codes = numpy.asarray(colors, numpy.float32) / numpy.float32(255)
    linear = numpy.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
    if codes.shape[-1] == 4:
        linear[..., 3] = codes[..., 3]
    return linear.astype(numpy.float32)
