#!/usr/bin/env python3
"""Measures batches of pictures of glTF files, by candela and by Cycles, one process each, and prints a table.

    views     24 views around textured-100k.glb, 512x512, 64 samples
    models    200 small models, 256x256, 16 samples
    skinned   60 frames of skinned.glb, 512x512, 16 samples
    moving    60 frames of moving.glb, in which one of a million triangles' objects moves, 512x512, 16 samples

Both render the same pictures: cameras, the light of scenes/sky.hdr, 8 bounces, roulette, box filter, no denoiser. The
README beside this file says what the columns are. Models are made by scenes/make_models.py if they are missing.

usage: batches.py CANDELA [BATCH...], e.g. batches.py build/release/candela views models --blender build/bpy/bin/python
"""

import argparse
import importlib.util
import json
import math
import os
import resource
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(Path(__file__).resolve().parent / "rivals"))

import exr  # noqa: E402 (needs the path)
import pictures  # noqa: E402
from renderers import BLENDER_REMEDY, RR_DEPTH, find, last_json, run, run_in_blender  # noqa: E402

SKY = ROOT / "scenes" / "sky.hdr"
DEPTH, FPS = 8, 30
NOISE_SAMPLED = 4  # Pictures of a batch whose noise is measured.
BATCHES = {
    "views": {"files": ["textured-100k.glb"], "count": 24, "size": 512, "spp": 64},
    "models": {"files": [f"models/{i:03}.glb" for i in range(200)], "count": 200, "size": 256, "spp": 16},
    "skinned": {"files": ["skinned.glb"], "count": 60, "size": 512, "spp": 16, "frames": True},
    "moving": {"files": ["moving.glb"], "count": 60, "size": 512, "spp": 16, "frames": True},
}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("candela", metavar="CANDELA", help="the program")
    parser.add_argument("batches", metavar="BATCH", nargs="*", help=f"of {', '.join(BATCHES)} (default: all)")
    parser.add_argument("--pictures", type=int, metavar="N", help="the first N of each batch alone (default: all)")
    parser.add_argument("--spp", type=int, help="other samples per pixel")
    parser.add_argument("--blender", default=sys.executable if importlib.util.find_spec("bpy") else "blender",
                        help="the program, or a Python that has the module bpy (default: this Python if it has, else "
                        "blender)")
    parser.add_argument("--without", action="append", choices=["candela", "Cycles", "noise"], default=[],
                        help="leave it out")
    parser.add_argument("--work", type=Path, default=ROOT / "build" / "batches",
                        help="folder for models and pictures (default: build/batches)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write every figure as JSON")
    options = parser.parse_intermixed_args()
    unknown = [name for name in options.batches if name not in BATCHES]
    if unknown:
        parser.error(f"unknown batch {unknown[0]} (known: {', '.join(BATCHES)})")
    options.batches = options.batches or list(BATCHES)
    options.work = options.work.resolve()
    return options


def measured(command):
    """Wall time and CPU time [s] of a command with its helpers, and what it printed; ends if the command fails."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    printed = command()
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"wall": wall, "cpu": cpu}, printed


class Batch:
    """The pictures of a batch, or the first of them."""

    def __init__(self, name, options, count):
        told = BATCHES[name]
        self.name, self.size, self.spp = name, told["size"], options.spp or told["spp"]
        self.count = min(count or told["count"], told["count"])
        self.frames, self.views = told.get("frames", False), len(told["files"]) == 1 and not told.get("frames")
        self.files = [options.work / file for file in told["files"][:self.count]]
        self.total = told["count"]

    def words(self):
        """What candela is told of cameras and frames."""
        if self.frames:
            return ["--frames", f"0..{self.count - 1}", "--fps", FPS]
        if self.views:
            return ["--turntable", self.total, *(f"--camera=turntable_{i:03}" for i in range(self.count))]
        return ["--view", "30,20"]

    def field(self):
        return "{frame:03}" if self.frames else "{view:03}" if self.views else "{stem}"


# --- candela ---------------------------------------------------------------------------------------------------------


def render_by_candela(candela, batch, folder, extension="png", seed=0):
    folder.mkdir(parents=True, exist_ok=True)
    options = ["--size", f"{batch.size}x{batch.size}", "--spp", batch.spp, "--seed", seed, "--max-depth", DEPTH]
    options += ["--rr-depth", RR_DEPTH, "--environment", SKY, "--quiet", "--report", folder / "report.jsonl"]
    options += ["-o", folder / f"{batch.field()}.{extension}", *(["--aov", "none"] if extension == "exr" else [])]
    if not batch.frames:
        options += ["--write-cameras", folder / "cameras-{stem}.json"]
    command = [candela, "render", *batch.files, *batch.words(), *options]
    return measured(lambda: run(command))[0]


def overhead(lines):
    """Sums of the report's overheads [s]; that of a scene is in the lines of all its pictures."""
    parts = {part: 0.0 for part in lines[0]["overhead_cpu_seconds"]}
    scenes = {}
    for line in lines:
        for part, seconds in line["overhead_cpu_seconds"].items():
            if part == "scene":
                scenes[(line["scene"], line.get("frame"))] = seconds
            else:
                parts[part] += seconds
    return parts | {"scene": sum(scenes.values())}


def measure_candela(candela, batch, folder):
    result = render_by_candela(candela, batch, folder)
    lines = [json.loads(line) for line in (folder / "report.jsonl").read_text(encoding="utf-8").splitlines()]
    lines = [line for line in lines if line["state"] == "done"]
    parts = overhead(lines)
    result |= {f"{part} cpu": seconds for part, seconds in parts.items()}
    result["kernels"] = sum(line["kernels_compiled"] for line in lines)
    result["kernels wall"] = sum(line["pipeline_seconds"] for line in lines)
    result["overhead cpu"] = parts["scene"] + parts["host"] + parts["develop"]
    result["version"] = "candela {version} on {device}, {driver}".format(**lines[0])
    return result


# --- Cycles ----------------------------------------------------------------------------------------------------------


def cameras(batch, folder):
    """Matrix and angle of each picture's camera, as candela wrote them."""
    for file in batch.files:
        views = json.loads((folder / f"cameras-{file.stem}.json").read_text(encoding="utf-8"))
        for frame in views["frames"]:
            told = views | frame
            yield {"model": str(file), "camera": frame["transform_matrix"],
                   "angle": 2 * math.atan(0.5 * told["h"] / told["fl_y"])}


def render_by_cycles(blender, batch, folder, candela_folder, extension="png", seed=0, spp=None):
    folder.mkdir(parents=True, exist_ok=True)
    if batch.frames:
        jobs = [{"model": str(batch.files[0]), "frame": frame} for frame in range(batch.count)]
    else:
        jobs = list(cameras(batch, candela_folder))
    for number, job in enumerate(jobs):
        job["output"] = str(folder / f"{number:03}.{extension}")
    job = {"size": batch.size, "spp": spp or batch.spp, "depth": DEPTH, "seed": seed, "threads": os.cpu_count(),
           "fps": FPS, "environment": str(SKY), "pictures": jobs}
    (folder / "job.json").write_text(json.dumps(job), encoding="utf-8")
    script = ROOT / "tests" / "bench" / "rivals" / "batch_with_cycles.py"
    result, printed = measured(lambda: run_in_blender(blender, script, folder / "job.json"))
    return result | last_json(printed)


def measure_cycles(blender, batch, folder, candela_folder):
    """Its overhead is the time with one sample per pixel, without this sample's share."""
    result = render_by_cycles(blender, batch, folder, candela_folder)
    one = render_by_cycles(blender, batch, folder / "one", candela_folder, spp=1)
    result["version"] = f"Cycles of Blender {result['version']}"
    sample = (result["cpu"] - one["cpu"]) / (batch.spp - 1)
    result["overhead cpu"] = one["cpu"] - sample
    rendered = result.pop("pictures")
    result["scene cpu"] = sum(picture["load"]["cpu"] for picture in rendered)
    result["start wall"] = result["wall"] - sum(times["wall"] for picture in rendered for times in picture.values())
    return result


# --- Noise -----------------------------------------------------------------------------------------------------------


def noise_between(a, b):
    """Relative variance of pictures of the same with different seeds, as pictures.relmse() weighs errors."""
    a, b = exr.read(a), exr.read(b)
    mean = (a[0], a[1], [[(x + y) / 2 for x, y in zip(p, q)] for p, q in zip(a[2], b[2])])
    return 2 * pictures.relmse(a, mean), pictures.means(mean)


def measure_noise(render, batch, folder):
    """Mean relative variance of the first pictures, and the mean of their colours."""
    for seed in (1, 2):
        render(folder / f"noise-{seed}", seed)
    names = sorted(file.name for file in (folder / "noise-1").glob("*.exr"))[:batch.count]
    found = [noise_between(*(folder / f"noise-{seed}" / name for seed in (1, 2))) for name in names]
    return sum(noise for noise, _ in found) / len(found), sum(sum(means) for _, means in found) / len(found) / 3


# --- Tables ----------------------------------------------------------------------------------------------------------


def row(name, batch, result, ours):
    """Milliseconds for each picture."""
    def of(what):
        return f"{1e3 * result[what] / batch.count:.1f}" if what in result else ""

    cells = [name, of("wall"), of("cpu"), of("scene cpu"), of("host cpu"), of("develop cpu"), of("encode cpu")]
    cells += [of("overhead cpu"), f"{result['kernels']}, {result['kernels wall']:.2f} s" if "kernels" in result else ""]
    cells += [f"{result['noise']:.5f}" if "noise" in result else ""]
    if "noise" in result and "noise" in ours:
        cells += [f"{ours[what] * ours['noise'] / (result[what] * result['noise']):.2f}" for what in ("wall", "cpu")]
        cells += [f"{result['mean'] / ours['mean'] - 1:+.1%}"]
    else:
        cells += ["", "", ""]
    return "| " + " | ".join(cells) + " |"


def print_table(batch, results):
    print(f"\n**{batch.name}**: {batch.count} of {batch.total} pictures, {batch.size}x{batch.size}, {batch.spp} samples; "
          "times in milliseconds for each picture\n")
    columns = ["", "wall", "CPU", "of it: scene", "host", "develop", "encode", "overhead", "kernels", "relMSE",
               "candela / it, wall at equal noise", "CPU", "mean"]
    print("| " + " | ".join(columns) + " |\n" + "|---" * len(columns) + "|")
    for name, result in results.items():
        print(row(name, batch, result, results.get("candela", {})), flush=True)
    if "Cycles" in results:
        print(f"\nStarting Blender takes {results['Cycles']['start wall']:.1f} s, which its times include.", flush=True)


def measure(name, options):
    batch, folder = Batch(name, options, options.pictures), options.work / name
    sample = Batch(name, options, min(batch.count, NOISE_SAMPLED))
    results = {}
    if "candela" not in options.without:
        candela = find(options.candela, "build it, or give the path of the program")
        results["candela"] = measure_candela(candela, batch, folder / "candela")
        if "noise" not in options.without:
            results["candela"]["noise"], results["candela"]["mean"] = measure_noise(
                lambda to, seed: render_by_candela(candela, sample, to, "exr", seed), sample, folder / "candela")
    if "Cycles" not in options.without:
        blender = find(options.blender, f"{BLENDER_REMEDY}, or use --without Cycles")
        results["Cycles"] = measure_cycles(blender, batch, folder / "cycles", folder / "candela")
        if "noise" not in options.without:
            results["Cycles"]["noise"], results["Cycles"]["mean"] = measure_noise(
                lambda to, seed: render_by_cycles(blender, sample, to, folder / "candela", "exr", seed), sample,
                folder / "cycles")
    print_table(batch, results)
    return results


def main():
    options = arguments()
    if not (options.work / "moving.glb").exists():
        run([sys.executable, ROOT / "tests" / "bench" / "scenes" / "make_models.py", options.work])
    results = {}
    for name in options.batches:
        results[name] = measure(name, options)
        if options.json:
            options.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    versions = {result["version"] for batch in results.values() for result in batch.values()}
    print("\n" + "; ".join(sorted(versions)))


if __name__ == "__main__":
    main()
