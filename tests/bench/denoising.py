#!/usr/bin/env python3
"""How far denoised pictures are from the truth, for each scene of the gallery: their relMSE over that of the noisy ones.

The relMSE is that of `candela compare`, to a reference of other samples: the mean of two pictures of half of them, whose
difference shows the reference's own noise, which is taken off both. Both ways, blended with the noisy picture; `first
hits` are guided by Albedo and N, `guides` by --aov denoising. Needs numpy, and Open Image Denoise where candela finds it
(cmake/denoiser.sh).

usage: denoising.py CANDELA [--scenes NAME,...] [--spp 4,16,64] [--reference-spp N] [--width N] [--seeds N]
                    [--keep FOLDER] [--option=OPTION of denoise]... [--at-most RATIO]

Prints a table in Markdown. Exits with 1 if a ratio is above --at-most.
"""
import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from rivals import exr  # noqa: E402

SCENES = Path(__file__).resolve().parents[2] / "scenes"
GALLERY = ("cornell-box", "cornell-glass", "cornell-glossy", "depth-of-field", "environment", "lemons", "materials",
           "mesh", "showcase", "veach-mis")
FIRST_HITS, GUIDES = ("Albedo.", "N."), ("DenoisingAlbedo.", "DenoisingNormal.")
WAYS = {"oidn, first hits": ("oidn", FIRST_HITS), "oidn, guides": ("oidn", GUIDES),
        "variance, first hits": ("variance", FIRST_HITS), "variance, guides": ("variance", GUIDES)}


def layer(path, name, letters="RGB"):
    """A layer of an EXR as an array of pixels times channels."""
    channels = exr.read_all(path)[3]
    return numpy.stack([numpy.array(channels[name + c], dtype=numpy.float64) for c in letters], axis=-1)


def relative_mse(image, reference, noise):
    """As host/image/relative_error.h; `noise` is the reference's variance."""
    darkness = 0.01 * reference.mean() ** 2
    return float((((image - reference) ** 2 - noise) / (reference ** 2 + darkness)).mean())


def size_of(scene, width):
    full = re.search(r'"film":\s*\{[^}]*"size":\s*\[(\d+), *(\d+)\]', (SCENES / f"{scene}.json").read_text())
    return f"{width}x{round(width * int(full[2]) / int(full[1]))}"


class Bench:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder

    def candela(self, *words):
        subprocess.run([self.options.candela, *words], check=True, stdout=subprocess.DEVNULL)

    def render(self, scene, name, spp, seed, aovs):
        path = self.folder / f"{name}.exr"
        if not path.exists():
            part = path.with_name("part-" + path.name)  # An interrupted rendering writes what it has so far.
            self.candela("render", str(SCENES / f"{scene}.json"), "-o", str(part), "--spp", str(spp), "--seed", str(seed),
                         "--size", size_of(scene, self.options.width), "--aov", aovs, "--quiet")
            part.rename(path)
        return path

    def denoised(self, noisy, way, guides):
        """The layer denoised in that way, guided by those layers alone."""
        only, out = self.folder / "only.exr", self.folder / "denoised.exr"
        width, height, attributes, channels = exr.read_all(noisy)
        exr_write(only, width, height, {name: values for name, values in channels.items()
                                        if name in "RGB" or name.startswith((*guides, "Variance.", "SampleCount."))})
        self.candela("denoise", str(only), "-o", str(out), "--denoise", way, *self.options.option)
        return layer(out, "Denoised.")

    def measure(self, scene, spp):
        """Ratios of denoised over noisy, for each way; the medians of the seeds."""
        halves = [layer(self.render(scene, f"{scene}-reference-{seed}", self.options.reference_spp // 2, seed, "albedo"), "")
                  for seed in (1000, 1001)]
        reference, noise = numpy.mean(halves, axis=0), numpy.var(halves, axis=0, ddof=1) / 2
        ratios = {name: [] for name in WAYS}
        for seed in range(self.options.seeds):
            noisy = self.render(scene, f"{scene}-{spp}-{seed}", spp, seed, "albedo,n,denoising,variance,samples")
            before = relative_mse(layer(noisy, ""), reference, noise)
            for name, how in WAYS.items():
                ratios[name].append(relative_mse(self.denoised(noisy, *how), reference, noise) / before)
        return {name: median(values) for name, values in ratios.items()}


def exr_write(path, width, height, channels):
    """Scan lines of 32-bit floats, without compression."""
    import struct
    names = sorted(channels)

    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    listed = b"".join(n.encode() + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for n in names) + b"\0"
    head = struct.pack("<ii", 20000630, 2) + attribute("channels", "chlist", listed)
    head += attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", box)
    head += attribute("displayWindow", "box2i", box) + attribute("lineOrder", "lineOrder", b"\0")
    head += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    head += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    head += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    planes = numpy.stack([numpy.asarray(channels[n], dtype="<f4").reshape(height, width) for n in names], axis=1)
    row = 8 + planes[0].nbytes
    first = len(head) + 8 * height
    with open(path, "wb") as file:
        file.write(head + struct.pack(f"<{height}Q", *(first + row * y for y in range(height))))
        for y in range(height):
            file.write(struct.pack("<ii", y, planes[y].nbytes) + planes[y].tobytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("candela")
    parser.add_argument("--scenes", default=",".join(GALLERY))
    parser.add_argument("--spp", default="4,16,64")
    parser.add_argument("--reference-spp", type=int, default=1024)
    parser.add_argument("--width", type=int, default=256)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--keep", help="folder for renderings, which are used again")
    parser.add_argument("--option", action="append", default=[])
    parser.add_argument("--at-most", type=float, default=float("inf"))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(options.keep or temporary)
        folder.mkdir(exist_ok=True)
        bench = Bench(options, folder)
        counts = [int(spp) for spp in options.spp.split(",")]
        columns = [(spp, name) for spp in counts for name in WAYS]
        print("| relMSE over the noisy picture's | " + " | ".join(f"{spp}, {name}" for spp, name in columns) + " |")
        print("|---|" + "---|" * len(columns))
        table = {}
        for scene in options.scenes.split(","):
            measured = {spp: bench.measure(scene, spp) for spp in counts}
            table[scene] = [measured[spp][name] for spp, name in columns]
            print(f"| {scene} | " + " | ".join(f"{value:.3f}" for value in table[scene]) + " |", flush=True)
        print("| median | " + " | ".join(f"{median(c):.3f}" for c in zip(*table.values())) + " |")
        if options.keep:
            (folder / "denoising.json").write_text(json.dumps(table, indent=1))
        if max(max(row) for row in table.values()) > options.at_most:
            sys.exit(f"a picture is above {options.at_most} of the noisy one's relMSE")


if __name__ == "__main__":
    main()
