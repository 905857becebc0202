#!/usr/bin/env python3
"""Measures what a task on a cluster costs besides its samples: the start of the program, by itself and as a task of
Slurm on two nodes of this computer; and how many bytes a part and a checkpoint of 1920x1080 have.
usage: task_overhead.py CANDELA [--tasks N]
"""
import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/slurm"))
from cluster import Cluster, wait_until  # noqa: E402

SCENE = ROOT / "scenes/cornell-box.json"


def measure_start(candela, folder):
    command = [candela, "render", SCENE, "--size", "16x16", "--spp", "1", "-o", folder / "a.exr", "--quiet"]
    subprocess.run(command, check=True)  # Kernels are compiled after this.
    begin = time.monotonic()
    for _ in range(10):
        subprocess.run(command, check=True)
    print(f"a rendering of one sample of 16x16, kernels compiled before: {(time.monotonic() - begin) / 10:.2f} s")


def measure_slurm(candela, folder, tasks):
    with Cluster(folder) as cluster:
        begin = time.monotonic()
        cluster.run(ROOT / "integrations/slurm/submit.sh", "--part", "1", SCENE, "--spp", tasks, "--size", "16x16", "-o",
                    folder / "whole.exr", CANDELA=str(candela))
        wait_until("the merged picture", (folder / "whole.exr").exists)
        seconds = time.monotonic() - begin
    print(f"{tasks} tasks of one sample of 16x16 on 2 nodes, their merge included: {seconds:.0f} s, "
          f"{2 * seconds / tasks:.2f} s a task and node")


def measure_files(candela, folder):
    for aov in ("none", "all"):
        part, state = folder / "part.exr", folder / "part.state"
        subprocess.run([candela, "render", SCENE, "--size", "1920x1080", "--spp", "8", "--aov", aov, "-o", part,
                        "--checkpoint", state, "--quiet"], check=True)
        print(f"--aov {aov}, 1920x1080: part {part.stat().st_size / 1e6:.0f} MB, "
              f"checkpoint {state.stat().st_size / 1e6:.0f} MB")
        state.unlink()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("candela", type=Path)
    parser.add_argument("--tasks", type=int, default=100)
    options = parser.parse_args()
    candela = options.candela.resolve()
    with tempfile.TemporaryDirectory(prefix="candela-", dir="/tmp") as folder:
        measure_start(candela, Path(folder))
        measure_files(candela, Path(folder))
        measure_slurm(candela, Path(folder), options.tasks)


if __name__ == "__main__":
    main()
