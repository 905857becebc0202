#!/usr/bin/env python3
"""Renders a scenario of Khronos' render-fidelity generator with `candela fidelity`.

The generator calls it with one argument, JSON: {"scenario": {...}, "outputFile": "…/goldens/NAME/FILE.png"}.
In its test/config.json, under "renderers":

    { "name": "candela", "description": "candela", "command": { "executable": "python3",
      "args": ["…/tests/gltf/fidelity_generator.py", "--candela", "…/candela", "--spp", "256"] } }

Models and environments are named relative to test/renderers/NAME, as the generator's other renderers have it. Options
other than --candela go to candela.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0], allow_abbrev=False)
    parser.add_argument("--candela", default="candela")
    options, others = parser.parse_known_args()
    if not others:
        parser.error("the generator's JSON is missing")
    configuration = json.loads(others.pop())
    output = Path(configuration["outputFile"]).resolve()
    root = output.parents[2] / "renderers" / "candela"  # From test/goldens/SCENARIO/FILE.
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", suffix=".json", encoding="utf-8") as scenario:
        json.dump(configuration["scenario"], scenario)
        scenario.flush()
        command = [options.candela, "fidelity", scenario.name, "--root", str(root), "-o", str(output), "-q", *others]
        return subprocess.run(command, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
