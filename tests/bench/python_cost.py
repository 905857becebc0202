#!/usr/bin/env python3
"""What the Python package costs beside the samples. usage: python_cost.py CANDELA

Prints the time to the first picture after `import candela`, of a changed camera with a picture of 64 x 64 pixels and one
sample beside what the samples take, and to hand over a picture of 3840 x 2160: what the program takes to make its layers of
the samples, and what Python takes to map them. All are the least of several runs, which other work disturbs least."""
import os
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
    return runs[0], min(runs[1:])


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
    return min(whole), min(a - b for a, b in zip(whole, samples))


def hand_over(layers):
    """Milliseconds for 4K: of the program, and of Python."""
    import candela
    from candela._image import Image
    scene = candela.load(SCENE)
    scene.render(spp=1, size=(3840, 2160), layers=layers)
    making, mapping = [], []
    for _ in range(4):
        start = time.perf_counter()
        place = scene._call("image")
        middle = time.perf_counter()
        image = Image(scene._connection, place)
        arrays = [image[layer] for layer in image.layers]
        making.append(1e3 * (middle - start))
        mapping.append(1e3 * (time.perf_counter() - middle))
        del image, arrays
    return min(making), min(mapping)


def main():
    os.environ["CANDELA"] = os.path.abspath(sys.argv[1])
    sys.path.insert(0, str(ROOT / "integrations/python"))
    cold, warm = first()
    print(f"first picture after import: {warm:.3f} s, without cached kernels at most {cold:.3f} s")
    whole, beside = call()
    print(f"changed camera, 64x64, 1 sample: {whole:.2f} ms, beside the samples {beside:.2f} ms")
    for layers in ((), ("albedo", "normal", "depth"), "all"):
        making, mapping = hand_over(layers)
        print(f"4K handed over in {mapping:.2f} ms; {making:.0f} ms to make it, with the layers {layers or 'rgb and alpha'}")


if __name__ == "__main__":
    main()
