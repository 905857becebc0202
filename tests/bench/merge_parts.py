#!/usr/bin/env python3
"""Measures `candela merge` of many parts: how much memory it takes, how much it reads, and how long.

One part is rendered, with a sample per pixel; the others are copies that claim to hold other samples, which costs the
merge as much and the test less.   usage: merge_parts.py CANDELA [--parts N] [--size WxH] [--aov LIST] [--folder DIR]
"""
import argparse
import os
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FIRST = 1_000_000  # The first sample number; all have seven digits, so that all headers have one length.


def make_parts(options, folder):
    first = folder / "part.exr"
    samples = f"{FIRST}..{FIRST + 1}".encode()
    subprocess.run([options.candela, "render", ROOT / "scenes/cornell-box.json", "--size", options.size, "--aov",
                    options.aov, "--samples", samples.decode(), "-o", first, "--quiet"], check=True)
    image = first.read_bytes()
    first.unlink()
    place = image.index(samples, image.index(b"candela.samples\0string\0"))
    for i in range(options.parts):
        with open(folder / f"part-{i:05}.exr", "wb") as file:
            file.write(image[:place] + f"{FIRST + i}..{FIRST + i + 1}".encode() + image[place + len(samples):])
    return len(image)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("candela")
    parser.add_argument("--parts", type=int, default=1000)
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--aov", default="none")
    parser.add_argument("--folder")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=options.folder) as name:
        folder = Path(name)
        size = make_parts(options, folder)
        parts = sorted(folder.glob("part-*.exr"))
        begin = time.monotonic()
        process = subprocess.Popen([options.candela, "merge", *parts, "-o", folder / "whole.exr"],
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        print(process.stdout.read().decode().splitlines()[-1])
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # It has ended, and its figures are still there.
        seconds = time.monotonic() - begin
        figures = Path(f"/proc/{process.pid}/io").read_text()
        read = int(figures.split("rchar: ")[1].split()[0])
        _, status, usage = os.wait4(process.pid, 0)
        assert status == 0, status
        print(f"{len(parts)} parts of {options.size}, {size / 1e6:.1f} MB each: {usage.ru_maxrss / 1e3:.0f} MB of memory, "
              f"{read / (size * len(parts)):.3f} times their bytes read, {seconds:.0f} s, "
              f"{usage.ru_utime + usage.ru_stime:.0f} s of CPU time")


if __name__ == "__main__":
    main()
