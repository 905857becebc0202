#!/usr/bin/env python3
"""What the Python package costs beside the samples. usage: python_cost.py CANDELA

Prints the time to the first picture after `import candela`, of a changed camera with a picture of 64 x 64 pixels and one
sample beside what the samples take, and to hand over a picture of 3840 x 2160 with all layers."""
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENE = {"cameras": {"main": {"position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40}}, "film": {"size": [64, 64]},
         "materials": {"clay": {"type": "diffuse", "reflectance": 0.5}},
         "shapes": [{"type": "sphere", "radius": 1, "material": "clay"}], "environment": {"radiance": 1}}
FIRST = """
import sys, time; sys.path.insert(0, sys.argv[1])
import numpy
start = time.perf_counter()
import candela
candela.load({scene}).render(spp=1).rgb
print(time.perf_counter() - start)
"""


def first():
    """Seconds, without and with NumPy's own import, which precedes; the kernels are in the cache after the first."""
    script = FIRST.format(scene=SCENE)
    runs = [float(subprocess.run([sys.executable, "-c", script, str(ROOT / "integrations/python")], check=True,
                                 stdout=subprocess.PIPE, text=True).stdout) for _ in range(6)]
    return runs[0], statistics.median(runs[1:])


def call():
    """Milliseconds of a call, and of its samples."""
    import candela
    scene = candela.load(SCENE)
    scene.render(spp=1)
    whole, samples = [], []
    for i in range(200):
        start = time.perf_counter()
        scene.camera.position = (0.001 * i, 0, 3)
        image = scene.render(spp=1, size=(64, 64), layers=())
        image.rgb
        whole.append(1e3 * (time.perf_counter() - start))
        samples.append(1e3 * image.seconds)
    return statistics.median(whole), statistics.median(a - b for a, b in zip(whole, samples))


def hand_over():
    """Milliseconds for 4K and all layers, and for the picture alone."""
    import candela
    scene = candela.load(SCENE)
    times = []
    for layers in ("all", ()):
        scene.render(spp=1, size=(3840, 2160), layers=layers)
        runs = []
        for _ in range(5):
            start = time.perf_counter()
            image = scene.image()
            for layer in image.layers:
                image[layer]
            runs.append(1e3 * (time.perf_counter() - start))
        times.append(statistics.median(runs))
    return times


def main():
    os.environ["CANDELA"] = os.path.abspath(sys.argv[1])
    sys.path.insert(0, str(ROOT / "integrations/python"))
    cold, warm = first()
    print(f"first picture after import: {warm:.3f} s, without cached kernels at most {cold:.3f} s")
    whole, beside = call()
    print(f"changed camera, 64x64, 1 sample: {whole:.2f} ms, beside the samples {beside:.2f} ms")
    everything, picture = hand_over()
    print(f"4K handed over: {everything:.1f} ms with all layers, {picture:.1f} ms without")


if __name__ == "__main__":
    main()
