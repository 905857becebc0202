# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights. Blender states the power that a light sends in all directions, in watts."""
import math

import numpy

from .axes import placed, to_candela
from .trees import shader_of, tree_of


def add_light(scene, thing, matrix, name, glow, notices):
    """Adds a light to a candela.Scene. thing: Blender's object; matrix: where it is; name: what it is called; glow: what its
    material is, if it has a surface."""
    light = thing.data
    seen = {} if thing.visible_camera else {"visible_to_camera": False}
    place = f'Light "{name}"'
    power = _power(light, place, notices)
    if not power.any():
        return
    if light.type == "SUN":
        _add_sun(scene, light, matrix, power, name)
    elif light.type == "AREA":
        _add_area(scene, light, matrix, power, name, glow, seen)
    elif light.type == "SPOT":
        _add_spot(scene, light, matrix, power, name, glow, seen)
    else:
        _add_point(scene, light, matrix, power, name, glow, seen)


def _power(light, place, notices):
    """(3,): of each channel [W], or [W/m²] of a sun."""
    color = numpy.array(light.color)
    if getattr(light, "use_temperature", False):
        color = color * numpy.array(light.temperature_color)
    power = color * light.energy * 2.0 ** getattr(light, "exposure", 0.0)
    tree = tree_of(light)
    if tree is not None:
        power = power * _emission_of(tree, place, notices)
    return power


def _emission_of(tree, place, notices):
    """(3,): the factor of a light's nodes."""
    node = shader_of(tree)
    if node is None or node.type != "EMISSION":
        return numpy.zeros(3) if node is None else _unknown(node, place, notices)
    if any(socket.is_linked for socket in node.inputs):
        return _unknown(node, place, notices)
    return numpy.array(node.inputs["Color"].default_value[:3]) * node.inputs["Strength"].default_value


def _unknown(node, place, notices):
    notices.add(f'{place}, node "{node.name}"', "candela does not know these nodes of a light; they are left out")
    return numpy.ones(3)


def _add_point(scene, light, matrix, power, name, glow, seen):
    if light.shadow_soft_size > 0:
        _add_sphere(scene, light, matrix, power, name, glow, **seen)
    else:
        scene.add_light("point", name, position=to_candela(matrix.translation), intensity=power / (4 * math.pi))


def _add_spot(scene, light, matrix, power, name, glow, seen):
    half = min(light.spot_size / 2, math.pi / 2)
    # Where the cosine is this, the light begins to fall off.
    inner = math.acos(math.cos(half) + (1 - math.cos(half)) * light.spot_blend)
    cone = {"outer_angle": math.degrees(half), "inner_angle": min(math.degrees(inner), math.degrees(half) * 0.9999),
            "falloff": "smoothstep"}
    if light.shadow_soft_size > 0:
        _add_sphere(scene, light, matrix, power, name, glow, cone={"direction": [0, 0, -1], **cone}, **seen)
    else:
        direction = -numpy.array(matrix.col[2][:3])
        scene.add_light("spot", name, position=to_candela(matrix.translation), direction=to_candela(direction),
                        intensity=power / (4 * math.pi), **cone)


def _add_sphere(scene, light, matrix, power, name, glow, **keys):
    """A light with a size, which the object's scale does not change."""
    radius = light.shadow_soft_size
    transform = numpy.eye(4)
    transform[:3, :3] = _turned(to_candela(matrix.col[2][:3]))
    transform[:3, 3] = to_candela(matrix.translation)
    radiance = power / (4 * math.pi ** 2 * radius ** 2)
    scene.add_shape("sphere", name=name, radius=radius, transform=transform, material=_glowing(scene, glow, radiance), **keys)


def _turned(z):
    """(3, 3): a rotation that takes the axis Z to that direction."""
    z = numpy.array(z) / numpy.linalg.norm(z)
    x = numpy.cross(numpy.eye(3)[numpy.argmin(numpy.abs(z))], z)
    x /= numpy.linalg.norm(x)
    return numpy.column_stack([x, numpy.cross(z, x), z])


def _add_sun(scene, light, matrix, power, name):
    direction = -numpy.array(matrix.col[2][:3])
    scene.add_light("directional", name, direction=to_candela(direction), irradiance=power,
                    angle=min(math.degrees(light.angle), 179.9))


def _add_area(scene, light, matrix, power, name, glow, seen):
    """A rectangle or an ellipse, which shines along its -Z."""
    width = light.size
    height = light.size_y if light.shape in {"RECTANGLE", "ELLIPSE"} else light.size
    across, along = (numpy.array(matrix.col[i][:3]) for i in (0, 1))
    area = float(numpy.linalg.norm(numpy.cross(across * width, along * height)))
    if area <= 0:
        return
    is_round = light.shape in {"DISK", "ELLIPSE"}
    radiance = power / (math.pi * area * (math.pi / 4 if is_round else 1))
    half = max(light.spread, math.radians(0.1)) / 2
    spread = {}
    if half < math.pi / 2 * 0.9999:
        spread["spread"] = math.degrees(2 * half)
        radiance = radiance * math.tan(half) / (math.tan(half) - half)  # All of the power leaves.
    transform = placed(matrix) @ numpy.diag([width, height, 1, 1])
    keys = {"name": name, "transform": transform, "material": _glowing(scene, glow, radiance), **spread, **seen}
    if is_round:
        scene.add_shape("disk", normal=[0, 0, -1], radius=0.5, **keys)
    else:
        scene.add_shape("quad", vertices=[[x / 2, y / 2, 0] for x, y in ((-1, -1), (-1, 1), (1, 1), (1, -1))], **keys)


def _glowing(scene, name, radiance):
    """A material, by its name, that emits and reflects nothing, whose back light passes. With one for each lamp, where a lamp
    is and how bright it is can be changed without loading the scene anew."""
    scene.add_material(name, base_color=0.0, specular=0.0, double_sided=False, emission=radiance.tolist())
    return name
