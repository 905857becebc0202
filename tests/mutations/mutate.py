#!/usr/bin/env python3
"""The test of the tests: breaks a copy of the renderer on purpose, one way at a time, and says which tests notice.

Each way of mutations.py is built in a copy of this tree below build/mutations, and the tests of its group run against
it, for two minutes at most. Prints the table of README.md, and exits with 1 if a way went unnoticed. Takes about
ninety minutes on two cores.

usage: mutate.py [WORD]...      WORD: only the ways whose names have one of them
       mutate.py --check        only says whether each way finds its place in the sources
"""
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from mutations import GROUPS

ROOT = Path(__file__).resolve().parents[2]
COPY = ROOT / "build/mutations"
BUILD = COPY / "build/release"
LIMIT = 120.0  # Seconds that the tests of one mutation may take.
PROGRAMS = ("gpu_tests", "render_tests", "unit_tests")  # In the order of a group's filters, which may end earlier.
FAILED = re.compile(r"^\[  FAILED  \] (\S+?)(?:,| \()", re.MULTILINE)
SHOWN = 4  # Names in a line of the table.


def update_copy():
    """Brings the copy to the state of this tree; touches only what differs, so that builds stay incremental."""
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True,
                            check=True)
    names = listed.stdout.splitlines()
    for path in COPY.rglob("*"):
        relative = path.relative_to(COPY)
        if path.is_file() and relative.parts[0] != "build" and relative.as_posix() not in names:
            path.unlink()
    for name in names:
        source, target = ROOT / name, COPY / name
        if source.is_file() and (not target.exists() or source.read_bytes() != target.read_bytes()):
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)


def build(filters):
    """Builds the copy's programs for a group; returns what went wrong, or nothing."""
    commands = []
    if not (BUILD / "build.ninja").exists():
        commands.append(["cmake", "--preset", "ci"])
    commands.append(["cmake", "--build", "--preset", "ci", "--target", *PROGRAMS[:len(filters)]])
    for command in commands:
        result = subprocess.run(command, cwd=COPY, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            return result.stdout + result.stderr
    return ""


def failed_tests(filters):
    """Names of the tests that fail, in order, up to the time limit."""
    failed, end = [], time.monotonic() + LIMIT
    for program, tests in zip(PROGRAMS, filters):
        try:
            output = subprocess.run([BUILD / "tests" / program, f"--gtest_filter={tests}-Slow*"], capture_output=True,
                                    text=True, errors="replace", timeout=max(1.0, end - time.monotonic()),
                                    check=False).stdout
        except subprocess.TimeoutExpired as stopped:
            output = (stopped.stdout or b"").decode(errors="replace")
        failed += [name for name in FAILED.findall(output) if name not in failed]
    return failed


def mutate(filters, name, file, old, new):
    """The tests among the filters that notice; ends the program if the source is not as expected, or does not build."""
    path = COPY / file
    original = path.read_text(encoding="utf-8")
    if original.count(old) != 1:
        sys.exit(f"{file}: \"{old}\" stands there {original.count(old)} times, not once; mend mutations.py ({name})")
    path.write_text(original.replace(old, new), encoding="utf-8")
    try:
        problem = build(filters)
        if problem:
            sys.exit(f"{name}: does not compile\n{problem[-4000:]}")
        return failed_tests(filters)
    finally:
        path.write_text(original, encoding="utf-8")


def check():
    """Says which ways do not find what they replace; the exit code."""
    misplaced = [f"{file}: \"{old}\" does not stand there once; mend mutations.py ({name})"
                 for _, ways in GROUPS for name, file, old, _ in ways
                 if (ROOT / file).read_text(encoding="utf-8").count(old) != 1]
    print("\n".join([*misplaced, f"{sum(len(ways) for _, ways in GROUPS)} ways, {len(misplaced)} misplaced"]))
    return 1 if misplaced else 0


def main():
    words = sys.argv[1:] or [""]
    if words == ["--check"]:
        sys.exit(check())
    if words in (["-h"], ["--help"]):
        sys.exit(__doc__)
    update_copy()
    print("| broken on purpose | in | tests that notice |\n|---|---|---|", flush=True)
    unnoticed = 0
    for filters, ways in GROUPS:
        chosen = [way for way in ways if any(word in way[0] for word in words)]
        problem = build(filters) if chosen else ""  # After the last way of another group.
        if problem:
            sys.exit(f"the unbroken copy does not compile\n{problem[-4000:]}")
        failed = failed_tests(filters) if chosen else []
        if failed:
            sys.exit("tests fail without any mutation: " + ", ".join(failed))
        for way in chosen:
            failed = mutate(filters, *way)
            unnoticed += not failed
            names = ", ".join(f"`{test}`" for test in failed[:SHOWN]) or "**none**"
            more = f" and {len(failed) - SHOWN} more" if len(failed) > SHOWN else ""
            print(f"| {way[0]} | `{Path(way[1]).name}` | {len(failed)}: {names}{more} |", flush=True)
    sys.exit(f"{unnoticed} unnoticed" if unnoticed else 0)


if __name__ == "__main__":
    main()
