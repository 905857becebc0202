#!/usr/bin/env python3
"""Runs the commands of README.md and of the pages in docs/ as a reader would. Each page has a folder of its own, empty
but for links to the scenes, the tests and the program, as if it were the root of the repository; the page's commands
run there in order. Every ```sh block is run, so a command of an unknown kind is an error; other blocks are not run.
Scripts (sh, python3) only have to exist, and cmake and ctest are left to the stages that run them: this check is part
of what they do. What would take minutes is cut short: a rendering uses at most 16 samples per pixel and, if it is not a
crop, 128 pixels along each side; a benchmark runs once at the smallest sizes, the commands in the captions of pictures
use a single sample, and the selftest, which has a test of its own, shows its help.

usage: readme.py CANDELA PAGE...      Prints each command and what went wrong; exits 1 if anything did.
"""
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CAPTION = re.compile(r"`(candela\s+render\s[^`]*)`")
BLOCK = re.compile(r"^```sh\n(.*?)^```", re.MULTILINE | re.DOTALL)
SPP = re.compile(r"--spp (\d+)")
MAX_SPP = 16
SIZE = re.compile(r"--size (\d+)x(\d+)")
MAX_SIDE = 128
FIELD = re.compile(r"\{[^}]*\}")  # In the names of several files.
SHORTER = {"bench": " --runs 1 --spp 1 --triangles 72 --rays 64", "selftest": " --help"}  # What is added to a command.
WRITES = ("-o", "--output", "--heatmap", "--report")  # Options whose value is a file that must exist afterwards.


def smaller(size):
    """An option --size, with at most MAX_SIDE along each side."""
    return f"--size {min(int(size[1]), MAX_SIDE)}x{min(int(size[2]), MAX_SIDE)}"


def commands(text):
    """The commands of all ```sh blocks, continued lines joined, comments left out; the longest are cut short."""
    lines = "".join(BLOCK.findall(text)).replace("\\\n", " ").splitlines()
    found = [" ".join(re.sub(r"(^|\s)#.*", "", line).split()) for line in lines]
    found = [SPP.sub(lambda spp: f"--spp {min(int(spp[1]), MAX_SPP)}", line) for line in found if line]
    found = [SIZE.sub(smaller, line) for line in found]
    return [small(line) + SHORTER.get(subcommand(line), "") for line in found]


def small(command):
    """The command, with a size and samples if it renders and has none."""
    size = f" --size {MAX_SIDE}x{MAX_SIDE}" if not re.search(r" --(size|crop)\b", command) else ""
    spp = f" --spp {MAX_SPP}" if not re.search(r" --(spp|samples|target-error|time-limit)\b", command) else ""
    return re.sub(r"\bcandela render\b", f"candela render{size}{spp}", command)


def caption_commands(text):
    """The commands in running text, each at one sample per pixel."""
    found = [" ".join(command.split()) for command in CAPTION.findall(text)]
    return [small(re.sub(r" --spp \d+| --adaptive", "", command) + " --spp 1") for command in found
            if "scenes/" in command]


def subcommand(command):
    """The subcommand of candela that a command runs, such as "render"; an empty string if it runs another program."""
    words = shlex.split(command, comments=True)
    return words[1] if Path(words[0]).name == "candela" and len(words) > 1 else ""


def written_files(command):
    words = shlex.split(command, comments=True)
    return [value for option, value in zip(words, words[1:]) if option in WRITES and value != "-"]


def try_command(command, folder, cache):
    """Runs the command in the folder, with compiled kernels in `cache`. Returns what went wrong, or an empty string."""
    words = shlex.split(command, comments=True)
    if words[0] in ("cmake", "ctest"):
        return ""
    if words[0] in ("sh", "python3"):
        return "" if Path(ROOT, words[1]).is_file() else f"there is no {words[1]}"
    if not subcommand(command):
        return "is of a kind that this check cannot try"
    environment = os.environ | {"PATH": f"{folder}/build/release:{os.environ['PATH']}", "XDG_CACHE_HOME": cache}
    result = subprocess.run(["sh", "-c", command], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                            capture_output=True, text=True, check=False)
    if result.returncode != 0:
        return f"exits with {result.returncode}:\n{result.stdout}{result.stderr}"
    absent = [name for name in written_files(command) if not any(Path(folder).glob(FIELD.sub("*", name)))]
    return f"did not write {', '.join(absent)}" if absent else ""


def try_page(page, candela, cache):
    """Tries the commands of one page, with compiled kernels in `cache`. Returns how many there are, and how many went wrong."""
    text = page.read_text(encoding="utf-8")
    found = commands(text) + caption_commands(text)
    problems = 0
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "build/release").mkdir(parents=True)
        Path(folder, "build/release/candela").symlink_to(candela)
        for name in ("scenes", "tests"):
            Path(folder, name).symlink_to(ROOT / name)
        for command in found:
            start = time.monotonic()
            problem = try_command(command, folder, cache)
            print(f"{time.monotonic() - start:6.1f} s  {command}", flush=True)
            if problem:
                problems += 1
                print(f"  {problem}")
    return len(found), problems


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    candela, *pages = (Path(argument).resolve() for argument in sys.argv[1:])
    count, problems = 0, 0
    with tempfile.TemporaryDirectory() as cache:
        for page in pages:
            print(page.relative_to(ROOT), flush=True)
            counts = try_page(page, candela, cache)
            count, problems = count + counts[0], problems + counts[1]
    if count == 0:
        problems += 1
        print("no command found")
    print(f"{count} commands, {problems} problems")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
