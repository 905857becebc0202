#!/usr/bin/env python3
"""Measures candela on the Cornell box: samples per second, and the time to a first image.

Machines are noisy, so that each figure is the median of several runs, with the least and the largest beside it.
CPU time is the renderer's own, without loading and compiling, over all threads; its samples per second are scaled to
the cores of this machine, as if all of them had worked on it all the time.

usage: cornell.py CANDELA SCENE [RUNS]      e.g. cornell.py build/release/candela scenes/cornell-box.json 5
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SAMPLES = 64  # Per pixel; enough that compiling and the small first submissions do not count.


def show(name, values, unit):
    print(f"{name:34s} {statistics.median(values):8.3f} {unit}   ({min(values):.3f} .. {max(values):.3f})")


def render(candela, scene, folder, *options, **environment):
    """Renders without AOVs; returns the report and the wall time of the whole process [s]."""
    report = Path(folder, "report.json")
    command = [candela, "render", scene, "-o", str(Path(folder, "out.png")), "--quiet", "--report", str(report), *options]
    start = time.monotonic()
    subprocess.run(command, check=True, env=os.environ | {"XDG_CACHE_HOME": folder} | environment)
    return json.loads(report.read_text(encoding="utf-8")), time.monotonic() - start


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    candela, scene = sys.argv[1:3]
    runs = int(sys.argv[3]) if len(sys.argv) == 4 else 5
    cores = os.cpu_count()
    speed, wall_speed, rays, cold, warm = [], [], [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(runs):
            report, _ = render(candela, scene, folder, "--spp", str(SAMPLES), "--max-depth", "5")
            samples = report["width"] * report["height"] * report["spp"] / 1e6
            speed.append(samples * cores / report["cpu_seconds"])
            wall_speed.append(report["samples_per_second"] / 1e6)
            rays.append(report["rays_per_sample"])
            first = ("--spp", "1", "--size", "64x64")
            cold.append(render(candela, scene, folder, *first, CANDELA_NO_CACHE="1", MESA_SHADER_CACHE_DISABLE="true")[1])
            render(candela, scene, folder, *first)
            warm.append(render(candela, scene, folder, *first)[1])
    print(f"{report['device']}, {report['driver']}, {cores} cores, {runs} runs: median (least .. largest)")
    print(f"{Path(scene).name}, {report['width']}x{report['height']}, {SAMPLES} spp, depth 5")
    show("samples per second of CPU time", speed, "M")
    show("samples per second of wall time", wall_speed, "M")
    show("rays per sample", rays, " ")
    show("first image, cold (whole process)", cold, "s")
    show("first image, warm (whole process)", warm, "s")


if __name__ == "__main__":
    main()
