#!/usr/bin/env python3
"""Measures denoised pictures of candela and of Cycles after the same CPU time, and prints a table.

Both denoise by Open Image Denoise, each with its own guides and its own way of using it. candela gets --spp samples, and
Cycles as many as take, with its denoiser, the CPU time that candela took with its own; starting, and preparing scene and
kernels, are excluded. Each picture is compared with its renderer's own converged one, the mean of two: by relMSE, off
which the noise is taken that these show by their difference, and by FLIP (Andersson et al. 2021, of HDR pictures).
Figures are medians over the seeds.

usage: denoised.py CANDELA [SCENE...]      Needs numpy and flip-evaluator, Blender (as compare.py), and Open Image Denoise
where candela finds it (cmake/denoiser.sh).
"""

import argparse
import importlib.util
import os
import resource
import statistics
import sys
from pathlib import Path

import compare
import exr
import flip_evaluator
import numpy
from renderers import HERE, RR_DEPTH, Candela, Cycles, Job, last_json, run, run_in_blender

SCENES = ("cornell-box", "many-lights", "principled", "room", "lit-glass")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("candela", metavar="CANDELA", help="the program")
    parser.add_argument("scenes", metavar="SCENE", nargs="*", help=f"of compare.py (default: {', '.join(SCENES)})")
    parser.add_argument("--spp", type=int, default=16, help="of candela (default: 16)")
    parser.add_argument("--seeds", type=int, default=3, help="pictures of each (default: 3)")
    parser.add_argument("--reference", type=float, default=160, metavar="SECONDS",
                        help="CPU time of the converged pictures of a renderer [s] (default: 160)")
    parser.add_argument("--size", type=int, default=512, help="width and height of the pictures (default: 512)")
    parser.add_argument("--blender", default=sys.executable if importlib.util.find_spec("bpy") else "blender",
                        help="as for compare.py")
    parser.add_argument("--work", type=Path, default=compare.ROOT / "build" / "rivals", help="as for compare.py")
    return parser.parse_intermixed_args()


def of_children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def denoised_by_candela(program, job, spp, seed, output):
    """The CPU time [s] beyond that of one sample without a denoiser."""
    options = ["--size", f"{job.width}x{job.width}", "--max-depth", job.depth, "--rr-depth", RR_DEPTH, "--seed", seed,
               "--quiet", "--allow-any-folder", "-o", output]
    times = []
    for more in (["--spp", 1], ["--spp", spp, "--denoise", "oidn"]):
        before = of_children()
        run([program, "render", job.scene, *options, *more])
        times.append(of_children() - before)
    return times[1] - times[0]


def denoised_by_cycles(blender, job, spp, seed, output):
    settings = [job.width, spp, job.depth, seed, job.threads, "denoise"]
    figures = last_json(run_in_blender(blender, HERE / "render_with_cycles.py", job.scene, output, *settings))
    return figures["all"]["cpu"] - figures["one"]["cpu"]


def array_of(picture):
    width, height, planes = picture
    return numpy.array(planes, dtype=numpy.float32).T.reshape(height, width, 3)


def denoised_layer(path):
    width, height, _, channels = exr.read_all(path)
    return width, height, [channels[f"Denoised.{c}"] for c in "RGB"]


def converged(renderer, job, pace, options):
    """The mean of two pictures of half the time, and its variance, as they differ."""
    halves = [array_of(compare.converged(renderer, job, pace, options.reference / 2, options.work, seed)[0])
              for seed in (compare.REFERENCE_SEED, compare.REFERENCE_SEED + 1)]
    return numpy.mean(halves, axis=0), numpy.var(halves, axis=0, ddof=1) / 2


def errors(picture, reference, noise):
    """relMSE, as pictures.relmse() without the reference's noise, and the mean of FLIP."""
    image = array_of(picture)
    _, flip, _ = flip_evaluator.evaluate(reference, image, "HDR")
    squares = ((image - reference) ** 2 - noise) / (reference**2 + 0.01 * reference.mean() ** 2)
    return float(squares.mean(dtype=numpy.float64)), flip


def measure(name, candela, cycles, options):
    """Rows of the table: what rendered, its samples and CPU time, relMSE and FLIP."""
    path, depth = compare.SCENES[name]
    job = Job(path, depth, options.size, os.cpu_count())
    paces = [compare.seconds_per_sample(r, job, options.work) for r in (candela, cycles)]
    references = [converged(r, job, pace, options) for r, pace in zip((candela, cycles), paces)]
    output = options.work / "denoised.exr"
    first = 2
    begin = denoised_by_cycles(cycles.blender, job, first, 0, output)
    rows = {"candela": [], "Cycles": []}
    for seed in range(options.seeds):
        compare.log(f"{name}: picture {seed + 1} of {options.seeds}")
        seconds = denoised_by_candela(candela.program, job, options.spp, seed, output)
        rows["candela"].append((options.spp, seconds, *errors(denoised_layer(output), *references[0])))
        spp = max(1, first + round((seconds - begin) / paces[1]))
        seconds = denoised_by_cycles(cycles.blender, job, spp, seed, output)
        rows["Cycles"].append((spp, seconds, *errors(exr.read(output), *references[1])))
    return rows


def main():
    options = arguments()
    candela, cycles = Candela(options.candela), Cycles(options.blender)
    compare.make_scenes(options.blender)
    options.work.mkdir(parents=True, exist_ok=True)
    print("| scene, denoised | samples per pixel | CPU time [s] | relMSE | FLIP |\n|---|---|---|---|---|")
    for name in options.scenes or SCENES:
        for renderer, rows in measure(name, candela, cycles, options).items():
            spp, seconds, relmse, flip = (statistics.median(column) for column in zip(*rows))
            print(f"| {name}, {renderer} | {spp:g} | {seconds:.1f} | {relmse:.5f} | {flip:.4f} |", flush=True)
    print(f"\n{candela.version}; {cycles.version}")


if __name__ == "__main__":
    main()
