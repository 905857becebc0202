"""Triangles as arrays of shape (n, 3, 8): of each corner position, normal, and texture coordinates (v upwards; NaN: not
known), counter-clockwise seen from the front. Their comparison without order. Needs numpy."""

import subprocess
import tempfile
from collections import defaultdict
from itertools import product
from pathlib import Path

import numpy as np

NORMAL = 1e-5  # Normals are floats of unit length; what computed them took some roundings.
UV = 1e-6  # Of the greatest coordinate; 1 - v is rounded to a float.


def files_of(paths):
    """The glTF files that are named, or lie in folders that are."""
    found = [[path] if path.is_file() else sorted(p for p in path.rglob("*") if p.suffix in (".gltf", ".glb"))
             for path in map(Path, paths)]
    return [file for files in found for file in files]


class Refused(Exception):
    """candela refuses the file; the message says why."""


def of_candela(dump_geometry, file, *options):
    """What candela's loader shows."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder, "triangles")
        run = subprocess.run([dump_geometry, file, output, *options], capture_output=True, text=True, errors="replace",
                             check=False)
        if run.returncode == 1:
            raise Refused(run.stderr.strip())
        if run.returncode != 0:
            raise RuntimeError(f"dump_geometry ends with {run.returncode}: {run.stderr.strip()}")
        return np.fromfile(output, dtype="<f8").reshape(-1, 3, 8)


def extent(triangles):
    """The greatest coordinate of any corner."""
    return np.abs(triangles[:, :, :3]).max(initial=0.0)


def areas(triangles):
    p = triangles[:, :, :3]
    return np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) / 2


def solid(triangles, tolerance):
    """Those with a height of more than the tolerance: flat ones are left out or not, as rounding will have it."""
    p = triangles[:, :, :3]
    longest = np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2).max(axis=1, initial=0.0)
    return triangles[2 * areas(triangles) > 4 * tolerance * longest]


def with_flat_normals(triangles):
    """Fills in the triangles' own normals where all normals are NaN."""
    p, result = triangles[:, :, :3], triangles.copy()
    flat = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    with np.errstate(invalid="ignore", divide="ignore"):
        flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    missing = np.isnan(result[:, :, 3])
    result[:, :, 3:6][missing] = np.broadcast_to(flat[:, None, :], p.shape)[missing]
    return result


def limits(triangles, tolerance):
    """For each triangle, how far its numbers may be from another reader's: (n, 8). Positions that are off by the
    tolerance turn a triangle's own normal by as much over its height."""
    p = triangles[:, :, :3]
    longest = np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2).max(axis=1, initial=0.0)
    height = 2 * areas(triangles) / np.maximum(longest, 1e-300)
    result = np.full((len(triangles), 8), tolerance)
    result[:, 3:6] = (NORMAL + 2 * tolerance / np.maximum(height, 1e-300))[:, None]
    greatest = np.nan_to_num(np.abs(triangles[:, :, 6:])).max(axis=(1, 2), initial=1.0)
    result[:, 6:] = UV * greatest[:, None]
    return result


def differences(ours, theirs, tolerance):
    """Compares candela's triangles with another reader's, in any order, their corners turned in any way. Texture
    coordinates count where both know them. Returns what is wrong, as texts, and how many triangles had coordinates."""
    assert np.isfinite(ours[:, :, :6]).all()
    ours, theirs = solid(ours, tolerance), solid(with_flat_normals(theirs), tolerance)
    wrong, with_uv = [], 0
    if len(ours) != len(theirs):
        wrong.append(f"{len(ours)} triangles, not {len(theirs)}")
    cell = max(8 * tolerance, 1e-300)
    middles, allowed = theirs[:, :, :3].mean(axis=1) / cell, limits(theirs, tolerance)
    grid = defaultdict(list)
    for i, key in enumerate(map(tuple, np.floor(ours[:, :, :3].mean(axis=1) / cell).astype(np.int64).tolist())):
        grid[key].append(i)
    turned = np.stack([np.roll(ours, -k, axis=1) for k in range(3)], axis=1)  # (n, 3 turns, 3, 8)
    for j, triangle in enumerate(theirs):
        # The cells that a middle within the tolerance of this one may be in.
        near = [sorted({int(np.floor(c - 0.25)), int(np.floor(c + 0.25))}) for c in middles[j]]
        best, worst = None, None
        for bucket in filter(None, (grid.get(key) for key in product(*near))):
            with np.errstate(invalid="ignore"):
                apart = np.abs(turned[bucket] - triangle) / allowed[j]
            apart = np.nan_to_num(apart, nan=0.0).max(axis=2)  # (bucket, turns, 8): in units of what is allowed.
            ratio = apart.max(axis=2)
            k = np.unravel_index(ratio.argmin(), ratio.shape)
            if best is None or ratio[k] < best:
                best, worst, place = ratio[k], apart[k], (bucket, k[0])
        if best is None or best > 1.0:
            what = "no triangle near" if best is None else \
                "position" if worst[:3].max() > 1 else "normal" if worst[3:6].max() > 1 else "texture coordinates"
            wrong.append(f"{what}: the corner {', '.join(f'{number:.6g}' for number in triangle[0])} ..." +
                         (f", {best:.3g} times what is allowed" if best else ""))
            continue
        index = place[0].pop(place[1])
        with_uv += not (np.isnan(ours[index, 0, 6]) or np.isnan(triangle[0, 6]))
    return wrong, with_uv
