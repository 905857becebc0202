"""Runs candela and its rivals on one scene, all with the same settings.

Each renderer's render() writes an OpenEXR picture and returns {"cpu", "wall": seconds; "rays": per sample, or None
where they are not counted}. Seconds are those that all samples after the first of each pixel took, over all threads,
scaled to all samples, so that starting, compiling and preparing the scene are excluded.
"""

import json
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
# Bounces that always survive. In all three, roulette begins after the second scattering: Cycles cannot begin earlier.
RR_DEPTH = 1
BLENDER_REMEDY = "install Blender, or name it by --blender: its program, or a Python with the module bpy"


@dataclass
class Job:
    scene: Path
    depth: int  # The most scattering vertices.
    width: int  # Of the picture, and its height [pixels].
    threads: int


def run(command):
    """Standard output of a program; ends with its messages if it fails."""
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\nended with {result.returncode}:\n{result.stdout}{result.stderr}")
    return result.stdout


def last_json(text):
    """The last line that is a JSON object."""
    return json.loads([line for line in text.splitlines() if line.startswith("{")][-1])


def without_start(one, all_samples, spp):
    """CPU time and wall time [s] of spp samples of each pixel, from those of renderings with one and with spp."""
    return {what: spp / (spp - 1) * (all_samples[what] - one[what]) for what in ("cpu", "wall")}


class Candela:
    def __init__(self, program, light_sampler=None):
        """With a light sampler that is not the default, its name is in that of the renderer."""
        self.program = find(program, "build it, or give the path of the program")
        self.name = f"candela-{light_sampler}" if light_sampler else "candela"
        self.options = ["--light-sampler", light_sampler] if light_sampler else []
        self.version = None  # Known after the first run.

    def render(self, job, spp, seed, output):
        options = ["--size", f"{job.width}x{job.width}", "--max-depth", job.depth, "--rr-depth", RR_DEPTH]
        options += ["--seed", seed, "--aov", "none", "--quiet", "--report", "-", "--allow-any-folder"]
        options += self.options
        one, all_samples = (
            json.loads(run([self.program, "render", job.scene, "-o", output, "--spp", n, *options])) for n in (1, spp)
        )
        self.version = "candela {version} on {device}, {driver}".format(**all_samples)
        for report in (one, all_samples):
            report |= {"cpu": report["cpu_seconds"], "wall": report["render_seconds"]}
        return without_start(one, all_samples, spp) | {"rays": all_samples["rays_per_sample"]}


class Tracer:
    name = "tracer"

    def __init__(self, program):
        remedy = "build the target `tracer` with -DCANDELA_EMBREE=ON, name it by --tracer, or use --without tracer"
        self.program = find(program, remedy)
        self.version = "tracer.cpp over Embree 3"

    def render(self, job, spp, seed, output):
        settings = [job.depth, RR_DEPTH, seed, job.threads]
        one, all_samples = (
            json.loads(run([self.program, job.scene, output, job.width, n, *settings])) for n in (1, spp)
        )
        return without_start(one, all_samples, spp) | {"rays": all_samples["rays"]}


class Cycles:
    name = "Cycles"

    def __init__(self, blender):
        self.blender = find(blender, f"{BLENDER_REMEDY}, or use --without Cycles")
        self.version = None  # Known after the first run.

    def render(self, job, spp, seed, output):
        settings = [job.width, spp, job.depth, seed, job.threads]
        figures = last_json(run_in_blender(self.blender, HERE / "render_with_cycles.py", job.scene, output, *settings))
        self.version = f"Cycles of Blender {figures['version']}"
        return without_start(figures["one"], figures["all"], spp) | {"rays": None}


def run_in_blender(blender, script, *words):
    """Standard output of a script in Blender: the program without windows or the user's settings, which fails if the
    script does, or a Python with the module `bpy`, which is Blender without the program."""
    python = Path(blender).name.startswith("python")
    options = [] if python else ["-b", "--factory-startup", "--python-exit-code", "1", "-P"]
    return run([blender, *options, script, "--", *words])


def find(program, remedy):
    found = shutil.which(program)
    if not found:
        sys.exit(f"cannot run {program}: {remedy}")
    return found
