# SPDX-License-Identifier: GPL-3.0-or-later
"""What has been read of Blender's data, for the next look at a scene of which little has changed. Blender's data-blocks are
known by the number that each has in a session, never by name: people rename things."""
import numpy


def uid_of(block):
    """The number of a data-block, the original of an evaluated one; 0 of None."""
    return 0 if block is None else (block.original or block).session_uid


class _Mesh:
    def __init__(self, pointer, needs, sources, parts):
        self.pointer = pointer
        self.needs = needs
        self.sources = sources
        self.parts = parts


class Cache:
    """Meshes, materials and names. A scene that is written once has one of its own."""

    def __init__(self):
        self._meshes = {}
        self._materials = {}
        self._names = {}
        self._used = set()
        self._changed = set()

    def begin(self, updates=()):
        """Begins another look at the scene. updates: what the dependency graph says has changed since the last one."""
        self._used = set()
        self._changed = set()
        for update in updates:
            kind = update.id.bl_rna.identifier
            if update.is_updated_geometry:
                self._changed.add(uid_of(update.id))
            if kind == "Material":
                changed = uid_of(update.id)
                self._materials = {key: made for key, made in self._materials.items() if key[0] != changed}
            elif kind == "Image" or (kind.endswith("NodeTree") and not update.id.is_embedded_data):
                self._materials.clear()  # They may be in any.

    def end(self):
        """Forgets what was not used since begin()."""
        for known in (self._meshes, self._materials, self._names):
            for key in [key for key in known if key not in self._used]:
                del known[key]

    def parts(self, key, pointer, needs, sources, read):
        """The parts of a mesh: those that are known, or what read() gives. key: whose it is; pointer: where Blender has it;
        needs: what its materials ask of it; sources: the numbers of the data-blocks that it is made of."""
        self._used.add(key)
        known = self._meshes.get(key)
        if known is not None and known.pointer == pointer and known.needs == needs and \
                not (known.sources | sources) & self._changed:
            return known.parts
        parts = read()
        if known is not None and _are_same(known.parts, parts):
            parts = known.parts
        self._meshes[key] = _Mesh(pointer, needs, sources, parts)
        return parts

    def material(self, key, read, points=None):
        """What candela makes of a material: what is known, or what read() gives. key: its number first; points: where on a
        mesh it was read."""
        self._used.add(key)
        if key not in self._materials or self._materials[key][0] is not points:
            self._materials[key] = (points, read())
        return self._materials[key][1]

    def name(self, kind, key, wanted):
        """What candela calls a thing of a kind: the name that it has, or that which is wanted, or one like it."""
        if (kind, key) not in self._names:
            taken = {name for (other, _), name in self._names.items() if other == kind}
            number, name = 2, wanted
            while name in taken:
                name, number = f"{wanted} {number}", number + 1
            self._names[kind, key] = name
        self._used.add((kind, key))
        return self._names[kind, key]


def _are_same(before, now):
    return len(before) == len(now) and all(
        a.slot == b.slot and not a.points and not b.points and a.arrays.keys() == b.arrays.keys() and
        all(numpy.array_equal(array, b.arrays[key]) for key, array in a.arrays.items()) for a, b in zip(before, now))
