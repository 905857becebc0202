#!/usr/bin/env python3
"""Runs the commands of README.md, in order, as a reader would, but in an empty folder beside links to the scenes, the
tests and the program. Every ```sh block counts, so a command of a kind that is unknown here is an error. Shell scripts
must only exist: this check is a part of what they do. What would take minutes is cut short: the commands in the captions
of pictures run with a single sample per pixel, a benchmark once and at the smallest sizes, and the selftest, which has a
test of its own, shows its help.

usage: readme.py README CANDELA      Prints each command and what went wrong; exits 1 if anything did.
"""
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
from pathlib import Path

CAPTION = re.compile(r"`(candela render [^`]*)`")
BLOCK = re.compile(r"^```sh\n(.*?)^```", re.MULTILINE | re.DOTALL)
WRITES = ("-o", "--output", "--heatmap", "--report")  # Options whose value is a file that must be there afterwards.


def commands(text):
    """The commands of all ```sh blocks, continued lines joined, comments left out; the longest are cut short."""
    lines = "".join(BLOCK.findall(text)).replace("\\\n", " ").splitlines()
    found = [line.strip() for line in lines if line.strip() and not line.strip().startswith("#")]
    shorter = {"candela bench": " --runs 1 --spp 1 --triangles 72 --rays 64", "candela selftest": " --help"}
    return [line + next((end for start, end in shorter.items() if line.startswith(start)), "") for line in found]


def caption_commands(text):
    """The commands in running text, each at one sample per pixel."""
    found = [" ".join(command.split()) for command in CAPTION.findall(text)]
    return [re.sub(r" --spp \d+", "", command) + " --spp 1" for command in found if "scenes/" in command]


def written_files(command):
    words = shlex.split(command, comments=True)
    return [value for option, value in zip(words, words[1:]) if option in WRITES and value != "-"]


def try_command(command, root, folder):
    """Runs the command in the folder. Returns what went wrong, or an empty string."""
    words = shlex.split(command, comments=True)
    if words[0] == "sh":
        return "" if Path(root, words[1]).is_file() else f"there is no {words[1]}"
    if Path(words[0]).name not in ("candela", "python3"):
        return "is of a kind that this check cannot try"
    environment = os.environ | {"PATH": f"{folder}/build/release:{os.environ['PATH']}", "XDG_CACHE_HOME": folder}
    result = subprocess.run(["sh", "-c", command], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                            capture_output=True, text=True, check=False)
    if result.returncode != 0:
        return f"exits with {result.returncode}:\n{result.stdout}{result.stderr}"
    absent = [name for name in written_files(command) if not Path(folder, name).is_file()]
    return f"did not write {', '.join(absent)}" if absent else ""


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    readme, candela = (Path(argument).resolve() for argument in sys.argv[1:])
    text = readme.read_text(encoding="utf-8")
    found = commands(text) + caption_commands(text)
    problems = 0
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "build/release").mkdir(parents=True)
        Path(folder, "build/release/candela").symlink_to(candela)
        for name in ("scenes", "tests"):
            Path(folder, name).symlink_to(readme.parent / name)
        for command in found:
            start = time.monotonic()
            problem = try_command(command, readme.parent, folder)
            print(f"{time.monotonic() - start:6.1f} s  {command}", flush=True)
            if problem:
                problems += 1
                print(f"  {problem}")
    if not any("candela " in command for command in found):
        problems += 1
        print(f"{readme}: no command of candela found")
    print(f"{len(found)} commands, {problems} problems")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
