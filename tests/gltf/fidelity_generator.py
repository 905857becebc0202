#!/usr/bin/env python3
"""Renders a scenario of Khronos' render-fidelity generator with candela.

The generator calls it with one argument, JSON: {"scenario": {...}, "outputFile": "…/goldens/NAME/FILE.png"}.
In its test/config.json, under "renderers":

    { "name": "candela", "description": "candela", "command": { "executable": "python3",
      "args": ["…/tests/gltf/fidelity_generator.py", "--candela", "…/candela", "--spp", "256"] } }

Models and environments are named relative to test/renderers/NAME, as the generator's other renderers have it. The
camera is at theta from +Z towards +X and at phi from +Y, at a radius around the target; the middle of the environment
is +X. Pictures have twice the dimensions, as on screens of two pixels a point. Without a sky, they have alpha.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import png
from exr_alpha import read_alpha

# What the generator has for a scenario that does not say.
DEFAULTS = {
    "lighting": "../../../environments/lightroom_14b.hdr",
    "dimensions": {"width": 768, "height": 768},
    "target": {"x": 0, "y": 0, "z": 0},
    "orbit": {"theta": 0, "phi": 90, "radius": 1},
    "verticalFoV": 45,
    "renderSkybox": False,
}
SCALE = 2  # Pixels per point.
EXPOSURE = math.log2(1 / 0.6)  # As three.js has it before the curve of ACES.
SKY_ROTATION = -90  # Degrees: the middle of the generator's environments is +X, ours is -Z.


def completed(scenario):
    """The scenario with what it leaves out."""
    result = {**DEFAULTS, **scenario}
    for key in ("dimensions", "target", "orbit"):
        result[key] = {**DEFAULTS[key], **scenario.get(key, {})}
    return result


def camera(scenario):
    theta, phi = (math.radians(scenario["orbit"][angle]) for angle in ("theta", "phi"))
    outwards = [math.sin(phi) * math.sin(theta), math.cos(phi), math.sin(phi) * math.cos(theta)]
    radius, target = scenario["orbit"]["radius"], [scenario["target"][axis] for axis in "xyz"]
    position = [t + radius * o for t, o in zip(target, outwards)]
    ahead = radius or 1  # A radius of 0 looks around from the target.
    result = {"position": position, "look_at": [p - ahead * o for p, o in zip(position, outwards)],
              "vertical_fov": scenario["verticalFoV"]}
    if math.hypot(outwards[0], outwards[2]) < 1e-6:  # From straight above or below, what is behind is up.
        result["up"] = [-math.sin(theta) * outwards[1], 0, -math.cos(theta) * outwards[1]]
    return result


def scene(scenario, folder):
    """A scene of candela's; folder is the one from which the scenario names files."""
    def path(name):
        return os.path.normpath(folder / name)

    size = [SCALE * scenario["dimensions"][side] for side in ("width", "height")]
    return {
        "scene": path(scenario["model"]),
        "cameras": {"orbit": camera(scenario)},
        "environment": {"file": path(scenario["lighting"]), "rotation": SKY_ROTATION,
                        "visible": bool(scenario["renderSkybox"])},
        "film": {"size": size},
    }


def with_alpha(picture, exr):
    """The PNG file with the alpha of the EXR file: its colours are those of the covered share."""
    width, height, channels, pixels = png.read(picture)
    _, _, alpha = read_alpha(exr)
    result = bytearray()
    for i, a in enumerate(alpha):
        colour = pixels[i * channels:i * channels + 3]
        result += bytes(min(255, round(c / a)) if a > 0 else 0 for c in colour) + bytes([round(255 * min(a, 1))])
    return png.write(width, height, 4, result)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--candela", default="candela")
    parser.add_argument("--spp", default="256")
    parser.add_argument("--tonemap", default="aces")
    parser.add_argument("--exposure", default=f"{EXPOSURE:.4f}", help="in EV")
    parser.add_argument("configuration", help="JSON, as the generator makes it")
    options = parser.parse_args()
    configuration = json.loads(options.configuration)
    scenario, output = completed(configuration["scenario"]), Path(configuration["outputFile"]).resolve()
    root = output.parents[2] / "renderers" / "candela"  # From test/goldens/SCENARIO/FILE.

    with tempfile.TemporaryDirectory() as temporary:
        described, picture, radiance = (Path(temporary) / name for name in ("scene.json", "out.png", "out.exr"))
        described.write_text(json.dumps(scene(scenario, root)), encoding="utf-8")
        command = [options.candela, "render", str(described), "-o", str(picture), "--spp", options.spp, "--exposure",
                   options.exposure, "--tonemap", options.tonemap, "-q"]
        if not scenario["renderSkybox"]:
            command += ["-o", str(radiance), "--aov", "none"]
        code = subprocess.run(command, check=False).returncode
        if code:
            return code
        data = picture.read_bytes()
        output.parent.mkdir(parents=True, exist_ok=True)
        output.write_bytes(data if scenario["renderSkybox"] else with_alpha(data, radiance.read_bytes()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
