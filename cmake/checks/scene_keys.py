#!/usr/bin/env python3
"""Checks that the schema and the page of scene files say what the lists of their keys do: host/load/json/scene_keys.inc,
and host/scene/principled_values.inc for the principled material.

usage: scene_keys.py [--write]

Without --write, it ends with 1 if they differ, and says what to do; with it, it makes them the same. What the lists do
not know, such as the parts of an array, is the schema's own and stays.
"""

import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KEYS, VALUES = "host/load/json/scene_keys.inc", "host/scene/principled_values.inc"
SCHEMA, PAGE = "scenes/scene.schema.json", "docs/scene-format.md"
CONSTANTS = ["host/base/limits.h", *(f"host/scene/{name}.h" for name in (
    "camera", "light", "material", "medium", "principled", "sky", "texture"))]
NAMES = ["host/scene/names.h", "host/load/json/loader_mesh_files.cpp"]

# The tables of the page, by section: the objects whose keys each lists, or rows that are no key's.
TABLES = {
    "Top level": [["| `$schema` | path of the schema, for editors; ignored by candela | |", "scene"]],
    "Cameras": [["camera"]],
    "Lens": [["lens"]],
    "Film": [["film"]],
    "Integrator": [["integrator"]],
    "Materials": [["diffuse", "phong", "mirror", "conductor", "dielectric", "absorption", "diffuse_transmission",
                   "interface",
                   "| `principled` | [many](#principled) | a base under layers | |", "rough_conductor",
                   "rough_dielectric"], ["material", "normal_map", "bump_map", "opacity"]],
    "Media": [["medium", "scattering"]],
    "Principled": [["principled", "subsurface"]],
    "Textures": [["texture", "textured"]],
    "Shapes": [["shape"], ["quad", "box", "mesh", "sphere", "cone", "disk", "obj", "ply", "instance"]],
    "Lights": [["light", "point", "spot", "directional"]],
    "Environment": [["environment"]],
    "Sky": [["sky"]],
}
# Objects that are the value of the key of their name: the page calls their keys NAME.KEY.
PARTS = {"cone", "absorption", "scattering", "subsurface", "normal_map", "bump_map", "opacity"}
# Where the schema has the keys that all variants of an object share.
COMMON = {"material": {"normal_map": "normalMap", "bump_map": "bumpMap", "opacity": "opacity",
                       "vertex_colors": "vertexColors"},
          "shape": {key: f"shape_{key}" for key in ("name", "material", "emission", "two_sided", "spread",
                                                         "shadow_catcher", "visible_to_camera", "transform")},
          "light": {"name": "light_name"}}
# What the list of principled values does not say.
TEXTURED = {"color": "texturedReflectance", "radiance": "texturedRadiance", "weight": "texturedWeight",
            "thickness": "texturedThickness"}
MAPS = {"vector_map": "vectorMap", "normal_map": "normalMap"}
PRINCIPLED_KEYS = {"thin_walled": "`true`; `false` with `absorption`, `scattering` or `subsurface`", "absorption": "none",
                   "scattering": "none", "subsurface": "none", "priority": "0"}
NEEDS_MORE = {"iridescence_thickness_min": ["iridescence_thickness"]}

ENTRY = re.compile(r"""^([A-Z]+)\(((?:[^"]|"(?:[^"\\]|\\.)*")*?)\)$""", re.MULTILINE)
ARGUMENT = re.compile(r"""((?:[^",()]|\([^()]*\)|"(?:[^"\\]|\\.)*")+)""")
STRING = re.compile(r'"((?:[^"\\]|\\.)*)"')
CONSTANT = re.compile(r"constexpr \w+ ([A-Z_0-9]+) = ([^;]+);")
CHOICES = re.compile(r"constexpr [^;=]*?\b([A-Z_]+_NAMES)\{(.*?)\};", re.DOTALL)


def read(name):
    return (ROOT / name).read_text(encoding="utf-8")


def entries(text):
    """The lines of a list: the macro, and its arguments, without the quotation marks of literals."""
    for macro, inside in ENTRY.findall(text):
        yield macro, ["".join(re.sub(r"\\(.)", r"\1", part) for part in STRING.findall(argument))
                      if '"' in argument else argument.strip() for argument in ARGUMENT.findall(inside)]


class Lists:
    """Both lists: object -> key -> what is known of it."""

    def __init__(self):
        self.constants = {"UINT32_MAX": "4294967295"}
        for name in CONSTANTS:
            self.constants |= dict(CONSTANT.findall(read(name)))
        self.choices = {name: STRING.findall(inside)
                        for header in NAMES for name, inside in CHOICES.findall(read(header))}
        values = {}
        self.objects = {"principled": values}
        for macro, words in entries(read(VALUES)):
            if macro == "KEY":
                values[words[0]] = {"kind": "key", "initial": PRINCIPLED_KEYS[words[0]], "text": words[-1]}
                continue
            kind, name, initial, min, max, needs, text = words
            values[name] = {"kind": kind, "text": text, "needs": needs}
            values[name]["initial"] = "none" if kind in MAPS else initial if kind == "flag" \
                else json.dumps(self.number(initial))
            if kind not in ("radiance", "angle"):
                values[name] |= {"min": self.number(min), "max": self.number(max)}
        for macro, (of, name, *more) in entries(read(KEYS)):
            key = {"kind": macro.lower(), "initial": more[-2], "text": more[-1]}
            if macro in ("NUMBER", "INTEGER"):
                key |= {"min": self.number(more[0]), "max": self.number(more[1])}
            if macro == "CHOICE":
                key["names"] = self.choices[more[0]]
            self.objects.setdefault(of, {})[name] = key

    def number(self, text):
        """A number of C++, as Python and JSON write it."""
        text = re.sub(r"^vec3\((.*)\)$", r"\1", text)
        text = re.sub(r"PRINCIPLED_RANGES\.(\w+)\.(\w+)",
                      lambda match: str(self.objects["principled"][match[1]][match[2]]), text)
        text = re.sub(r"\b[A-Z][A-Z_0-9]+\b", lambda match: self.constants[match[0]], text)
        value = float(eval(re.sub(r"(?<=[\d.])[uf]\b", "", text), {"__builtins__": {}}))
        return int(value) if value.is_integer() else value


def json_of(initial):
    """The default as JSON; None if it is a text."""
    try:
        return json.loads(initial)
    except ValueError:
        return None


def readable(number):
    """As the page writes numbers: 5, 0.001, 65 536, −10⁶."""
    digits = str(abs(number))
    if abs(number) >= 10000:
        power = re.fullmatch("10*", digits)
        digits = "10" + str(len(digits) - 1).translate(str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")) if power \
            else f"{abs(number):,}".replace(",", " ")
    return ("−" if number < 0 else "") + digits


def prose_of(key):
    if "{range}" not in key["text"]:
        return key["text"]
    return key["text"].replace("{range}", f"from {readable(key['min'])} to {readable(key['max'])}")


# The page.

def rows_of(of, keys, has_types):
    """The rows of an object's keys in a table."""
    rows = []
    for name, key in keys.items():
        default = key["initial"]
        if isinstance(json_of(default), (str, bool, list)):
            default = f"`{default}`"
        shown = f"{of}.{name}" if of in PARTS else name
        cells = [f"`{shown}`", prose_of(key), default]
        if of in ("principled", "subsurface"):
            cells.insert(1, "T" if key["kind"] in TEXTURED else "")
        if has_types:
            cells.insert(0, "" if rows or of in PARTS else "all" if of in COMMON else f"`{of}`")
        rows.append("|" + "|".join(f" {cell} " if cell else " " for cell in cells) + "|")
    return rows


def with_tables(page, lists):
    for section, tables in TABLES.items():
        start = re.search(rf"^#+ {section}$", page, re.MULTILINE).end()
        for objects in tables:
            head = re.compile(r"^\|.*\|\n\|[-|]+\|\n", re.MULTILINE).search(page, start)
            has_types = head[0].startswith("| `type` |")
            rows = []
            for of in objects:
                rows += [of] if of.startswith("|") else rows_of(of, lists.objects[of], has_types)
            end = page.index("\n\n", head.end())
            page = page[:head.end()] + "\n".join(rows) + page[end:]
            start = head.end()
    return page


# The schema.

def description_of(key):
    """The text and, if JSON cannot say it, the default."""
    initial = key["initial"]
    parts = [prose_of(key)]
    if json_of(initial) is None and initial not in ("", "none", "error", "required", "see there"):
        parts.append(initial if initial.startswith("required") else f"if absent: {initial}")
    parts = [re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", part).replace("`", "") for part in parts]
    return " ".join(part[:1].upper() + part[1:] + "." for part in parts)


def places_of(schema):
    """Where the schema has each object: object -> list of what has its "properties"; and which of these are COMMON."""
    defs, shared = schema["$defs"], {}
    places = {"scene": [schema], "film": [schema["properties"]["film"]],
              "integrator": [schema["properties"]["integrator"]], "environment": defs["environment"]["oneOf"],
              "normal_map": [defs["normalMap"]], "bump_map": [defs["bumpMap"]], "opacity": [defs["opacity"]["oneOf"][1]]}
    places |= {name: [defs[name]] for name in ("camera", "cone", "lens", "texture", "absorption", "scattering", "subsurface",
                                               "medium", "sky")}
    for family, common in COMMON.items():
        places[family] = [{"properties": {key: defs[name] for key, name in common.items()}}]
        for variant in defs[family]["oneOf"]:
            name = variant["properties"]["type"]["const"]
            places[name], shared[name] = [variant], set(common)
    return places, shared


def typed(fragment, schema):
    """The parts of a key's schema that hold its type: itself, its alternatives or elements, or what it refers to."""
    if "$ref" in fragment:
        fragment = schema["$defs"][fragment["$ref"].removeprefix("#/$defs/")]
    parts = [fragment, *fragment.get("oneOf", [])]
    return parts + [fragment["items"]] if isinstance(fragment.get("items"), dict) else parts


def set_key(fragment, key, schema):
    """Lets the schema of a key say what the list does."""
    found = False
    for part in typed(fragment, schema):
        if key["kind"] in ("number", "integer") and part.get("type") == key["kind"]:
            part["minimum"], part["maximum"] = key["min"], key["max"]
            found = True
        if key["kind"] == "choice" and "enum" in part:
            part["enum"] = key["names"]
            found = True
    default = json_of(key["initial"])
    rest = {name: part for name, part in fragment.items() if name not in ("description", "default")}
    fragment.clear()
    fragment |= {"description": description_of(key)} | rest | ({} if default is None else {"default": default})
    return found or key["kind"] == "key"


def principled_schema(key, old):
    kind = key["kind"]
    result = {}
    if kind == "key":
        result = {name: part for name, part in old.items() if name not in ("description", "default")}
    elif kind in TEXTURED or kind in MAPS:
        result = {"$ref": "#/$defs/" + (TEXTURED | MAPS)[kind]}
    elif kind == "flag":
        result = {"type": "boolean"}
    else:
        result = {"type": "number"}
        if kind != "angle":
            result |= {"minimum": key["min"], "maximum": key["max"]}
        if kind == "index":
            result = {"oneOf": [result, {"const": 0}]}
    default = json_of(key["initial"])
    return {"description": description_of(key)} | result | ({} if default is None else {"default": default})


def set_principled(variant, values):
    old = variant["properties"]
    shared = {name: old[name] for name in ("type", *COMMON["material"])}
    variant["properties"] = shared | {name: principled_schema(key, old.get(name, {})) for name, key in values.items()}
    variant["dependentRequired"] = {name: [key["needs"], *NEEDS_MORE.get(name, [])]
                                    for name, key in values.items() if key.get("needs", "NONE") != "NONE"}


def set_object(of, keys, places, shared, schema):
    """Lets the schema of an object say what the list does; yields what must be mended by hand."""
    present = set().union(*(place["properties"] for place in places)) - shared - {"type", "$schema"}
    for name in sorted(present ^ set(keys)):
        yield f"{KEYS if name in present else SCHEMA} lacks {of}.{name}"
    for place in places:
        for name, key in keys.items():
            if name in place["properties"] and not set_key(place["properties"][name], key, schema):
                yield f"{of}.{name} is a {key['kind']} in {KEYS}, but not in {SCHEMA}"
        required = [name for name, key in keys.items() if key["initial"] == "required"]
        if required:
            place["required"] = [name for name in place.get("required", []) if name == "type"] + required


def one_line(value):
    if isinstance(value, dict) and value:
        return "{ " + ", ".join(f"{json.dumps(name)}: {one_line(part)}" for name, part in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(one_line, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def dump(value, indent="", name=""):
    """As the schema is laid out: what fits into a line of 120 columns, and is not the whole, stands in one."""
    label = f"{json.dumps(name)}: " if name else ""
    line = indent + label + one_line(value)
    if not isinstance(value, (dict, list)) or indent and len(line) < 120:
        return line
    inside = [dump(part, indent + "    ", key) for key, part in value.items()] if isinstance(value, dict) \
        else [dump(part, indent + "    ") for part in value]
    opening, closing = "{}" if isinstance(value, dict) else "[]"
    return f"{indent}{label}{opening}\n" + ",\n".join(inside) + f"\n{indent}{closing}"


def main(arguments):
    lists = Lists()
    schema = json.loads(read(SCHEMA))
    places, shared = places_of(schema)
    problems = []
    for of, keys in lists.objects.items():
        if of == "principled":
            set_principled(places[of][0], keys)
        elif of in places:
            problems += set_object(of, keys, places[of], shared.get(of, set()), schema)
    problems += [f"{KEYS} has no line of {of}" for of in places if of not in lists.objects]
    shown = {of for tables in TABLES.values() for objects in tables for of in objects}
    problems += [f"no table of {PAGE} has the keys of {of}; see TABLES" for of in lists.objects if of not in shown]
    for name, new in ((SCHEMA, dump(schema) + "\n"), (PAGE, with_tables(read(PAGE), lists))):
        if new == read(name):
            continue
        if arguments == ["--write"]:
            (ROOT / name).write_text(new, encoding="utf-8")
        else:
            problems.append(f"{name} does not say what {KEYS} and {VALUES} do; to let it follow them:"
                            " python3 cmake/checks/scene_keys.py --write")
    print("\n".join(problems) or f"{sum(map(len, lists.objects.values()))} keys")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
