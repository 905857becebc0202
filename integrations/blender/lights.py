# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights. Blender states the power that a light sends in all directions, in watts."""
import math

import numpy

from .axes import placed, to_candela
from .trees import shader_of, tree_of


def add_light(scene, light, matrix, name, glow, notices):
    """Adds a light to a candela.Scene. light: Blender's data; matrix: its matrix_world; name: what it is called; glow: what
    its material is, if it has a surface."""
    place = f'Light "{name}"'
    power = _power(light, place, notices)
    if not power.any():
        return
    if light.type == "SUN":
        _add_sun(scene, light, matrix, power, name)
    elif light.type == "AREA":
        _add_area(scene, light, matrix, power, name, glow, place, notices)
    elif light.type == "SPOT":
        _add_spot(scene, light, matrix, power, name, place, notices)
    else:
        _add_point(scene, light, matrix, power, name, glow)


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


def _add_point(scene, light, matrix, power, name, glow):
    position = to_candela(matrix.translation)
    radius = light.shadow_soft_size
    if radius > 0:
        radiance = power / (4 * math.pi ** 2 * radius ** 2)
        transform = numpy.diag([radius, radius, radius, 1.0])
        transform[:3, 3] = position
        scene.add_shape("sphere", name=name, radius=1.0, transform=transform, material=_glowing(scene, glow, radiance))
    else:
        scene.add_light("point", name, position=position, intensity=power / (4 * math.pi))


def _add_spot(scene, light, matrix, power, name, place, notices):
    if light.shadow_soft_size > 0:
        notices.add(place, "candela has no soft spots; its shadows are hard")
    half = min(light.spot_size / 2, math.pi / 2)
    # Where the cosine is this, the light begins to fall off.
    inner = math.acos(math.cos(half) + (1 - math.cos(half)) * light.spot_blend)
    direction = -numpy.array(matrix.col[2][:3])
    scene.add_light("spot", name, position=to_candela(matrix.translation), direction=to_candela(direction),
                    intensity=power / (4 * math.pi), outer_angle=math.degrees(half),
                    inner_angle=min(math.degrees(inner), math.degrees(half) * 0.9999), falloff="smoothstep")


def _add_sun(scene, light, matrix, power, name):
    direction = -numpy.array(matrix.col[2][:3])
    scene.add_light("directional", name, direction=to_candela(direction), irradiance=power,
                    angle=min(math.degrees(light.angle), 179.9))


def _add_area(scene, light, matrix, power, name, glow, place, notices):
    """A rectangle or an ellipse, which shines along its -Z."""
    if light.spread < math.pi:
        notices.add(place, "candela has no spread below 180 degrees; it shines to all sides of its front")
    width = light.size
    height = light.size_y if light.shape in {"RECTANGLE", "ELLIPSE"} else light.size
    across, along = (numpy.array(matrix.col[i][:3]) for i in (0, 1))
    area = float(numpy.linalg.norm(numpy.cross(across * width, along * height)))
    if area <= 0:
        return
    is_round = light.shape in {"DISK", "ELLIPSE"}
    radiance = power / (math.pi * area * (math.pi / 4 if is_round else 1))
    transform = placed(matrix) @ numpy.diag([width, height, 1, 1])
    keys = {"name": name, "transform": transform, "material": _glowing(scene, glow, radiance)}
    if is_round:
        scene.add_shape("disk", normal=[0, 0, -1], radius=0.5, **keys)
    else:
        scene.add_shape("quad", vertices=[[x / 2, y / 2, 0] for x, y in ((-1, -1), (-1, 1), (1, 1), (1, -1))], **keys)


def _glowing(scene, name, radiance):
    """A material, by its name, that emits and reflects nothing, whose back light passes. With one for each lamp, where a lamp
    is and how bright it is can be changed without loading the scene anew."""
    scene.add_material(name, base_color=0.0, specular=0.0, double_sided=False, emission=radiance.tolist())
    return name
