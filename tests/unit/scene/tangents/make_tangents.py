"""Makes the meshes of this folder, with tangents by Blender, an independent implementation of MikkTSpace:

    blender -b --python make_tangents.py
    python3 make_tangents.py    # The same with the module bpy instead of the program.

tangents_oracle_test.cpp compares candela with them. Blender 3.4.1 made the present ones, in seconds; those of 5.0 pass
the same test, but for a corner of Suzanne where 5.0's normal is 0. Candela itself does not need Blender. The last digits of smooth normals differ from run to run. NAME.bin is little-endian:

    uint32           number of vertices V, number of triangles T
    V * 8 float32    position, unit normal, texture coordinates; no two vertices are equal
    3 T uint16       vertices of the triangles
    3 T * 4 int16    for each corner x, y, z of its tangent times 32767, and the sign of its bitangent
"""

from math import cos, radians, sin, tau
from pathlib import Path

import bpy  # First: the module brings bmesh.
import bmesh
import numpy as np

HERE = Path(__file__).parent


def uv_sphere():
    """One seam, and poles where many triangles of different tangents meet."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    return smooth()


def icosphere():
    """Smooth normals, flat pieces of texture."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    return smooth()


def monkey():
    """Suzanne, with folds, borders and many pieces of texture."""
    bpy.ops.mesh.primitive_monkey_add()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.uv.smart_project(angle_limit=radians(66), island_margin=0.02)
    bpy.ops.object.mode_set(mode="OBJECT")
    return smooth()


def torus():
    """One half has its texture mirrored; on the other it is sheared."""
    bpy.ops.mesh.primitive_torus_add(major_segments=24, minor_segments=12)
    mesh = smooth()
    for corner, uv in uvs(mesh):
        mirrored = mesh.polygons[corner // 4].center.x < 0
        uv.uv = (0.5 - uv.uv.x, uv.uv.y) if mirrored else (uv.uv.x + 0.3 * uv.uv.y, uv.uv.y)
    return mesh


def cylinder():
    """Smooth at its side, sharp at the caps."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=20)
    mesh = smooth()
    if bpy.app.version < (4, 1):
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = radians(30)
    else:
        mesh.set_sharp_from_angle(angle=radians(30))
    return mesh


def cube():
    """Hard edges: each face of 3 x 3 squares has its own normals."""
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=2)
    bpy.ops.object.mode_set(mode="OBJECT")
    return bpy.context.object.data


def grid():
    """A hilly sheet with triangles whose texture has no area, or that have none themselves."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=12, y_subdivisions=12)
    mesh = smooth()
    for v in mesh.vertices:
        v.co.z = 0.2 * sin(3 * v.co.x) * cos(2 * v.co.y)
    mesh.vertices[30].co = mesh.vertices[31].co
    mesh.vertices[70].co = mesh.vertices[71].co
    mesh.vertices[72].co = mesh.vertices[71].co
    for corner, uv in uvs(mesh):
        x, y, _ = mesh.vertices[mesh.loops[corner].vertex_index].co
        if x < -0.5 and y < -0.4:
            uv.uv = (0.25, 0.25)  # A point: a corner of the sheet, whose innermost vertices lie in no other triangle.
        elif x > 0.2 and 0.2 < y < 0.7:
            uv.uv = (0.5, uv.uv.y)  # A line.
        elif x < -0.2 and y > 0.3:
            uv.uv = (1 - uv.uv.x, uv.uv.y)  # Mirrored, between them and the rest squeezed triangles.
    return mesh


def book():
    """Seven sheets along a common spine: more than two triangles at an edge. Two sheets face the other way, and so does
    their texture, so that it is not mirrored."""
    vertices, triangles = [(0, 0, 0), (0, 0, 1), (0, 0, 2)], []
    for sheet in range(7):
        angle = 0.3 * sheet * tau / 7
        x, y, n = cos(angle), sin(angle), len(vertices)
        vertices += [(x, y, 0), (x, y, 1.1 + 0.05 * sheet), (x, y, 2)]
        for i in (0, 1):
            quad = (i, n + i, n + i + 1, i + 1)
            if sheet % 3 == 1:
                quad = quad[::-1]
            triangles += [(quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])]
    mesh = bpy.data.meshes.new("book")
    mesh.from_pydata(vertices, [], triangles)
    mesh.uv_layers.new(name="uv")
    for corner, uv in uvs(mesh):
        x, y, z = mesh.vertices[mesh.loops[corner].vertex_index].co
        turned = corner // 12 % 3 == 1
        uv.uv = (z + 0.4 * y, 0.5 * z + (x + 0.3 * y) * (1 if turned else -1))
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    return mesh


def smooth():
    mesh = bpy.context.object.data
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    return mesh


def uvs(mesh):
    """The corners of a mesh, and their texture coordinates."""
    return enumerate(mesh.uv_layers.active.data)


def triangulate(mesh):
    b = bmesh.new()
    b.from_mesh(mesh)
    bmesh.ops.triangulate(b, faces=b.faces)
    b.to_mesh(mesh)
    b.free()


def read(items, attribute, width):
    values = np.empty(len(items) * width, "<f4")
    items.foreach_get(attribute, values)
    return values.reshape(-1, width)


def write(name, mesh):
    triangulate(mesh)
    if bpy.app.version < (4, 1):
        mesh.calc_normals_split()
    mesh.calc_tangents(uvmap=mesh.uv_layers.active.name)
    corners = np.empty(len(mesh.loops), "<i4")
    mesh.loops.foreach_get("vertex_index", corners)
    rows = np.hstack([read(mesh.vertices, "co", 3)[corners], read(mesh.loops, "normal", 3),
                      read(mesh.uv_layers.active.data, "uv", 2)])
    vertices, triangles = np.unique(rows + np.float32(0), axis=0, return_inverse=True)  # + 0: no -0.
    tangents = np.hstack([np.rint(32767 * read(mesh.loops, "tangent", 3)), read(mesh.loops, "bitangent_sign", 1)])
    with open(HERE / f"{name}.bin", "wb") as file:
        file.write(np.array([len(vertices), len(corners) // 3], "<u4").tobytes())
        file.write(vertices.astype("<f4").tobytes())
        file.write(triangles.astype("<u2").tobytes())
        file.write(tangents.astype("<i2").tobytes())
    print(f"{name}: {len(vertices)} vertices, {len(corners) // 3} triangles")


for make in (uv_sphere, icosphere, monkey, torus, cylinder, cube, grid, book):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    write(make.__name__.replace("_", "-"), make())
