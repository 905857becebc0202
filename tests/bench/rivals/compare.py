#!/usr/bin/env python3
"""Measures whole renders of candela beside Cycles and a minimal tracer over Embree, and prints a table per scene.

All three read the same scene files and do the same work: size, depth, Russian roulette, box filter, no denoiser, no
adaptive sampling. Runs take turns, because machines are noisy; figures are medians, and CPU time is that of rendering
alone, over all threads. relMSE (see pictures.py) compares each renderer with its own converged picture, so that a
difference of models is not treated as noise; how far these pictures are apart is printed with them. The README beside
this folder says more.

usage: compare.py CANDELA [SCENE...], e.g. compare.py build/release/candela cornell-box --runs 5
"""

import argparse
import hashlib
import importlib.util
import json
import os
import statistics
import sys
from pathlib import Path

import exr
import pictures
from renderers import BLENDER_REMEDY, Candela, Cycles, Job, Tracer, find, run, run_in_blender

ROOT = Path(__file__).resolve().parents[3]
SCENES_FOLDER = ROOT / "tests" / "bench" / "scenes"
LIT_BY_IMAGE = [f"lit-{name}" for name in ("primitives", "suzanne", "textures", "glass", "lights")]
# Scene file, and the most scattering vertices.
SCENES = {
    "cornell-box": (ROOT / "scenes" / "cornell-box.json", 5),
    "suzannes": (SCENES_FOLDER / "suzannes.json", 8),
    "many-lights": (SCENES_FOLDER / "made" / "many-lights.json", 5),
    "sky": (SCENES_FOLDER / "sky.json", 5),
    "textured": (SCENES_FOLDER / "made" / "textured.json", 5),
    "principled": (SCENES_FOLDER / "made" / "principled.json", 8),
    "street": (SCENES_FOLDER / "made" / "street" / "street.json", 6),
    "room": (SCENES_FOLDER / "made" / "room.json", 6),
    "wax": (SCENES_FOLDER / "wax.json", 1024),
    "milk": (SCENES_FOLDER / "made" / "milk.json", 1024),
    "haze": (SCENES_FOLDER / "haze.json", 64),
} | {name: (SCENES_FOLDER / "made" / f"{name}.json", 8) for name in LIT_BY_IMAGE}
# What the tracer does not know.
BEYOND_THE_TRACER = {"textured": "textures", "principled": "principled materials", "street": "textures",
                     "room": "spheres that emit", "wax": "media", "milk": "media", "haze": "media"}
BEYOND_THE_TRACER |= {name: "principled materials" for name in LIT_BY_IMAGE}
MADE_BY_PYTHON = {
    "many-lights.json": [SCENES_FOLDER / "make_many_lights.py"],
    "room.json": [SCENES_FOLDER / "make_room.py"],
    "milk.json": [SCENES_FOLDER / "make_milk.py"],
    "street/street.json": [ROOT / "scenes" / "make_street.py", SCENES_FOLDER / "made" / "street"],
}
MADE_BY_BLENDER = {
    "suzanne.ply": "make_suzanne.py",
    "textured.json": "make_textured.py",
    "principled.json": "make_principled.py",
    f"{LIT_BY_IMAGE[0]}.json": "make_lit_by_image.py",
}
CALIBRATION_SPP = 8
REFERENCE_SEED = 1000  # The measured runs have the seeds 0, 1, ...


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("candela", metavar="CANDELA", help="the program")
    parser.add_argument("scenes", metavar="SCENE", nargs="*", help=f"of {', '.join(SCENES)} (default: all)")
    parser.add_argument("--runs", type=int, default=3, help="of each renderer and scene (default: 3)")
    parser.add_argument("--seconds", type=float, default=10, help="CPU time of a run [s] (default: 10)")
    parser.add_argument("--reference", type=float, default=16, metavar="N",
                        help="converged pictures take N times the CPU time of a run (default: 16)")
    parser.add_argument("--size", type=int, default=512, help="width and height of the pictures (default: 512)")
    parser.add_argument("--threads", type=int, default=os.cpu_count(),
                        help="of the rivals; candela's driver takes all cores (default: all cores)")
    parser.add_argument("--tracer", help="the program (default: beside candela)")
    parser.add_argument("--blender", default=sys.executable if importlib.util.find_spec("bpy") else "blender",
                        help="the program, or a Python that has the module bpy (default: this Python if it has, else "
                        "blender)")
    parser.add_argument("--without", action="append", choices=["Cycles", "tracer"], default=[], help="leave it out")
    parser.add_argument("--light-sampler", action="append", choices=["uniform", "power"], default=[],
                        help="also measure candela with this one instead of its tree")
    parser.add_argument("--work", type=Path, default=ROOT / "build" / "rivals",
                        help="folder for pictures; converged ones are kept there (default: build/rivals)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every run as JSON")
    options = parser.parse_intermixed_args()
    unknown = [name for name in options.scenes if name not in SCENES]
    if unknown:
        parser.error(f"unknown scene {unknown[0]} (known: {', '.join(SCENES)})")
    if options.runs < 1 or options.seconds <= 0 or options.reference <= 0:
        parser.error("--runs, --seconds and --reference must be above 0")
    options.scenes = options.scenes or list(SCENES)
    return options


def make_scenes(blender):
    """Makes what the scenes need and the repository does not have."""
    for made, command in MADE_BY_PYTHON.items():
        if not (SCENES_FOLDER / "made" / made).exists():
            run([sys.executable, *command])
    for made, script in MADE_BY_BLENDER.items():
        if not (SCENES_FOLDER / "made" / made).exists():
            run_in_blender(find(blender, f"{BLENDER_REMEDY}; it makes {made}"), SCENES_FOLDER / script)


def renderers(options):
    chosen = [Candela(options.candela), *(Candela(options.candela, name) for name in options.light_sampler)]
    if "Cycles" not in options.without:
        chosen.append(Cycles(options.blender))
    if "tracer" not in options.without:
        chosen.append(Tracer(options.tracer or Path(options.candela).resolve().parent / "tracer"))
    return chosen


def log(text):
    print(text, file=sys.stderr, flush=True)


def seconds_per_sample(renderer, job, work):
    """CPU time of one sample of every pixel [s], roughly."""
    return renderer.render(job, CALIBRATION_SPP, 0, work / "calibration.exr")["cpu"] / CALIBRATION_SPP


def converged(renderer, job, pace, seconds, work, seed=REFERENCE_SEED):
    """The renderer's picture after that CPU time, and its samples per pixel; kept in the folder `work`."""
    told = f"{job.scene.read_text(encoding='utf-8')} {job.depth} {job.width} {seconds} {seed} {renderer.version}"
    stem = f"{job.scene.stem}-{renderer.name}-{hashlib.sha256(told.encode()).hexdigest()[:8]}"
    picture, figures = work / f"{stem}.exr", work / f"{stem}.json"
    if not figures.exists():
        spp = max(2, round(seconds / pace))
        log(f"{job.scene.stem}: {renderer.name} renders its converged picture, {spp} samples per pixel")
        renderer.render(job, spp, seed, picture)
        figures.write_text(json.dumps({"spp": spp}), encoding="utf-8")
    return exr.read(picture), json.loads(figures.read_text(encoding="utf-8"))["spp"]


def measure(renderer, job, pace, seed, reference, options):
    """One run. Its relMSE is scaled from its own CPU time to options.seconds, as if errors fell with 1 / time, and
    freed from the reference's share, as if they fell with 1 / samples."""
    picture, reference_spp = reference
    spp = max(2, round(options.seconds / pace))
    output = options.work / f"{job.scene.stem}-{renderer.name}-{seed}.exr"
    figures = renderer.render(job, spp, seed, output)
    error = pictures.relmse(exr.read(output), picture) / (1 + spp / reference_spp)
    samples = 1e-6 * job.width**2 * spp
    return figures | {
        "spp": spp,
        "seed": seed,
        "cpu_speed": samples * job.threads / figures["cpu"],
        "wall_speed": samples / figures["wall"],
        "relmse": error * figures["cpu"] / options.seconds,
    }


def measure_scene(name, chosen, options):
    """Runs, means and differences of the converged pictures, by renderer."""
    path, depth = SCENES[name]
    if name in BEYOND_THE_TRACER:
        chosen = [renderer for renderer in chosen if not isinstance(renderer, Tracer)]
    job = Job(path, depth, options.size, options.threads)
    paces = [seconds_per_sample(renderer, job, options.work) for renderer in chosen]
    reference_seconds = options.reference * options.seconds
    references = [converged(r, job, pace, reference_seconds, options.work) for r, pace in zip(chosen, paces)]
    results = {}
    for renderer, (picture, spp) in zip(chosen, references):
        whole, blocks = pictures.differences(picture, references[0][0])
        results[renderer.name] = {"runs": [], "reference_spp": spp, "means": pictures.means(picture),
                                  "mean_difference": whole, "block_difference": blocks}
    for seed in range(options.runs):
        for renderer, pace, reference in zip(chosen, paces, references):
            log(f"{name}: run {seed + 1} of {options.runs}, {renderer.name}")
            results[renderer.name]["runs"].append(measure(renderer, job, pace, seed, reference, options))
    return {"scene": str(path.relative_to(ROOT)), "depth": depth, "renderers": results}


def median(result, what):
    return statistics.median(run[what] for run in result["runs"])


def spread(result, what, digits):
    """Median, least and largest."""
    values = sorted(run[what] for run in result["runs"])
    return f"{statistics.median(values):.{digits}f} ({values[0]:.{digits}f} .. {values[-1]:.{digits}f})"


def ratio(ours, result, what):
    return f"{median(ours, what) / median(result, what):.2f}"


def print_scene(name, scene, options):
    """A table of Markdown; ratios above 1 are in favour of candela for speed, below 1 for relMSE."""
    results = scene["renderers"]
    ours = results["candela"]
    print(f"\n**{name}**, {options.size}x{options.size}, depth {scene['depth']}\n")
    columns = ["", f"Msamples/s of CPU time, {options.threads} cores", "candela / it", "of wall time"]
    columns += ["rays per sample", f"relMSE after {options.seconds:g} s of CPU time", "candela / it"]
    print("| " + " | ".join(columns) + " |\n" + "|---" * len(columns) + "|")
    for renderer, result in results.items():
        rays = result["runs"][0]["rays"]
        row = [renderer, spread(result, "cpu_speed", 2), ratio(ours, result, "cpu_speed")]
        row += [f"{median(result, 'wall_speed'):.2f}", f"{rays:.2f}" if rays else ""]
        row += [spread(result, "relmse", 5), ratio(ours, result, "relmse")]
        print("| " + " | ".join(row) + " |")
    if name in BEYOND_THE_TRACER:
        print(f"\nThe tracer knows no {BEYOND_THE_TRACER[name]}.")
    print("\nConverged, the pictures have these means R, G, B, and differ from candela's by so much of the mean, and")
    print(f"of blocks of {pictures.BLOCK}x{pictures.BLOCK} pixels (root mean square):")
    for renderer, result in results.items():
        means = ", ".join(f"{mean:.4f}" for mean in result["means"])
        apart = f"{100 * result['mean_difference']:+.2f} %, {100 * result['block_difference']:.2f} %"
        print(f"{renderer} {means} ({result['reference_spp']} samples per pixel): {apart}", flush=True)


def main():
    options = arguments()
    chosen = renderers(options)
    make_scenes(options.blender)
    options.work.mkdir(parents=True, exist_ok=True)
    scenes = {}
    for name in options.scenes:
        scenes[name] = measure_scene(name, chosen, options)
        print_scene(name, scenes[name], options)
        if options.json:
            settings = {key: str(value) for key, value in vars(options).items()}
            record = {"settings": settings, "renderers": [r.version for r in chosen], "scenes": scenes}
            options.json.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    print("\n" + "; ".join(renderer.version for renderer in chosen))


if __name__ == "__main__":
    main()
