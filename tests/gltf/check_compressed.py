#!/usr/bin/env python3
"""Compares the triangles that candela reads from compressed conformance models with those of the models themselves.

usage: check_compressed.py DUMP_GEOMETRY

compress.py says which models, how they are compressed and at which times they are posed; streams.json has what the
encoders made, so that none is needed. Needs numpy. Under meshopt every number is the same bit for bit; only the corners
of a triangle may begin at another one. Under Draco, whose order is another, positions are quantised: each triangle is as
near to one of the model's as that allows. Ends with 1 if anything differs.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

import compress
import make_models  # noqa: F401  # Registers the models.
import stage
import triangles

def same_bits(ours, plain):
    """How many triangles differ, in their order, wherever their corners begin."""
    if len(ours) != len(plain):
        return max(len(ours), len(plain))
    turned = [np.all(np.roll(ours, k, axis=1).view(np.uint64) == plain.view(np.uint64), axis=(1, 2)) for k in range(3)]
    return int(np.sum(~np.any(turned, axis=0)))


def quantum(data):
    """How far Draco moves a vertex at most: half a cell of its grid along each axis, of the primitive with the greatest
    extent, under the greatest scale of a node."""
    document, _ = compress.read(data)
    extent = max(max(b - a for a, b in zip(item["min"], item["max"])) for item in document["accessors"]
                 if item["type"] == "VEC3" and "min" in item)
    scale = max([1.0, *(max(node["scale"]) for node in document["nodes"] if "scale" in node)])
    return 3 ** 0.5 * extent * scale / (2 ** compress.POSITION_BITS - 1) / 2


def problems(dump, name, way, folder):
    """Yields a line for each pose, and what differs there, if anything."""
    claims = stage.make(name, folder)
    plain = folder / claims[0]["file"]
    data = compress.compressed(plain.read_bytes(), way)
    if data is None:
        yield "nothing to compress", None
        return
    file = folder / f"{name}-{way}.glb"
    file.write_bytes(data)
    for time in compress.MODELS[name]:
        options = [] if time is None else ["--time", repr(time)]
        ours, theirs = (triangles.of_candela(dump, f, *options) for f in (file, plain))
        text = f"{len(ours)} triangles" + ("" if time is None else f" at {time} s")
        if way == "meshopt":
            differing = same_bits(ours, theirs)
            yield text, f"{differing} differ" if differing else None
        else:
            yield text, "; ".join(triangles.differences(ours, theirs, quantum(plain.read_bytes()))[0])


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.split("\n\n")[1])
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for name in compress.MODELS:
            for way in compress.WAYS:
                for text, wrong in problems(sys.argv[1], name, way, Path(folder)):
                    print(f"{name}, {way}: {text}: {wrong or 'holds'}", flush=True)
                    failed = failed or bool(wrong)
    sys.exit(failed)


if __name__ == "__main__":
    main()
