#!/usr/bin/env python3
"""Renders every glTF file in a folder, whoever wrote it, and writes a table of what became of each.

usage: try_folder.py CANDELA FOLDER TABLE.md [--sheet SHEET.png] [--size WxH] [--spp N] [--memory-limit SIZE]
                     [--timeout SECONDS]

The folder, at any depth, may hold Khronos' sample assets or asset generator, or the files of three.js, Babylon, Bevy,
model-viewer, assimp or others: all .glb, .gltf and .vrm files are rendered, one after the other. A row has whether the
file opened, the exit code, CPU time, the greatest memory, the number of notices and the first of them, without the file's
own name. Below the table, each kind of notice has a line: its words without names and numbers, and in how many files it
is. The sheet has a tile for each file, a red one for those that failed. Exits 1 if a file crashed candela or took too
long; one that is refused with a message is a result.
"""

import argparse
import collections
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import png
from contact_sheet import FAILED, GAP, label, paste
from stage import INK, LINE, Canvas

SUFFIXES = (".glb", ".gltf", ".vrm")
REFUSED = (1, 5)  # Exit codes with which files are refused: they cannot be read, or need too much memory.
NOTICE = re.compile(r"candela: (error|warning): (.*)")
COLUMNS = 8

Result = collections.namedtuple("Result", "file code seconds mebibytes notices")


def run(command, timeout):
    """Runs a command; its exit code, or the negative number of the signal that ended it; CPU seconds; MiB; stderr."""
    with tempfile.TemporaryFile() as said:
        child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=said)
        end = time.monotonic() + timeout
        while True:
            pid, status, usage = os.wait4(child.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() > end:
                child.kill()
                _, status, usage = os.wait4(child.pid, 0)
                break
            time.sleep(0.02)
        child.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        text = said.read().decode("utf-8", "replace")
    return child.returncode, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, text


def try_file(options, file, picture):
    command = [options.candela, "render", str(file), "-o", str(picture), "--size", options.size, "--spp",
               str(options.spp), "--memory-limit", options.memory_limit, "-q"]
    code, seconds, mebibytes, text = run(command, options.timeout)
    notices = [f"{kind}: {said.replace(f'{file}: ', '').replace(str(file), '')}" for kind, said in NOTICE.findall(text)]
    if code not in (0, *REFUSED):
        notices.insert(0, "took too long" if code == -signal.SIGKILL else f"CRASHED with {code}: {text[-200:]}")
    return Result(file, code, seconds, mebibytes, notices)


def without_names(notice):
    """The words of a notice that other files' notices have, too."""
    return re.sub(r"#?/[\w/.:~-]+|-?\d+(\.\d+)?(e[+-]?\d+)?", "…", re.sub(r'"[^"]*"', '"…"', notice))


def cell(text, most=160):
    text = text.replace("|", "\\|").replace("\n", " ")
    return text if len(text) <= most else text[:most] + "…"


def table(results, folder):
    opened = sum(result.code == 0 for result in results)
    quiet = sum(result.code == 0 and not result.notices for result in results)
    lines = [f"{opened} of {len(results)} files opened, {quiet} of them without a notice; "
             f"{sum(r.seconds for r in results):.0f} s of CPU time.", "",
             "| file | code | CPU [s] | MiB | notices | first |", "|---|---|---|---|---|---|"]
    for result in results:
        first = result.notices[0] if result.notices else ""
        lines.append(f"| {cell(str(result.file.relative_to(folder)))} | {result.code} | {result.seconds:.1f} "
                     f"| {result.mebibytes:.0f} | {len(result.notices)} | {cell(first)} |")
    kinds = collections.Counter(kind for result in results
                                for kind in {without_names(n) for n in result.notices})
    lines += ["", "| files | notice |", "|---|---|"]
    lines += [f"| {count} | {cell(kind, 400)} |" for kind, count in kinds.most_common()]
    return "\n".join(lines) + "\n"


class Sheet:
    """A tile for each of `count` files."""

    def __init__(self, count, size):
        self.size, self.columns = size, min(COLUMNS, count)
        self.across, self.down = size[0] + GAP, size[1] + LINE + 2 * GAP
        self.canvas = Canvas(self.columns * self.across + GAP, -(-count // self.columns) * self.down + GAP, (24, 24, 28))

    def add(self, number, name, picture):
        x, y = GAP + number % self.columns * self.across, GAP + number // self.columns * self.down
        if picture:
            paste(self.canvas, png.read(picture), x, y)
        else:
            self.canvas.fill((x, y, x + self.size[0], y + self.size[1]), FAILED)
        self.canvas.text(x + 2, y + self.size[1] + GAP, label(name)[:self.size[0] // 6], INK)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("candela")
    parser.add_argument("folder", type=Path)
    parser.add_argument("table", type=Path)
    parser.add_argument("--sheet", type=Path)
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--spp", type=int, default=8)
    parser.add_argument("--memory-limit", default="4GiB")
    parser.add_argument("--timeout", type=float, default=300)
    options = parser.parse_args()
    files = sorted(f for f in options.folder.rglob("*") if f.suffix.lower() in SUFFIXES and f.is_file())
    if not files:
        sys.exit(f"try_folder.py: no {', '.join(SUFFIXES)} files in {options.folder}")
    sheet = Sheet(len(files), tuple(map(int, options.size.split("x")))) if options.sheet else None
    results = []
    with tempfile.TemporaryDirectory() as temporary:
        for number, file in enumerate(files):
            picture = Path(temporary, "picture.png")
            result = try_file(options, file, picture)
            results.append(result)
            print(f"{number + 1} of {len(files)}: {file}: {result.code}", flush=True)
            if sheet:
                sheet.add(number, file.stem, picture.read_bytes() if result.code == 0 else None)
            picture.unlink(missing_ok=True)
    options.table.write_text(table(results, options.folder), encoding="utf-8")
    if sheet:
        options.sheet.write_bytes(sheet.canvas.png())
    print(f"{sum(r.code == 0 for r in results)} of {len(results)} files opened: {options.table}")
    return any(result.code not in (0, *REFUSED) for result in results)


if __name__ == "__main__":
    sys.exit(main())
