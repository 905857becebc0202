#!/usr/bin/env python3
"""Compares the triangles that candela reads from glTF files with those that trimesh reads.

usage: check_geometry.py DUMP_GEOMETRY FOLDER_OR_FILE... [--all-shown] [--verbose]

Needs numpy, trimesh and pillow (PyPI). DUMP_GEOMETRY is the program of dump_geometry.cpp: `cmake --build --preset ci
--target dump_geometry` builds it. Positions, normals and the first texture coordinates of all triangles in world space
must be equal, in any order: positions within 1e-6 of the scene's greatest coordinate (floats, in candela, relative to
each mesh), normals within 1e-5 and texture coordinates within 1e-6. Where trimesh was given no normals, they are those
of the triangles. With --all-shown, scenes show everything in the files (wire.py). What trimesh cannot read is skipped,
with the reason; check_pose.py reads most of it. Ends with 1 if anything differs.
"""

import collections
import logging
import sys
import tempfile
from pathlib import Path

import numpy as np
import trimesh

import reach
import triangles
import wire
from validator_files import parse, write_wired

TOLERANCE = 1e-6  # Relative to the greatest coordinate.
COMPRESSED = {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"}


def unread(document):
    """Why trimesh cannot read the scene of a document as candela does, or nothing."""
    nodes, meshes = document.get("nodes", []), document.get("meshes", [])
    used = {node["mesh"] for node in nodes if "mesh" in node}
    primitives = [p for i in used for p in meshes[i]["primitives"]]
    accessors = document.get("accessors", [])
    read = [accessors[i] for p in primitives for name, i in p["attributes"].items()
            if name in ("POSITION", "NORMAL", "TEXCOORD_0")]
    if not document.get("scenes"):
        return "no scene: trimesh shows nothing"
    if any("skin" in node for node in nodes):
        return "skins: trimesh leaves meshes at rest"
    if any("targets" in p for p in primitives):
        return "morph targets: trimesh ignores them"
    indices = [accessors[p["indices"]] for p in primitives if "indices" in p]
    if any("sparse" in a for a in read + indices):
        return "sparse accessors: trimesh ignores what they replace"
    if any(a.get("normalized") for a in read):
        return "normalised integers: trimesh takes them as they are"
    if any(p.get("mode") == 6 for p in primitives):
        return "fans: trimesh ignores them"
    if any("EXT_mesh_gpu_instancing" in node.get("extensions", {}) for node in nodes):
        return "instances: trimesh shows one"
    if any("KHR_node_visibility" in node.get("extensions", {}) for node in nodes):
        return "hidden nodes: trimesh shows them"
    if any("camera" in node and ("mesh" in node or "children" in node) for node in nodes):
        return "cameras with meshes or children: trimesh ignores these"
    if COMPRESSED & set(document.get("extensionsRequired", [])):
        return "compressed"
    return None


def of_trimesh(file):
    # As the file has them: no vertices merged, no primitives joined.
    scene = trimesh.load_scene(file, process=False, merge_primitives=False)
    parts = [np.zeros((0, 3, 8))]
    for name in scene.graph.nodes_geometry:
        matrix, geometry = scene.graph[name]
        mesh = scene.geometry[geometry]
        if not isinstance(mesh, trimesh.Trimesh):
            continue
        linear = matrix[:3, :3]
        vertices = np.full((len(mesh.vertices), 8), np.nan)
        vertices[:, :3] = mesh.vertices @ linear.T + matrix[:3, 3]
        normals = mesh._cache.cache.get("vertex_normals")  # Those of the file; the property would compute others.
        sign = np.sign(np.linalg.det(linear))
        if normals is not None and sign != 0:
            turned = normals @ np.linalg.inv(linear)  # By the inverse transpose.
            length = np.linalg.norm(turned, axis=1, keepdims=True)
            with np.errstate(invalid="ignore"):
                vertices[:, 3:6] = turned / length  # Of length zero: none.
        uv = getattr(mesh.visual, "uv", None)
        if uv is not None and len(uv) == len(vertices):
            vertices[:, 6:] = uv
        faces = mesh.faces if sign >= 0 else mesh.faces[:, ::-1]
        parts.append(vertices[faces])
    return np.concatenate(parts)


def check(dump, file):
    """Of a file: a word, what is wrong or why it was skipped, and the number of triangles."""
    document, _ = parse(file)
    try:
        ours = triangles.of_candela(dump, file)
    except triangles.Refused as error:
        return "refused", [str(error).replace(str(file), "")], 0
    try:
        reason = unread(document)
    except (KeyError, IndexError, TypeError):
        reason = "flawed"
    if reason:
        return "skipped", [reason], len(ours)
    try:
        theirs = of_trimesh(file)
    except Exception as error:  # trimesh raises any error that occurs within it.
        return "skipped", [f"trimesh fails: {type(error).__name__}"], len(ours)
    tolerance = TOLERANCE * max(triangles.extent(ours), triangles.extent(theirs))
    wrong, with_uv = triangles.differences(ours, theirs, tolerance)
    word = "wrong" if wrong else "equal" if len(ours) else "empty"
    return word, wrong or [f"{with_uv} with texture coordinates"], len(ours)


def check_all_shown(dump, file):
    document, rest = parse(file)
    if not document or "asset" not in document:
        return "skipped", ["no document"], 0
    full = wire.wired(document, lambda d: reach.Reader(d, True, False).seen, rest is not None)
    with tempfile.TemporaryDirectory() as folder:
        return check(dump, write_wired(file, full, rest, Path(folder)))


def main(arguments):
    verbose = "--verbose" in arguments
    check_file = check_all_shown if "--all-shown" in arguments else check
    dump, *paths = [a for a in arguments if not a.startswith("--")] or sys.exit(__doc__)
    logging.disable(logging.CRITICAL)
    counts, reasons, total, failed = collections.Counter(), collections.Counter(), 0, False
    for file in triangles.files_of(paths):
        word, lines, count = check_file(dump, file)
        counts[word] += 1
        total += count if word == "equal" else 0
        if word in ("skipped", "refused"):
            reasons[f"{word}: {lines[0] if word == 'skipped' else 'by candela'}"] += 1
        if word == "wrong" or verbose:
            print(f"{file}: {word}, {count} triangles", *lines[:5], sep="\n    ")
        failed = failed or word == "wrong"
    print(f"{total} triangles of {counts['equal']} files are equal; {counts['wrong']} files differ; "
          f"{counts['empty']} show no triangles in either")
    for reason, count in sorted(reasons.items()):
        print(f"{count:5} {reason}")
    return 1 if failed or not counts["equal"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
