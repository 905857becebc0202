#!/usr/bin/env python3
"""Compares the triangles that candela reads from glTF files, posed by their animations, with a second reader's.

usage: check_pose.py DUMP_GEOMETRY [FOLDER_OR_FILE]... [--verbose]

Without a folder or file, it reads the models of make_models.py. Needs numpy. DUMP_GEOMETRY is the program of dump_geometry.cpp. The second reader is pose.py: hierarchies, all
interpolations, skins and morph targets in double precision. Every file is compared at rest, and at eleven times of each
of its animations: before, between and after the keys. The tolerances are those of check_geometry.py. Ends with 1 if
anything differs.
"""

import collections
import struct
import sys
import tempfile
from pathlib import Path

import make_models
import pose
import triangles

TOLERANCE = 1e-6  # Relative to the greatest coordinate.
# Of an animation's duration; odd numbers, so that most lie between keys.
TIMES = (-0.1, 0.0, 0.0713, 0.1931, 0.3307, 0.4519, 0.5, 0.6607, 0.8123, 0.9371, 1.1)


def compare(dump, file, animation=None, time=None):
    options = [] if animation is None else ["--animation", str(animation), "--time", repr(time)]
    ours = triangles.of_candela(dump, file, *options)
    theirs = pose.triangles(file, animation, time)
    tolerance = TOLERANCE * max(triangles.extent(ours), triangles.extent(theirs))
    return triangles.differences(ours, theirs, tolerance)[0], len(ours)


def kinds(document):
    """What a file has that poses it."""
    found = {"skins"} if document.get("skins") else set()
    if any("targets" in p for mesh in document.get("meshes", []) for p in mesh["primitives"]):
        found.add("morph targets")
    for animation in document.get("animations", []):
        found |= {s.get("interpolation", "LINEAR") for s in animation["samplers"]}
    return found


def poses(dump, file):
    """Yields what differs in each pose of a file."""
    yield "at rest", *compare(dump, file)
    read = pose.File(file)
    for index, animation in enumerate(read.items("animations")):
        start, end = pose.duration(read, animation)
        for fraction in TIMES:
            time = float(start + fraction * (end - start))
            yield f"animation {index} at {time:.6g}", *compare(dump, file, index, time)


def compare_files(dump, paths, verbose):
    """Prints what differs, and how many files were refused, unread and read; returns these and whether any differs."""
    counts, tested, failed = collections.Counter(), collections.Counter(), False
    for file in triangles.files_of(paths):
        done, shown = 0, 0
        try:
            found = kinds(pose.File(file).json)
            for name, wrong, count in poses(dump, file):
                done, shown = done + 1, shown + count
                if wrong:
                    failed = True
                    print(f"{file} {name}: {len(wrong)} differ", *wrong[:4], sep="\n    ")
        except triangles.Refused as error:
            counts["refused"] += 1
            if verbose:
                print(f"{file}: {error}")
            continue
        except (KeyError, IndexError, ValueError, TypeError, AttributeError, OSError, struct.error) as error:
            counts["unread"] += 1  # By the second reader, which takes no flaws.
            if verbose:
                print(f"{file}: {type(error).__name__}: {error}")
            continue
        counts.update(files=1, poses=done, triangles=shown)
        tested.update(found)
        if verbose:
            print(f"{file}: {done} poses, {shown} triangles")
    print(f"{counts['files']} files in {counts['poses']} poses, {counts['triangles']} triangles in all; "
          f"{counts['refused']} refused by candela, {counts['unread']} with flaws that the second reader cannot take")
    print("files with " + ", ".join(f"{kind}: {count}" for kind, count in sorted(tested.items())))
    return counts, failed


def main(arguments):
    verbose = "--verbose" in arguments
    dump, *paths = [a for a in arguments if a != "--verbose"] or sys.exit(__doc__)
    if paths:
        counts, failed = compare_files(dump, paths, verbose)
        return 1 if failed or not counts["triangles"] else 0
    with tempfile.TemporaryDirectory() as folder:
        make_models.make([], Path(folder))
        counts, failed = compare_files(dump, [folder], verbose=True)
        return 1 if failed or counts["refused"] or counts["unread"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
