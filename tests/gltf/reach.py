"""What of a glTF document candela reads to show its scene, as JSON pointers.

reached(document, timed) gives the objects that the chosen scene needs; is_reached() says it of any pointer. These are
rules of the specification (what refers to what) and of docs/gltf.md (what is not read), not the loader's code.
"""

import re

# A pointer that matches holds an index into an array. In a target, \\1 is the first group.
REFERENCES = [(re.compile(pattern + "$"), target) for pattern, target in (
    (r"/scene", "/scenes"),
    (r"/scenes/\d+/nodes/\d+", "/nodes"),
    (r"/nodes/\d+/children/\d+", "/nodes"),
    (r"/nodes/\d+/mesh", "/meshes"),
    (r"/nodes/\d+/skin", "/skins"),
    (r"/nodes/\d+/camera", "/cameras"),
    (r"/nodes/\d+/extensions/KHR_lights_punctual/light", "/extensions/KHR_lights_punctual/lights"),
    (r"/skins/\d+/(?:joints/\d+|skeleton)", "/nodes"),
    (r"/skins/\d+/inverseBindMatrices", "/accessors"),
    (r"/meshes/\d+/primitives/\d+/(?:indices|attributes/[^/]*|targets/\d+/[^/]*)", "/accessors"),
    (r"/meshes/\d+/primitives/\d+/material", "/materials"),
    (r"/meshes/\d+/primitives/\d+/extensions/KHR_materials_variants/mappings/\d+/material", "/materials"),
    (r"/materials/\d+/(?:.*/)?\w+Texture/index", "/textures"),
    (r"/textures/\d+/(?:extensions/EXT_texture_webp/)?source", "/images"),
    (r"/textures/\d+/sampler", "/samplers"),
    (r"(?:/images/\d+|/accessors/\d+(?:/sparse/\w+)?)/bufferView", "/bufferViews"),
    (r"/bufferViews/\d+/buffer", "/buffers"),
    (r"(/animations/\d+)/channels/\d+/sampler", r"\1/samplers"),
    (r"/animations/\d+/channels/\d+/target/node", "/nodes"),
    (r"/animations/\d+/samplers/\d+/(?:input|output)", "/accessors"))]

# What is not read, wherever it is.
IGNORED = re.compile("|".join((
    r"/materials/\d+/occlusionTexture",  # The renderer computes occlusion.
    r"/skins/\d+/skeleton",
    r"/meshes/\d+/primitives/\d+/(?:attributes|targets/\d+)/"
    r"(?!(?:POSITION|NORMAL|TANGENT|TEXCOORD_[01]|COLOR_0|JOINTS_\d+|WEIGHTS_\d+)$)",
)))
OBJECT = re.compile(r"/(?:extensions/KHR_lights_punctual/)?(?:accessors|animations|buffers|bufferViews|cameras|images|"
                    r"lights|materials|meshes|nodes|samplers|scenes|skins|textures)/\d+(?=/|$)")
ARRAYS = ["/" + name for name in ("accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials",
                                  "meshes", "samplers", "skins", "textures")]
# What the placement of any node is read from, whether or not the scene has it.
PLACEMENT = re.compile(r"/nodes/\d+(?:/(?:matrix|translation|rotation|scale|weights|children)(?:/.*)?)?$")
MORPHS = re.compile(r"/meshes/\d+/primitives/\d+/targets(?:/|$)")
SKINNING = re.compile(r"/meshes/\d+/primitives/\d+/attributes/(?:JOINTS|WEIGHTS)_\d+$")
VARIANTS = re.compile(r"(?:/meshes/\d+/primitives/\d+)?/extensions/KHR_materials_variants(?:/|$)")


def value_at(document, pointer):
    """The value at a pointer; None if there is none."""
    for key in pointer.split("/")[1:]:
        key = key.replace("~1", "/").replace("~0", "~")
        if isinstance(document, dict) and key in document:
            document = document[key]
        elif isinstance(document, list) and key.isdigit() and int(key) < len(document):
            document = document[int(key)]
        else:
            return None
    return document


def pointers_within(value, pointer):
    """Pointers to everything in a value, itself included."""
    yield pointer
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield from pointers_within(item, f"{pointer}/" + str(key).replace("~", "~0").replace("/", "~1"))


def target_of(document, pointer):
    """What the reference at a pointer refers to, whether or not it is there; None if there is no reference."""
    index = value_at(document, pointer)
    if not isinstance(index, (int, float)) or isinstance(index, bool):
        return None
    for pattern, target in REFERENCES:
        match = pattern.match(pointer)
        if match:
            return f"{match.expand(target)}/{int(index)}"
    return None


def targets_of(document, pointer):
    """What a pointer refers to, over any number of references within data and images: an animation's sampler, its
    accessor, that one's view ... Of a node and of weights, the mesh."""
    mesh = re.match(r"/nodes/\d+(?=(?:/weights)?$)", pointer)
    first = target_of(document, mesh.group() + "/mesh" if mesh else pointer)
    first = pointer[:-len("/weights")] if re.match(r"/meshes/\d+/weights$", pointer) else first
    own = re.match(r"/(?:accessors|bufferViews|textures|images)/\d+", pointer)
    found, waiting = set(), [own.group()] if own else [first] if first else []
    while waiting:
        at = waiting.pop()
        found.add(at)
        if re.match(r"/(?:animations|accessors|bufferViews|textures|images)/", at):
            for place in pointers_within(value_at(document, at), at):
                target = target_of(document, place)
                waiting += [target] if target and target not in found else []
    return found


def has_surface(document, pointer):
    """Whether the primitive at a pointer is made of triangles that are not all at one point."""
    primitive = value_at(document, pointer)
    if not isinstance(primitive, dict) or primitive.get("mode", 4) < 4:
        return False
    position = value_at(document, f"{target_of(document, pointer + '/attributes/POSITION')}")
    return isinstance(position, dict) and ("bufferView" in position or "sparse" in position)


def layer_counts(document, pointer):
    """Whether what is at a pointer in a material is not switched off by another value of it."""
    material = value_at(document, pointer[:len(OBJECT.match(pointer).group())])
    extensions = material.get("extensions") if isinstance(material, dict) else None
    extensions = extensions if isinstance(extensions, dict) else {}
    if re.search("/extensions/KHR_materials_(?:volume|dispersion)(?:/|$)", pointer):
        through = [value for name, value in extensions.items() if name.endswith("transmission")]
        return any(number > 0 for layer in through for key, number in layer.items() if key.endswith("Factor")
                   and isinstance(number, (int, float)))
    if "/extensions/KHR_materials_emissive_strength" in pointer or "/emissiveTexture" in pointer:
        return any(material.get("emissiveFactor", [0]))
    if "/pbrMetallicRoughness/" in pointer + "/":
        return "KHR_materials_pbrSpecularGlossiness" not in extensions
    return True


class Reader:
    """Follows references from the scene; `seen` collects the objects."""

    def __init__(self, document, timed, variant):
        self.document, self.variant, self.seen, self.skinned, self.weighted = document, variant, set(), set(), set()
        scenes = document.get("scenes")
        if "scene" in document:
            self.visit(target_of(document, "/scene"))
        elif isinstance(scenes, list) and scenes:
            self.visit("/scenes/0")
        else:
            nodes = [node for node in document.get("nodes") or [] if isinstance(node, dict)]
            children = {child for node in nodes for child in node.get("children", [])}
            for i in range(len(nodes)):
                if i not in children:
                    self.visit(f"/nodes/{i}")
        for i in range(len(document.get("animations") or []) if timed else 0):
            self.visit(f"/animations/{i}")

    def visit(self, pointer):
        if pointer in self.seen or value_at(self.document, pointer) is None:
            return
        self.seen.add(pointer)
        if pointer.startswith("/nodes/"):
            self.note_deformation(pointer)
        for place in list(pointers_within(value_at(self.document, pointer), pointer)):
            target = target_of(self.document, place)
            # Joints and targets of animations do not make the scene show what is at these nodes.
            if target and self.reads(place) and not re.match(r"/skins|/animations/\d+/channels/\d+/target", place):
                self.visit(target)
            elif target and place.endswith("/inverseBindMatrices"):
                self.visit(target)

    def note_deformation(self, pointer):
        mesh, node = target_of(self.document, pointer + "/mesh"), value_at(self.document, pointer)
        if mesh and "skin" in node:
            self.skinned.add(mesh)
        if mesh and ("weights" in node or "weights" in (value_at(self.document, mesh) or {})):
            self.weighted.add(mesh)

    def reads(self, pointer):
        """Whether what is at this pointer, in an object that is read, is read, too."""
        mesh = OBJECT.match(pointer) and OBJECT.match(pointer).group()
        if IGNORED.match(pointer) or (VARIANTS.match(pointer) and not self.variant):
            return False
        if re.match(r"/animations/\d+/channels/\d+/target(?:/|$)", pointer):
            target = value_at(self.document, "/".join(pointer.split("/")[:6]))
            return not isinstance(target, dict) or "node" in target  # Otherwise of an extension.
        if pointer.endswith("/skin") and value_at(self.document, pointer[:-4] + "mesh") is None:
            return False
        if MORPHS.match(pointer) and mesh not in self.weighted:
            return False
        if SKINNING.match(pointer) and mesh not in self.skinned:
            return False
        if pointer.startswith("/materials/") and not layer_counts(self.document, pointer):
            return False
        primitive = re.match(r"/meshes/\d+/primitives/\d+(?=/(material|attributes|indices|targets))", pointer)
        if not primitive:
            return True
        if primitive.group(1) == "material":
            return has_surface(self.document, primitive.group())
        value = value_at(self.document, primitive.group())
        return not isinstance(value, dict) or value.get("mode", 4) >= 4

    def is_reached(self, pointer):
        match = OBJECT.match(pointer)
        if pointer in ARRAYS:
            return any(seen.startswith(pointer + "/") for seen in self.seen)
        if not match:
            return not (VARIANTS.match(pointer) and not self.variant)
        if match.group() in self.seen:
            return self.reads(pointer)
        return bool(PLACEMENT.match(pointer))
