# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's evaluated scene as a candela.Scene."""
import numpy

from . import candela
from .axes import placed
from .cache import Cache, uid_of
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

# The kinds of rays that an object may be hidden from.
_RAYS = ("camera", "diffuse", "glossy", "transmission", "shadow")


class _Shown:
    """A mesh with the materials of its slots, how the camera sees it (keys of a shape), and where it is shown."""

    def __init__(self, key, name, parts, materials, seen):
        self.key = key
        self.name = name
        self.parts = parts
        self.materials = materials
        self.seen = seen
        self.matrices = []


class SceneWriter:
    """Writes the scene of a dependency graph. `notices` are what candela cannot show of it."""

    def __init__(self, depsgraph, session, size, cache=None):
        """size: (width, height) of the whole picture [pixels]. cache: what is known of an earlier look at the scene."""
        self.notices = Notices()
        self._depsgraph = depsgraph
        self._scene = candela.Scene(size=size, session=session, **depsgraph.scene.candela.film())
        self._size = size
        self._cache = cache or Cache()
        self._texels = 1024 if cache is None else 512  # Of textures in space: a viewport is to be quick.
        self._written = set()
        self._shown = {}

    def write(self):
        """The candela.Scene, whose camera is the scene's."""
        camera = self._depsgraph.scene.camera.evaluated_get(self._depsgraph)  # Without one, Blender does not render.
        return self.write_for(camera_keys(camera, self._depsgraph, self._size, self.notices))

    def write_for(self, camera, is_seen=lambda instance: True):
        """The candela.Scene with a camera of these keys, of the objects that are seen."""
        self._scene.add_camera(candela.Camera._of(camera))
        for instance in self._depsgraph.object_instances:
            if instance.show_self and is_seen(instance):
                self._add(instance)
        for shown in self._shown.values():
            self._write_shown(shown)
        set_world(self._scene, self._depsgraph.scene.world, self.notices)
        return self._scene

    def _add(self, instance):
        thing = instance.object
        if thing.type == "LIGHT":
            title = thing.name if not instance.is_instance else f"{thing.name} of {instance.parent.name}"
            key = ("light", uid_of(thing), uid_of(instance.parent), tuple(instance.persistent_id))
            name = self._cache.name("object", key, title)
            glow = self._cache.name("material", key, f"{name} (light)")
            add_light(self._scene, thing, instance.matrix_world, name, glow, self.notices)
        elif thing.type in KINDS:
            self._add_mesh(thing, instance)
        elif thing.type in _MISSING:
            self.notices.add(f'Object "{thing.name}"', f"candela has no {_MISSING[thing.type]}; it is left out")
        elif thing.type not in _SILENT:
            self.notices.add(f'Object "{thing.name}"', f"candela does not know the type {thing.type}; it is left out")
        if any(system.settings.type == "HAIR" for system in thing.particle_systems):
            self.notices.add(f'Object "{thing.name}"', "candela has no hair; its particles are left out")

    def _add_mesh(self, thing, instance):
        if not any(getattr(thing, f"visible_{name}") for name in _RAYS):
            return
        matrix = placed(instance.matrix_world)
        if numpy.linalg.matrix_rank(matrix[:3, :3]) < 3:
            self.notices.add(f'Object "{thing.name}"', "it is flat along an axis of its own; it is left out")
            return
        slots = tuple(slot.material.original if slot.material else None for slot in thing.material_slots)
        key = (thing.data.as_pointer(), tuple(uid_of(slot) for slot in slots), *self._seen(thing).items())
        if key not in self._shown:
            self._shown[key] = self._read_mesh(thing, instance, slots)
        self._shown[key].matrices.append(matrix)

    def _read_mesh(self, thing, instance, slots):
        """A mesh that is shown for the first time. Pointers say what is one mesh during a look at the scene, but not beyond."""
        slots = slots or (None,)
        materials = [self._material(slot) for slot in slots]
        if thing.is_holdout and not self._depsgraph.scene.render.film_transparent:
            self.notices.add(f'Object "{thing.name}"', "candela has holdouts before a transparent film alone; it is shown")
        hidden = [name for name in _RAYS[1:] if not getattr(thing, f"visible_{name}")]
        if hidden:
            self.notices.add(f'Object "{thing.name}"', f"candela hides objects from the camera or from all rays; it is shown to {', '.join(hidden)}")
        owner = uid_of(thing)
        key = ("mesh", owner, sum(shown.key[1] == owner for shown in self._shown.values()))
        sources = {owner, uid_of(thing.data), uid_of(instance.parent)}
        named = frozenset(made.uv for made in materials if made.uv is not None)
        in_space = tuple(made.in_space for made in materials)

        def read():
            mesh = thing.data if thing.type == "MESH" else thing.to_mesh()
            try:
                return [] if mesh is None else parts_of(
                    mesh, self._second_uv(mesh, named), lambda slot: in_space[min(slot, len(in_space) - 1)], self._texels)
            finally:
                if thing.type != "MESH":
                    thing.to_mesh_clear()
        parts = self._cache.parts(key, thing.data.as_pointer(), (named, in_space), sources, read)
        return _Shown(key, thing.name, parts, slots, self._seen(thing))

    def _seen(self, thing):
        """How the camera sees an object, as keys of its shapes."""
        if not thing.visible_camera:
            return {"visible_to_camera": False}
        if thing.is_holdout and self._depsgraph.scene.render.film_transparent:
            return {"shadow_catcher": "holdout"}
        return {"shadow_catcher": "catch"} if thing.is_shadow_catcher else {}

    def _second_uv(self, mesh, named):
        """The name of the texture coordinates, besides those of the render, that are named by its materials."""
        named = named - {uv_of_render(mesh)}
        if len(named) > 1:
            self.notices.add(f'Mesh "{mesh.name}"', "candela has two sets of texture coordinates for a mesh; "
                                                    f"not {', '.join(sorted(named)[1:])}")
        return min(named) if named else None

    def _material(self, material):
        """What candela makes of a material, of all that can be said without a mesh."""
        return self._cache.material((uid_of(material),), lambda: read_material(material, self.notices))

    def _write_material(self, material, shown, part):
        """Adds it, once; returns its name, and what candela makes of it."""
        made = self._material(material)
        title = material.name_full if material is not None else "default"
        key = (uid_of(material),)
        if made.in_space:
            title, key = f"{title} on {shown.name}", (*key, *shown.key, part.slot)
            made = self._cache.material(key, lambda: read_material(material, self.notices, part.points), part.points)
        name = self._cache.name("material", key, title)
        if name not in self._written:
            self._written.add(name)
            self._scene.add_material(name, made.type, **made.values)
        return name, made

    def _write_shown(self, shown):
        for number, part in enumerate(shown.parts):
            name, made = self._write_material(shown.materials[min(part.slot, len(shown.materials) - 1)], shown, part)
            arrays = self._arrays_for(part, made, shown.name)
            placing = {"transform": shown.matrices[0]} if len(shown.matrices) == 1 else \
                {"transforms": numpy.array(shown.matrices)}
            title = shown.name if number == 0 else f"{shown.name} ({name})"
            name_of_part = self._cache.name("object", (*shown.key, part.slot), title)
            self._scene.add_mesh(**arrays, **placing, **shown.seen, material=name, name=name_of_part)

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


def _has_images(made):
    return any(isinstance(value, candela.Texture) for value in made.values.values())
