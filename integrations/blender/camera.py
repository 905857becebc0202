# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras."""
import math

import numpy

from .axes import to_candela

# Kinds of panoramas, and what candela calls them.
_PROJECTIONS = {"EQUIRECTANGULAR": "equirectangular", "FISHEYE_EQUIDISTANT": "fisheye",
                "FISHEYE_EQUISOLID": "equisolid"}


def camera_keys(camera, depsgraph, size, notices):
    """The keys of a camera in a scene file, of an evaluated camera object. size: (width, height) of the whole picture
    [pixels]."""
    place = f'Camera "{camera.name}"'
    matrix = camera.matrix_world.normalized()  # Its scale means nothing.
    position = numpy.array(matrix.translation)
    forward, up = -numpy.array(matrix.col[2][:3]), numpy.array(matrix.col[1][:3])
    data = camera.data
    keys = {}
    if data.type == "PANO":
        keys = _panorama(data, place, notices)
    else:
        projection = camera.calc_matrix_camera(depsgraph, x=size[0], y=size[1],
                                               scale_x=depsgraph.scene.render.pixel_aspect_x,
                                               scale_y=depsgraph.scene.render.pixel_aspect_y)
        if data.type == "ORTHO":
            right = numpy.array(matrix.col[0][:3])
            position = position - right * projection[0][3] / projection[0][0] - up * projection[1][3] / projection[1][1]
            keys = {"orthographic_height": 2.0 / projection[1][1]}
        else:
            keys = {"film_size": list(size),
                    "focal_length": [projection[0][0] * size[0] / 2, projection[1][1] * size[1] / 2],
                    "principal_point": [size[0] / 2 * (1 - projection[0][2]), size[1] / 2 * (1 + projection[1][2])]}
            lens = _lens(camera, data, position, forward, place, notices)
            if lens:
                keys["lens"] = lens
    return {"position": to_candela(position), "look_at": to_candela(position + forward), "up": to_candela(up), **keys}


def view_keys(view, depsgraph, notices):
    """The keys of a camera that sees what a viewport shows, whatever its size: a View of viewport.py."""
    matrix = view.view_matrix.inverted().normalized()
    position = numpy.array(matrix.translation)
    forward, up = -numpy.array(matrix.col[2][:3]), numpy.array(matrix.col[1][:3])
    projection, (width, height) = view.window_matrix, view.size
    if projection[3][3] != 0:
        right = numpy.array(matrix.col[0][:3])
        position = position - right * projection[0][3] / projection[0][0] - up * projection[1][3] / projection[1][1]
        keys = {"orthographic_height": 2.0 / projection[1][1]}
    else:
        # In heights of the picture; its film is a square.
        aspect = width / height
        keys = {"film_size": [1, 1], "focal_length": [projection[0][0] * aspect / 2, projection[1][1] / 2],
                "principal_point": [(1 - projection[0][2] * aspect) / 2, (1 + projection[1][2]) / 2]}
        if view.camera is not None:
            camera = view.camera.evaluated_get(depsgraph)
            if camera.type == "CAMERA" and camera.data.type == "PERSP":
                lens = _lens(camera, camera.data, position, forward, f'Camera "{camera.name}"', notices)
                if lens:
                    keys["lens"] = lens
    return {"position": to_candela(position), "look_at": to_candela(position + forward), "up": to_candela(up), **keys}


def _panorama(data, place, notices):
    source = data if hasattr(data, "panorama_type") else data.cycles
    kind = source.panorama_type
    if kind not in _PROJECTIONS:
        notices.add(place, f"candela has no panorama of the type {kind}; it is equirectangular instead")
        kind = "EQUIRECTANGULAR"
    keys = {"projection": _PROJECTIONS[kind]}
    if kind != "EQUIRECTANGULAR":
        keys["fisheye_fov"] = min(math.degrees(source.fisheye_fov), 360.0)
    return keys


def _lens(camera, data, position, forward, place, notices):
    """The thin lens; None for a pinhole."""
    dof = data.dof
    if not dof.use_dof or not math.isfinite(dof.aperture_fstop):
        return None
    distance = dof.focus_distance
    if dof.focus_object is not None:
        distance = abs(float(numpy.dot(numpy.array(dof.focus_object.matrix_world.translation) - position, forward)))
    if distance <= 0:
        notices.add(place, "the plane of focus is at the camera; all is sharp instead")
        return None
    lens = {"radius": data.lens / 1000 / (2 * dof.aperture_fstop), "focal_distance": distance}
    if dof.aperture_blades >= 3:
        lens["blades"] = dof.aperture_blades
        lens["rotation"] = math.degrees(dof.aperture_rotation)
    if dof.aperture_ratio != 1.0:
        notices.add(place, "candela has no anamorphic bokeh; the aperture's ratio is 1 instead")
    return lens
