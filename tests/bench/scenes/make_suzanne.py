"""Makes made/suzanne.ply: `blender -b --factory-startup -P make_suzanne.py`, or `python3 make_suzanne.py` with the
module bpy.

Suzanne is a mesh that comes with Blender; three steps of Catmull and Clark's subdivision make 62 976 triangles with
smooth normals. Blender's +Z, up, becomes +Y.
"""

import struct
from pathlib import Path

import bpy

MADE = Path(__file__).resolve().parent / "made"
LEVELS = 3


def y_up(v):
    return v.x, v.z, -v.y


def main():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_monkey_add(size=2)
    suzanne = bpy.context.object
    subdivision = suzanne.modifiers.new("subdivision", "SUBSURF")
    subdivision.levels = subdivision.render_levels = LEVELS
    suzanne.modifiers.new("triangles", "TRIANGULATE")
    mesh = suzanne.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(mesh.vertices)}"]
    header += [f"property float {name}" for name in ("x", "y", "z", "nx", "ny", "nz")]
    header += [f"element face {len(mesh.polygons)}", "property list uchar int vertex_indices", "end_header"]
    vertices = b"".join(struct.pack("<6f", *y_up(v.co), *y_up(v.normal)) for v in mesh.vertices)
    faces = b"".join(struct.pack("<B3i", 3, *polygon.vertices) for polygon in mesh.polygons)
    MADE.mkdir(exist_ok=True)
    (MADE / "suzanne.ply").write_bytes("\n".join(header).encode() + b"\n" + vertices + faces)


main()
