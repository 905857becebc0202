"""The requests of Drake's RenderEngineGltfClient: a form with a glTF file and a camera, answered by a picture, depths
or labels. https://drake.mit.edu/doxygen_cxx/group__render__engine__gltf__client__server__api.html"""
from __future__ import annotations

import json
import math
from http import HTTPStatus
from pathlib import Path
from typing import Any, Callable, Dict, List, Tuple

import numpy
from numpy.typing import NDArray

from candela.serve import _options
from candela.serve._form import Form
from candela.serve._image_files import write_depth_tiff, write_rgb_png
from candela.serve._options import Options
from candela.serve._pictures import Picture, Source, notes_of, render
from candela.serve._refusal import Refusal
from candela.serve._renderer import Renderer

COLOR, DEPTH, LABEL = TYPES = ("color", "depth", "label")
LENGTHS = ("focal_x", "focal_y", "center_x", "center_y")
MAX_SIDE = 65536
# What the form itself says, so that no option may.
_OF_THE_FORM = ("camera", "size", "crop", "layers", "file", "format", "background")
# Drake's worlds have +Z up, ours +Y: column by column, as glTF has it.
_UPRIGHT = [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]
# "Server-only artifacts", such as what is behind the scene, are white in label images.
_DONT_CARE = 255
# A label is seen at the pixel's centre, as depths are: no pixel may mix two.
_CENTRE_FILTER = {"filter": "box", "filter_width": 0.01}

Floats = NDArray[numpy.float32]
CheckSize = Callable[[Options, int], None]


def is_drake(form: Form) -> bool:
    """Whether a form is one of Drake's."""
    return "image_type" in form.fields


def renders(form: Form, query: Dict[str, Any], folder: Path, check_size: CheckSize) -> Callable[[Renderer], Picture]:
    """What answers such a form. The query, of Drake's parameter `render_endpoint`, may have options for pictures."""
    kind = form.fields["image_type"]
    if kind not in TYPES:
        raise _bad(f"image_type is {kind[:100]!r}, and not one of {', '.join(TYPES)}")
    if form.scene is None:
        raise _bad("it has no scene")
    if form.fields.get("scene_sha256", form.sha256).lower() != form.sha256:
        raise _bad(f"the scene's SHA-256 is {form.sha256}, and not scene_sha256; send it again")
    size = [int(_number(form, side, 1, MAX_SIDE)) for side in ("width", "height")]
    view = {"film_size": size, "focal_length": [_number(form, name, 1e-6) for name in LENGTHS[:2]],
            "principal_point": [_number(form, name) for name in LENGTHS[2:]]}
    depths = [_number(form, name, 0) for name in ("min_depth", "max_depth")] if kind == DEPTH else [0.0, 0.0]
    for name in _OF_THE_FORM:
        if name in query:
            raise _bad(f"the option {name!r} in the address contradicts the form; leave it out")
    options = _options.merged(query, {"size": size})
    check_size(options, form.scene.stat().st_size)
    key = (form.sha256, "label" if kind == LABEL else "drake", *size)
    path = form.scene

    def run(renderer: Renderer) -> Picture:
        source = Source({"file": str(folder / "world.json")}, key)
        if not (folder / "world.json").exists():
            _write_world(path, folder, size, kind)
        scene = renderer.scene(key, source.load)
        camera = _camera(renderer.call("scene", {"scene": scene})["cameras"], view)
        if kind == COLOR:
            return render(renderer, source, Options({**options.values, "camera": camera}), folder)
        asked = {"scene": scene, "camera": camera, "size": size, "spp": 1, "background": "transparent",
                 "layers": [kind]}
        if kind == DEPTH:
            return _depths(renderer, asked, (depths[0], depths[1]), folder)
        return _labels(renderer, {**asked, "layers": []}, folder)
    return run


def _bad(message: str) -> Refusal:
    return Refusal(HTTPStatus.BAD_REQUEST, "Drake's form: " + message)


def _number(form: Form, name: str, least: float = -math.inf, most: float = math.inf) -> float:
    try:
        value = float(form.fields[name])
        if least <= value <= most and math.isfinite(value) or (name == "max_depth" and value > 0):
            return value
        raise _bad(f"{name} is {form.fields[name][:100]!r}, and has to be from {least:g} to {most:g}")
    except KeyError:
        raise _bad(f"it has no field {name}") from None
    except ValueError:
        raise _bad(f"{name} is {form.fields[name][:100]!r}, which is no number") from None


def _write_world(path: Path, folder: Path, size: List[int], kind: str) -> None:
    """Writes a native scene that shows the glTF file upright, and for labels in flat colours."""
    try:
        with open(path, encoding="utf-8") as file:
            gltf = json.load(file)
        _stand_upright(gltf)
        if kind == LABEL:
            _flatten(gltf)
    except (ValueError, RecursionError, LookupError, TypeError, AttributeError) as error:
        raise Refusal(HTTPStatus.UNPROCESSABLE_ENTITY, f"Drake's form: the scene is no glTF file in JSON: {error!r}"
                      ) from None
    with open(folder / "world.gltf", "w", encoding="utf-8") as file:
        json.dump(gltf, file)
    film = {"size": size, **(_CENTRE_FILTER if kind == LABEL else {})}
    (folder / "world.json").write_text(json.dumps({"scene": "world.gltf", "film": film}), encoding="utf-8")


def _stand_upright(gltf: Dict[str, Any]) -> None:
    scene = gltf["scenes"][gltf.get("scene", 0)]
    gltf["nodes"].append({"children": scene["nodes"], "matrix": _UPRIGHT})
    scene["nodes"] = [len(gltf["nodes"]) - 1]


def _flatten(gltf: Dict[str, Any]) -> None:
    """Gives each material its label's colour alone, which Drake has put into its base colour."""
    for material in gltf.get("materials", []):
        colour = material.get("pbrMetallicRoughness", {}).get("baseColorFactor", [1, 1, 1, 1])
        material.clear()
        material.update({"pbrMetallicRoughness": {"baseColorFactor": [*colour[:3], 1]}, "doubleSided": True,
                         "extensions": {"KHR_materials_unlit": {}}})
    gltf["extensionsUsed"] = sorted({*gltf.get("extensionsUsed", []), "KHR_materials_unlit"})
    for mesh in gltf.get("meshes", []):
        for primitive in mesh["primitives"]:
            primitive["attributes"].pop("COLOR_0", None)


def _camera(cameras: Dict[str, Dict[str, Any]], view: Dict[str, Any]) -> Dict[str, Any]:
    """The scene's camera with what the form says of its view."""
    camera = next(iter(cameras.values()))
    return {**{key: camera[key] for key in ("position", "look_at", "up")}, **view}


def _layers(renderer: Renderer, asked: Dict[str, Any], names: Tuple[str, ...]) -> Tuple[List[Floats], Dict[str, str]]:
    """Renders, and returns layers, of rows of pixels."""
    outcome = renderer.call("render", asked)
    image = renderer.call("image", {"scene": asked["scene"]})
    try:
        found = []
        for name in names:
            layer = image["layers"][name]
            shape = (image["height"], image["width"], layer["channels"])
            flat = numpy.fromfile(image["file"], numpy.float32, math.prod(shape), offset=layer["offset"])
            found.append(flat.reshape(shape))
        return found, notes_of(outcome)
    finally:
        renderer.release(image["image"])


def _depths(renderer: Renderer, asked: Dict[str, Any], bounds: Tuple[float, float], folder: Path) -> Picture:
    """Depths in metres: 0 is too near, infinity too far."""
    (depth,), notes = _layers(renderer, asked, ("depth",))
    depth = numpy.where(depth > bounds[1], numpy.float32(numpy.inf), depth)
    depth = numpy.where(depth < bounds[0], numpy.float32(0), depth)
    write_depth_tiff(folder / "picture.tiff", depth[:, :, 0])
    return Picture(folder / "picture.tiff", "image/tiff", notes)


def _labels(renderer: Renderer, asked: Dict[str, Any], folder: Path) -> Picture:
    """The colours that stand for labels."""
    (rgb, alpha), notes = _layers(renderer, asked, ("rgb", "alpha"))
    colours = numpy.rint(numpy.clip(rgb, 0, 1) * 255).astype(numpy.uint8)
    write_rgb_png(folder / "picture.png", numpy.where(alpha > 0, colours, numpy.uint8(_DONT_CARE)))
    return Picture(folder / "picture.png", "image/png", notes)
