# SPDX-License-Identifier: GPL-3.0-or-later
"""The world: a constant, an image, or a sky."""
import math

import numpy

from .images import pixels_of
from .trees import shader_of, tree_of

_SKIES = {"NISHITA", "SINGLE_SCATTERING", "MULTIPLE_SCATTERING"}


def set_world(scene, world, notices):
    """Gives a candela.Scene Blender's world as its environment."""
    if world is None:
        return
    place = f'World "{world.name}"'
    tree = tree_of(world)
    if tree is None:
        scene.environment = {"radiance": list(world.color)}
        return
    node = _background(tree, place, notices)
    if node is None:
        return
    strength = node.inputs["Strength"].default_value
    if node.inputs["Strength"].is_linked:
        notices.add(f'{place}, node "{node.name}"', "candela does not know what drives its strength; it is 1")
        strength = 1.0
    links = node.inputs["Color"].links
    if not links:
        color = numpy.array(node.inputs["Color"].default_value[:3]) * strength
        if color.any():
            scene.environment = {"radiance": color.tolist()}
        return
    source = links[0].from_node
    if source.type == "TEX_ENVIRONMENT" and source.image is not None:
        _set_image(scene, source, strength, place, notices)
    elif source.type == "TEX_SKY" and source.sky_type in _SKIES:
        _set_sky(scene, source, strength, place, notices)
    else:
        notices.add(f'{place}, node "{source.name}"', "candela does not know such a colour of a world; it is grey")
        scene.environment = {"radiance": 0.5 * strength}


def _background(tree, place, notices):
    """The node that gives the world its colour; None if there is none."""
    if shader_of(tree, "Volume") is not None:
        notices.add(place, "candela has no volumes; they are left out")
    node = shader_of(tree)
    if node is not None and node.type != "BACKGROUND":
        notices.add(f'{place}, node "{node.name}"', "candela knows a Background only; the world is black")
        return None
    return node


def _set_image(scene, node, strength, place, notices):
    """Blender's image has +X in its middle, candela's has -Z: a quarter of a turn."""
    if node.projection != "EQUIRECTANGULAR":
        notices.add(f'{place}, node "{node.name}"', "candela reads an equirectangular image only; it is taken for one")
    turned = -90.0
    links = node.inputs["Vector"].links
    if links and links[0].from_node.type == "MAPPING":
        mapping = links[0].from_node
        if mapping.inputs["Rotation"].is_linked:
            notices.add(f'{place}, node "{mapping.name}"', "candela does not know what turns a world; its field is used")
        x, y, z = mapping.inputs["Rotation"].default_value
        turned -= math.degrees(z)
        scaled = any(abs(value - 1) > 1e-6 for value in mapping.inputs["Scale"].default_value)
        if x != 0 or y != 0 or scaled:
            notices.add(f'{place}, node "{mapping.name}"', "candela turns a world about Z only")
    radiance = pixels_of(node.image, notices)[..., :3].astype(numpy.float32) * strength
    scene.environment = {"radiance": radiance, "rotation": turned}


def _set_sky(scene, node, strength, place, notices):
    notices.add(f'{place}, node "{node.name}"', "the sky is candela's own, which is similar")
    elevation = math.degrees(node.sun_elevation)
    if elevation < -6:
        return
    # Blender's sun stands at +Y turned by the rotation, clockwise from above; candela's azimuth is from +Z to +X.
    azimuth = (180.0 - math.degrees(node.sun_rotation)) % 360.0
    scene._draft.sky = {"sun_elevation": min(elevation, 90.0), "sun_azimuth": azimuth, "intensity": 62.0 * strength}
