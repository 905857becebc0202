# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's evaluated scene as a candela.Scene."""
import numpy

from . import candela
from .axes import placed
from .camera import camera_keys
from .geometry import KINDS, parts_of, uv_of_render
from .lights import add_light
from .materials import read_material
from .notices import Notices
from .world import set_world

# What people know to be missing, by the type of an object.
_MISSING = {"CURVES": "hair", "VOLUME": "volumes", "POINTCLOUD": "point clouds", "GREASEPENCIL": "grease pencil",
            "GPENCIL": "grease pencil"}
_SILENT = {"EMPTY", "CAMERA", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"}


class _Shown:
    """A mesh with its materials, and where it is shown."""

    def __init__(self, name, parts, materials, catches):
        self.name = name
        self.parts = parts
        self.materials = materials
        self.catches = catches
        self.matrices = []


class SceneWriter:
    """Writes the scene of a dependency graph. `notices` are what candela cannot show of it."""

    def __init__(self, depsgraph, session, size):
        """size: (width, height) of the whole picture [pixels]."""
        self.notices = Notices()
        self._depsgraph = depsgraph
        self._scene = candela.Scene(size=size, session=session)
        self._size = size
        self._materials = {}
        self._shown = {}

    def write(self):
        """The candela.Scene, whose camera is the scene's."""
        camera = self._depsgraph.scene.camera.evaluated_get(self._depsgraph)  # Without one, Blender does not render.
        keys = camera_keys(camera, self._depsgraph, self._size, self.notices)
        self._scene.add_camera(candela.Camera._of(keys))
        for instance in self._depsgraph.object_instances:
            if instance.show_self:
                self._add(instance)
        for shown in self._shown.values():
            self._write_shown(shown)
        set_world(self._scene, self._depsgraph.scene.world, self.notices)
        return self._scene

    def _add(self, instance):
        thing = instance.object
        if thing.type == "LIGHT":
            name = thing.name if not instance.is_instance else f"{thing.name} of {instance.parent.name}"
            add_light(self._scene, thing.data, instance.matrix_world, name, self.notices)
        elif thing.type in KINDS:
            self._add_mesh(thing, instance)
        elif thing.type in _MISSING:
            self.notices.add(f'Object "{thing.name}"', f"candela has no {_MISSING[thing.type]}; it is left out")
        elif thing.type not in _SILENT:
            self.notices.add(f'Object "{thing.name}"', f"candela does not know the type {thing.type}; it is left out")
        if any(system.settings.type == "HAIR" for system in thing.particle_systems):
            self.notices.add(f'Object "{thing.name}"', "candela has no hair; its particles are left out")

    def _add_mesh(self, thing, instance):
        matrix = placed(instance.matrix_world)
        if numpy.linalg.matrix_rank(matrix[:3, :3]) < 3:
            self.notices.add(f'Object "{thing.name}"', "it is flat along an axis of its own; it is left out")
            return
        slots = tuple(slot.material.original if slot.material else None for slot in thing.material_slots)
        key = (thing.data.as_pointer(), slots, thing.is_shadow_catcher)
        if key not in self._shown:
            self._shown[key] = self._read_mesh(thing, slots)
        self._shown[key].matrices.append(matrix)

    def _read_mesh(self, thing, slots):
        materials = [self._material(slot) for slot in slots] or [self._material(None)]
        if thing.is_holdout:
            self.notices.add(f'Object "{thing.name}"', "candela has no holdouts; it is shown")
        if not thing.visible_camera:
            self.notices.add(f'Object "{thing.name}"', "candela hides objects from all rays or none; it is shown")
        mesh = thing.data if thing.type == "MESH" else thing.to_mesh()
        try:
            parts = [] if mesh is None else parts_of(mesh, self._second_uv(mesh, materials))
        finally:
            if thing.type != "MESH":
                thing.to_mesh_clear()
        return _Shown(thing.name, parts, materials, thing.is_shadow_catcher)

    def _second_uv(self, mesh, materials):
        """The name of the texture coordinates, besides those of the render, that the materials use."""
        named = {made.uv for _, made in materials if made.uv is not None} - {uv_of_render(mesh)}
        if len(named) > 1:
            self.notices.add(f'Mesh "{mesh.name}"', "candela has two sets of texture coordinates for a mesh; "
                                                    f"not {', '.join(sorted(named)[1:])}")
        return min(named) if named else None

    def _material(self, material):
        """Its name, and what candela makes of it."""
        if material not in self._materials:
            name = material.name_full if material is not None else "default"
            made = read_material(material, self.notices)
            self._scene.add_material(name, made.type, **made.values)
            self._materials[material] = (name, made)
        return self._materials[material]

    def _write_shown(self, shown):
        for number, part in enumerate(shown.parts):
            name, made = shown.materials[min(part.slot, len(shown.materials) - 1)]
            arrays = self._arrays_for(part, made, shown.name)
            placing = {"transform": shown.matrices[0]} if len(shown.matrices) == 1 else \
                {"transforms": numpy.array(shown.matrices)}
            title = shown.name if number == 0 else f"{shown.name} ({name})"
            if shown.catches:
                placing["shadow_catcher"] = "catch"
            self._scene.add_mesh(**arrays, **placing, material=name, name=self._free(title))

    def _arrays_for(self, part, made, name):
        arrays = dict(part.arrays)
        if "uvs1" not in arrays and made.uv is not None and "uvs" in arrays:
            arrays["uvs1"] = arrays["uvs"]  # The set that it names is the first one here.
        if "uvs" not in arrays and _has_images(made):
            self.notices.add(f'Object "{name}"', "it has no texture coordinates; its images show one colour")
            arrays["uvs"] = numpy.zeros((len(arrays["vertices"]), 2), numpy.float32)
            arrays["uvs1"] = arrays["uvs"]
        if "vertex_colors" not in made.values:
            arrays.pop("colors", None)
        return arrays

    def _free(self, name):
        taken = self._scene._draft
        number, free = 2, name
        while free in taken.meshes or free in taken.shapes:
            free, number = f"{name} {number}", number + 1
        return free


def _has_images(made):
    return any(isinstance(value, candela.Texture) for value in made.values.values())
