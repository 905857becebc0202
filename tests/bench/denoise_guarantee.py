#!/usr/bin/env python3
"""Measures the guarantee of denoising: relMSE of the denoised picture over that of the noisy one.

usage: denoise_guarantee.py BUILD [SCENE.json ...] [--spp 4,64,256,4096] [--seeds 8] [--width 256] [--reference 16384]
           [--denoise variance,oidn]

For each scene and number of samples, prints the mean ratio over the seeds with its 95 % interval, the median and the
worst. The reference of a seed is the mean of pictures of other seeds with the most samples; its own variance, as these
pictures differ, is taken off both errors. (By the layer Variance it would be up to six times as large, since samples of
a low-discrepancy sequence differ more than their mean errs.) Pictures are kept in BUILD/denoising. Needs NumPy.
"""
import argparse
import re
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent / "rivals"))
import exr  # noqa: E402

SCENES = ("cornell-box", "cornell-glass", "cornell-glossy", "depth-of-field", "environment", "lemons", "materials", "mesh",
          "showcase", "veach-mis")
T_95 = {2: 12.7, 3: 4.3, 4: 3.18, 5: 2.78, 6: 2.57, 7: 2.45, 8: 2.36}  # Student's t, by the number of seeds.


def planes(path, layer=""):
    *_, channels = exr.read_all(path)
    return np.stack([np.asarray(channels[f"{layer}{c}"], dtype=np.float64) for c in "RGB"])


def render(build, scene, size, spp, seed, out):
    if not out.exists():
        part = out.with_name("part-" + out.name)  # An interrupted rendering writes what it has so far.
        subprocess.run([build / "candela", "render", scene, "-q", "--spp", str(spp), "--seed", str(seed), "--size", size,
                        "--aov", "albedo,n,variance,samples,denoising", "-o", part], check=True)
        part.rename(out)
    return out


def size_of(build, scene, width):
    report = subprocess.run([build / "candela", "info", scene], check=True, capture_output=True, text=True).stdout
    x, y = map(int, re.search(r"picture\s+(\d+)x(\d+)", report).groups())
    return f"{width}x{round(width * y / x)}"


def ratios(build, scene, spp, most, args):
    """The ratio of the errors of each way (rows) for each seed (columns)."""
    folder = build / "denoising"
    folder.mkdir(exist_ok=True)
    size, stem = size_of(build, scene, args.width), scene.stem
    seeds = range(1, args.seeds + 1)

    def picture(samples, seed):
        return render(build, scene, size, samples, seed, folder / f"{stem}-{size}-{samples}-{seed}.exr")

    result = []
    for seed in seeds:
        noisy = picture(spp, seed)
        others = [picture(most, other) for other in seeds if other != seed][:args.reference // most]
        references = [planes(other) for other in others]
        r = np.mean(references, axis=0)
        own = np.var(references, axis=0, ddof=1) / len(references)
        weight = 1.0 / (r * r + 0.01 * r.mean() ** 2)

        def error(found):
            return np.mean(((found - r) ** 2 - own) * weight)

        errors = []
        for way in args.denoise:
            denoised = folder / f"{stem}-denoised.exr"
            subprocess.run([build / "candela", "denoise", noisy, "-o", denoised, "--denoise", way], check=True,
                           stdout=subprocess.DEVNULL)
            errors.append(error(planes(denoised, "Denoised.")))
        result.append(np.array(errors) / error(planes(noisy)))
    return np.transpose(result)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("scenes", nargs="*", type=Path)
    parser.add_argument("--spp", default="4,64,256,4096")
    parser.add_argument("--seeds", type=int, default=8, choices=sorted(T_95))
    parser.add_argument("--width", type=int, default=256)
    parser.add_argument("--reference", type=int, default=16384)
    parser.add_argument("--denoise", default="variance,oidn")
    args = parser.parse_args()
    args.denoise = args.denoise.split(",")
    args.build = args.build.resolve()
    numbers = [int(spp) for spp in args.spp.split(",")]
    most = max(numbers)
    if not 2 * most <= args.reference <= (args.seeds - 1) * most:
        parser.error(f"--reference must be from {2 * most} to {(args.seeds - 1) * most}, the samples of the other seeds")
    scenes = args.scenes or [Path("scenes") / f"{name}.json" for name in SCENES]
    for scene in scenes:
        for spp in numbers:
            for way, values in zip(args.denoise, ratios(args.build, scene, spp, most, args)):
                half = T_95[args.seeds] * values.std(ddof=1) / np.sqrt(args.seeds)
                print(f"{spp:5} {scene.stem:16} {way:8} {values.mean():.3f} ± {half:.3f}, median {np.median(values):.3f}, "
                      f"worst {values.max():.3f}", flush=True)


if __name__ == "__main__":
    main()
