#!/usr/bin/env python3
"""Checks that scenes/scene.schema.json accepts every scene and refuses bad ones: schema.py SCENES_DIR...

The schema is in the first folder.
"""

import copy
import json
import re
import sys
from pathlib import Path

import jsonschema

# A string, which stays, or a comment, which becomes a space.
STRING_OR_COMMENT = re.compile(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', re.DOTALL)


def read_scene(path):
    text = path.read_text(encoding="utf-8")
    return json.loads(STRING_OR_COMMENT.sub(lambda match: match.group(1) or " ", text))


GOOD = {
    "cameras": {
        "main": {
            "position": [0, 0, 1],
            "look_at": [0, 0, 0],
            "vertical_fov": 40,
            "lens": {"radius": 0.01, "focal_distance": 1, "blades": 6, "rotation": 15},
        },
        "pinhole": {
            "position": [0, 0, 1],
            "look_at": [0, 0, 0],
            "film_size": [4, 3],
            "focal_length": [5, 5.1],
            "principal_point": [2.1, -1],
            "lens": {"radius": 0},
        },
        "map": {"position": [0, 9, 0], "look_at": [0, 0, 0], "up": [0, 0, -1], "orthographic_height": 4},
    },
    "film": {"size": [640, 480]},
    "integrator": {"spp": 1, "max_depth": 5, "estimator": "mis"},
    "materials": {
        "white": {"type": "diffuse", "reflectance": [1, 0.5, 0]},
        "lacquer": {"type": "phong", "diffuse": 0.5, "specular": [0.1, 0.2, 0.3], "exponent": 0},
        "silver": {"type": "mirror", "vertex_colors": True},
        "wood": {
            "type": "diffuse",
            "reflectance": {
                "image": "wood.jpg",
                "factor": [1, 0.5, 0],
                "encoding": "linear",
                "wrap": ["mirror", "clamp"],
                "filter": "nearest",
                "uv_set": 1,
                "uv_scale": [2, -3],
                "uv_rotation": 30,
                "uv_offset": [0.5, 0],
            },
            "normal_map": {"image": "bumps.png", "scale": 2},
            "opacity": {"image": "wood.png", "channel": "alpha", "cutoff": 0.5},
        },
        "gold": {
            "type": "conductor",
            "reflectance": [1, 0.8, 0.3],
            "alpha": 0.001,
            "bump_map": {"image": "dents.png", "scale": -0.002, "channel": "green"},
        },
        "glass": {
            "type": "dielectric",
            "ior": 1.5,
            "exterior_ior": 1.33,
            "fresnel": "exact",
            "absorption": {"transmittance": [0.5, 1, 0.9], "distance": 0.1},
        },
        "plastic": {"type": "principled"},
        "silk": {
            "type": "principled",
            "base_color": {"image": "silk.png"},
            "metalness": {"image": "silk.png", "channel": "blue"},
            "roughness": {"image": "silk.png", "channel": "green", "factor": 0.5},
            "diffuse_roughness": 1,
            "ior": 0,
            "specular": 0.5,
            "specular_color": [1, 0.5, 0],
            "anisotropy": 0.5,
            "anisotropy_rotation": 400,
            "anisotropy_map": {"image": "threads.png", "uv_scale": 3},
            "thin_walled": True,
            "diffuse_transmission": 0.5,
            "diffuse_transmission_color": 0.5,
            "coat": 1,
            "coat_roughness": {"image": "coat.png"},
            "coat_ior": 1.6,
            "coat_darkening": 1,
            "coat_normal_map": {"image": "coat.png", "scale": 0.5},
            "sheen_color": [1, 0, 0],
            "sheen_roughness": 0.3,
            "fuzz": {"image": "fuzz.png"},
            "fuzz_color": [0, 0.5, 1],
            "fuzz_roughness": 0.4,
            "iridescence": 0.5,
            "iridescence_ior": 1.2,
            "iridescence_thickness": {"image": "film.png", "factor": 800, "channel": "green"},
            "iridescence_thickness_min": 900,
            "emission": {"image": "glow.png", "factor": 20},
            "unlit": False,
            "double_sided": False,
            "normal_map": {"image": "bumps.png"},
            "opacity": 0.5,
            "vertex_colors": True,
        },
        "prism": {
            "type": "principled",
            "ior": 1.7,
            "transmission": 1,
            "thin_walled": False,
            "priority": 15,
            "dispersion": 40,
        },
        "sign": {"type": "principled", "unlit": True, "base_color": 1, "opacity": 0.5, "double_sided": False},
        "brushed": {
            "type": "rough_conductor",
            "reflectance": [1, 0.8, 0.3],
            "roughness": 0,
            "anisotropy": 0.7,
            "anisotropy_rotation": 45,
        },
        "frosted": {
            "type": "rough_dielectric",
            "ior": 1.5,
            "roughness": 0.3,
            "thin_walled": False,
            "priority": 2,
            "absorption": {"transmittance": 0.5, "distance": 0.1},
        },
        "pane": {"type": "rough_dielectric", "ior": 1.5, "roughness": 0.3, "thin_walled": True},
    },
    "lights": [
        {"type": "point", "name": "bulb", "position": [0, 1, 0], "intensity": 3},
        {"type": "spot", "position": [0, 1, 0], "direction": [0, -1, 0], "intensity": [1, 2, 3], "inner_angle": 5},
        {"type": "spot", "position": [0, 1, 0], "look_at": [0, 0, 0], "intensity": 1, "outer_angle": 90},
        {"type": "directional", "direction": [0, -1, 0], "irradiance": [1, 2, 3]},
    ],
    "environment": {"file": "sky.hdr", "rotation": 90, "intensity": 2, "visible": False},
    "shapes": [
        {
            "type": "box",
            "min": [0, 0, 0],
            "max": [1, 1, 1],
            "material": "white",
            "transform": [{"scale": 2}, {"rotate": 90, "axis": [0, 1, 0]}, {"translate": [1, 2, 3]}],
        },
        {"type": "sphere", "emission": 1},
        {"type": "disk", "center": [0, 1, 0], "normal": [0, 0, 1], "radius": 2, "material": "gold"},
        {"type": "instance", "object": "tree", "transform": [{"scale": 2}], "material": "gold"},
        {"type": "instance", "object": "tree", "transforms": [[{"scale": 2}], []]},
    ],
    "objects": {
        "ball": [{"type": "sphere", "material": "white"}],
        "tree": [{"type": "instance", "object": "ball"}],
    },
}

REMOVE = object()

# What to change in GOOD so that the schema must refuse it: the path of a value, and the value.
BAD = [
    (["materials", "wood", "reflectance", "image"], REMOVE),
    (["materials", "wood", "reflectance", "file"], "wood.jpg"),
    (["materials", "wood", "reflectance", "factor"], 2),
    (["materials", "wood", "reflectance", "wrap"], ["repeat"]),
    (["materials", "wood", "reflectance", "uv_scale"], 1e7),
    (["materials", "wood", "reflectance", "cutoff"], 0.5),
    (["materials", "wood", "opacity", "cutoff"], 2),
    (["materials", "wood", "opacity"], 1.5),
    (["materials", "wood", "normal_map"], 1),
    (["materials", "wood", "normal_map", "scale"], "2"),
    (["materials", "wood", "bump_map"], {"image": "dents.png", "scale": 1}),
    (["materials", "gold", "bump_map", "scale"], REMOVE),
    (["materials", "gold", "bump_map", "factor"], 1),
    (["materials", "gold", "alpha"], {"image": "a.png", "factor": -1}),
    (["cameras"], REMOVE),
    (["cameras"], {}),
    (["lamps"], []),
    (["objects"], []),
    (["objects", "ball"], {"type": "sphere", "material": "white"}),
    (["objects", "ball", 0, "material"], REMOVE),
    (["shapes", 3, "object"], REMOVE),
    (["shapes", 3, "transforms"], []),
    (["shapes", 4, "transforms"], [{"scale": 2}]),
    (["lights"], {}),
    (["lights", 0, "type"], "area"),
    (["lights", 0, "position"], REMOVE),
    (["lights", 0, "intensity"], -1),
    (["lights", 0, "direction"], [0, -1, 0]),
    (["lights", 0, "name"], 1),
    (["lights", 1, "direction"], REMOVE),
    (["lights", 1, "look_at"], [0, 0, 0]),
    (["lights", 1, "inner_angle"], -1),
    (["lights", 2, "outer_angle"], 91),
    (["lights", 3, "irradiance"], REMOVE),
    (["lights", 3, "intensity"], 1),
    (["lights", 3, "position"], [0, 0, 0]),
    (["cameras", "main", "vertical_fov"], 180),
    (["cameras", "main", "vertical_fov"], REMOVE),
    (["cameras", "main", "focal_length"], 0.035),
    (["cameras", "main", "principal_point"], [1, 1]),
    (["cameras", "pinhole", "focal_length"], [5]),
    (["cameras", "pinhole", "focal_length"], [5, 0]),
    (["cameras", "pinhole", "principal_point"], 2),
    (["cameras", "map", "principal_point"], [2, 2]),
    (["cameras", "main", "position"], [0, 0]),
    (["cameras", "main", "fov"], 40),
    (["cameras", "main", "lens", "radius"], -1),
    (["cameras", "main", "lens", "radius"], REMOVE),
    (["cameras", "main", "lens", "focal_distance"], 0),
    (["cameras", "main", "lens", "focal_distance"], REMOVE),
    (["cameras", "main", "lens", "blades"], 2),
    (["cameras", "main", "lens", "blades"], REMOVE),
    (["cameras", "main", "lens", "fstop"], 8),
    (["cameras", "pinhole", "lens", "radius"], 0.01),
    (["cameras", "map", "orthographic_height"], 0),
    (["cameras", "map", "vertical_fov"], 40),
    (["cameras", "map", "lens"], {"radius": 0}),
    (["cameras", "main", "orthographic_height"], 4),
    (["film", "size"], [0, 480]),
    (["film", "size"], [640.5, 480]),
    (["film", "size"], [640]),
    (["integrator", "spp"], 0),
    (["integrator", "max_depth"], "infinite"),
    (["integrator", "estimator"], "nee"),
    (["integrator", "seed"], 2**32),
    (["materials", "white", "reflectance"], 1.5),
    (["materials", "white", "reflectance"], [1, 1]),
    (["materials", "white", "type"], "difuse"),
    (["materials", "lacquer", "exponent"], -1),
    (["materials", "lacquer", "exponent"], 100001),
    (["materials", "lacquer", "exponent"], REMOVE),
    (["materials", "lacquer", "specular"], REMOVE),
    (["materials", "lacquer", "diffuse"], 1.5),
    (["materials", "silver", "reflectance"], -0.5),
    (["materials", "silver", "alpha"], 0.1),
    (["materials", "gold", "alpha"], 0),
    (["materials", "gold", "alpha"], 1.5),
    (["materials", "gold", "alpha"], REMOVE),
    (["materials", "gold", "reflectance"], REMOVE),
    (["materials", "glass", "ior"], 0),
    (["materials", "glass", "ior"], REMOVE),
    (["materials", "glass", "exterior_ior"], 0),
    (["materials", "glass", "fresnel"], "exakt"),
    (["materials", "glass", "absorption", "transmittance"], 0),
    (["materials", "glass", "absorption", "transmittance"], [1, 0, 1]),
    (["materials", "glass", "absorption", "transmittance"], REMOVE),
    (["materials", "glass", "absorption", "distance"], 0),
    (["materials", "glass", "absorption", "distance"], REMOVE),
    (["materials", "plastic", "base_color"], [1, 2, 0]),
    (["materials", "plastic", "base_colour"], 1),
    (["materials", "plastic", "roughness"], 1.5),
    (["materials", "plastic", "roughness"], {"image": "a.png", "factor": 2}),
    (["materials", "plastic", "ior"], 0.5),
    (["materials", "plastic", "ior"], {"image": "a.png"}),
    (["materials", "plastic", "thin_walled"], False),
    (["materials", "plastic", "absorption"], {"transmittance": 0.5, "distance": 1}),
    (["materials", "plastic", "priority"], 1),
    (["materials", "plastic", "dispersion"], 1),
    (["materials", "plastic", "coat_ior"], 1.5),
    (["materials", "plastic", "unlit"], 1),
    (["materials", "silk", "anisotropy"], REMOVE),
    (["materials", "silk", "anisotropy_map", "factor"], 1),
    (["materials", "silk", "diffuse_transmission"], REMOVE),
    (["materials", "silk", "coat"], REMOVE),
    (["materials", "silk", "coat_ior"], 0.5),
    (["materials", "silk", "coat_darkening"], 2),
    (["materials", "silk", "coat_normal_map"], 1),
    (["materials", "silk", "sheen_color"], REMOVE),
    (["materials", "silk", "fuzz"], REMOVE),
    (["materials", "silk", "fuzz_roughness"], 2),
    (["materials", "silk", "iridescence"], REMOVE),
    (["materials", "silk", "iridescence_ior"], 0.5),
    (["materials", "silk", "iridescence_thickness"], 800),
    (["materials", "silk", "iridescence_thickness"], REMOVE),
    (["materials", "silk", "iridescence_thickness", "factor"], REMOVE),
    (["materials", "silk", "iridescence_thickness_min"], -1),
    (["materials", "silk", "absorption"], {"transmittance": 0.5, "distance": 1}),
    (["materials", "silk", "emission", "factor"], -1),
    (["materials", "silk", "unlit"], True),
    (["materials", "silk", "bump_map"], {"image": "dents.png", "scale": 1}),
    (["materials", "prism", "ior"], 0),
    (["materials", "prism", "transmission"], REMOVE),
    (["materials", "prism", "thin_walled"], True),
    (["materials", "prism", "thin_walled"], REMOVE),
    (["materials", "prism", "priority"], 16),
    (["materials", "prism", "dispersion"], 41),
    (["materials", "sign", "roughness"], 1),
    (["materials", "brushed", "reflectance"], REMOVE),
    (["materials", "brushed", "roughness"], REMOVE),
    (["materials", "brushed", "anisotropy"], REMOVE),
    (["materials", "brushed", "metalness"], 1),
    (["materials", "frosted", "ior"], 0.5),
    (["materials", "frosted", "ior"], REMOVE),
    (["materials", "frosted", "roughness"], REMOVE),
    (["materials", "frosted", "thin_walled"], True),
    (["materials", "frosted", "transmission"], 1),
    (["materials", "pane", "absorption"], {"transmittance": 0.5, "distance": 1}),
    (["materials", "pane", "priority"], 1),
    (["shapes", 0, "material"], REMOVE),
    (["shapes", 0, "max"], REMOVE),
    (["shapes", 0, "type"], "cone"),
    (["shapes", 0, "type"], REMOVE),
    (["shapes", 0, "file"], "a.obj"),
    (["shapes", 0, "two_sided"], True),
    (["shapes", 0, "emission"], -1),
    (["shapes", 0, "transform"], {"scale": 2}),
    (["shapes", 0, "transform", 0], {"scale": 2, "translate": [0, 0, 0]}),
    (["shapes", 0, "transform", 1], {"rotate": 90}),
    (["shapes", 0, "transform", 2], {"matrix": [1, 0, 0, 0]}),
    (["shapes", 1, "radius"], 0),
    (["shapes", 1, "center"], 0),
    (["shapes", 1, "normal"], [0, 0, 1]),
    (["shapes", 2, "normal"], REMOVE),
    (["shapes", 2, "radius"], -1),
    (["environment"], {}),
    (["environment"], {"radiance": -1}),
    (["environment"], {"radiance": 1, "rotation": 90}),
    (["environment", "radiance"], 1),
    (["environment", "intensity"], -1),
    (["environment", "rotation"], "90"),
    (["environment", "visible"], 1),
]


# The same for what it must accept.
ALSO_GOOD = [
    (["materials", "prism", "absorption"], {"transmittance": 0.5, "distance": 1}),
    (["materials", "plastic", "iridescence"], 0),
    (["materials", "silk", "coat"], 0),
    (["materials", "pane", "thin_walled"], REMOVE),
    (["lights"], []),
    (["environment"], REMOVE),
    (["environment"], {"radiance": [1, 0, 0.5], "intensity": 0, "visible": True}),
]


def changed(path, value):
    """GOOD with one value replaced, added or removed."""
    scene = copy.deepcopy(GOOD)
    parent = scene
    for key in path[:-1]:
        parent = parent[key]
    if value is REMOVE:
        del parent[path[-1]]
    else:
        parent[path[-1]] = value
    return scene


def main(folders):
    schema = read_scene(folders[0] / "scene.schema.json")
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    failures = []
    scenes = []
    for folder in folders:
        found = [path for path in sorted(folder.glob("*.json")) if path.name != "scene.schema.json"]
        if not found:
            failures.append(f"{folder}: no scenes found")
        scenes += found
    for path in scenes:
        for error in validator.iter_errors(read_scene(path)):
            failures.append(f"{path}: {error.json_path}: {error.message}")
    for error in validator.iter_errors(GOOD):
        failures.append(f"the good scene: {error.json_path}: {error.message}")
    for path, value in ALSO_GOOD:
        for error in validator.iter_errors(changed(path, value)):
            failures.append(f"a good scene: {error.json_path}: {error.message}")
    for path, value in BAD:
        if validator.is_valid(changed(path, value)):
            change = "removed" if value is REMOVE else f"set to {json.dumps(value)}"
            failures.append(f"the schema accepts a scene with {path} {change}")
    for failure in failures:
        print(failure, file=sys.stderr)
    print(f"{len(scenes)} scenes and {len(BAD)} bad ones checked, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit("usage: schema.py SCENES_DIR...")
    sys.exit(main([Path(folder) for folder in sys.argv[1:]]))
