#!/usr/bin/env python3
"""Checks that the schema and the page of scene files have the principled material of host/scene/principled_values.inc.

usage: principled_keys.py [--write]

Without --write, it ends with 1 if they differ, and says what to do; with it, it makes them the same.
"""

import json
import re
import sys
from pathlib import Path

LIST, SCHEMA, PAGE = "host/scene/principled_values.inc", "scenes/scene.schema.json", "docs/scene-format.md"
TEXTURED = {"color": "texturedReflectance", "radiance": "texturedRadiance", "weight": "texturedWeight",
            "thickness": "texturedThickness"}
MAPS = {"vector_map": "vectorMap", "normal_map": "normalMap"}
# What the list does not say of what is not a value: the schema, and the default on the page.
KEYS = {"thin_walled": ({"type": "boolean"}, "`true`; `false` with `absorption`"),
        "absorption": ({"$ref": "#/$defs/absorption"}, "none"),
        "priority": ({"type": "integer", "minimum": 0, "maximum": 15, "default": 0}, "0")}
NEEDS_MORE = {"iridescence_thickness_min": ["iridescence_thickness"]}
ENTRY = re.compile(r"""^(VALUE|KEY)\(((?:[^"]|"(?:[^"\\]|\\.)*")*?)\)$""", re.MULTILINE)
STRING = re.compile(r'"((?:[^"\\]|\\.)*)"')


def number(text):
    """A number of C++, as Python and JSON write it."""
    value = float(re.sub(r"^vec3\((.*)\)$", r"\1", text).rstrip("f"))
    return int(value) if value.is_integer() else value


def entries(text):
    """The lines of the list, each a dict."""
    for macro, inside in ENTRY.findall(text):
        words = [word.strip() for word in inside[:inside.index('"')].split(",")]
        prose = "".join(re.sub(r"\\(.)", r"\1", part) for part in STRING.findall(inside))
        if macro == "KEY":
            yield {"kind": "key", "name": words[0], "text": prose}
            continue
        kind, name, initial, least, most, needs = words[:6]
        yield {"kind": kind, "name": name, "initial": initial, "least": least, "most": most, "needs": needs,
               "text": prose}


def initial_of(entry):
    """The default as JSON; None for maps."""
    if entry["kind"] in MAPS:
        return None
    return entry["initial"] == "true" if entry["kind"] == "flag" else number(entry["initial"])


def superscript(value):
    return "10" + str(len(str(value)) - 1).translate(str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")) \
        if value >= 10000 else str(value)


def prose_of(entry):
    if "{range}" not in entry["text"]:
        return entry["text"]
    least, most = (superscript(number(entry[limit])) for limit in ("least", "most"))
    return entry["text"].replace("{range}", f"from {least} to {most}")


def row(entry):
    """A row of the page's table."""
    if entry["kind"] == "key":
        default = KEYS[entry["name"]][1]
    else:
        value = initial_of(entry)
        default = "none" if value is None else f"`{json.dumps(value)}`" if isinstance(value, bool) else str(value)
    mark = "T" if entry["kind"] in TEXTURED else ""
    return f"| `{entry['name']}` | {mark} | {prose_of(entry)} | {default} |".replace("|  |", "| |")


def schema_of(entry):
    """The schema of a key."""
    text = prose_of(entry).replace("`", "")
    result = {"description": text[0].upper() + text[1:] + "."}
    kind = entry["kind"]
    if kind == "key":
        return result | KEYS[entry["name"]][0]
    value = initial_of(entry)
    if kind in TEXTURED:
        result["description"] += f" {value} if absent."
        return result | {"$ref": "#/$defs/" + TEXTURED[kind]}
    if kind in MAPS:
        return result | {"$ref": "#/$defs/" + MAPS[kind]}
    if kind == "flag":
        return result | {"type": "boolean", "default": value}
    limited = {"type": "number"}
    if kind != "angle":
        limited |= {"minimum": number(entry["least"]), "maximum": number(entry["most"])}
    if kind == "index":
        return result | {"oneOf": [limited, {"const": 0}], "default": value}
    return result | limited | {"default": value}


def json_lines(name, value, indent):
    """A key as the schema is laid out: an object without objects in it, unless it has a description, in one line."""
    def text(part):
        return re.sub(r"^\{(.*)\}$", r"{ \1 }", json.dumps(part, ensure_ascii=False)) if isinstance(part, dict) \
            else "[" + ", ".join(map(text, part)) + "]" if isinstance(part, list) \
            else json.dumps(part, ensure_ascii=False)

    lines = [f"{indent}    {json.dumps(key)}: {text(part)}" for key, part in value.items()]
    return f"{indent}{json.dumps(name)}: {{\n" + ",\n".join(lines) + f"\n{indent}}}"


def with_schema(text, values):
    start = text.index('"description": "A dielectric or metallic base under layers')
    head, text = text[:start], text[start:]
    outer, inner = " " * 20, " " * 24
    needs = {value["name"]: [value["needs"], *NEEDS_MORE.get(value["name"], [])]
             for value in values if value.get("needs", "NONE") != "NONE"}
    lines = ",\n".join(f"{inner}{json.dumps(name)}: {json.dumps(others)}" for name, others in needs.items())
    begin = text.index('"dependentRequired": {\n') + len('"dependentRequired": {\n')
    text = text[:begin] + lines + text[text.index(f"\n{outer}}},\n", begin):]
    begin = text.index('"vertex_colors": { "$ref": "#/$defs/vertexColors" },\n') + \
        len('"vertex_colors": { "$ref": "#/$defs/vertexColors" },\n')
    keys = ",\n".join(json_lines(value["name"], schema_of(value), inner) for value in values)
    return head + text[:begin] + keys + text[text.index(f"\n{outer}}}\n", begin):]


def with_table(text, values):
    section = text.index("\n### Principled\n")
    head = "| key | | value | default |\n|---|---|---|---|\n"
    begin = text.index(head, section) + len(head)
    return text[:begin] + "\n".join(map(row, values)) + text[text.index("\n\n", begin):]


def main(arguments):
    root = Path(__file__).resolve().parents[2]
    values = list(entries((root / LIST).read_text(encoding="utf-8")))
    wrong = []
    for name, made in ((SCHEMA, with_schema), (PAGE, with_table)):
        old = (root / name).read_text(encoding="utf-8")
        new = made(old, values)
        if new == old:
            continue
        wrong.append(name)
        if arguments == ["--write"]:
            (root / name).write_text(new, encoding="utf-8")
    if wrong and arguments != ["--write"]:
        print(f"{LIST} says something else than {' and '.join(wrong)};"
              " to let them follow it: python3 cmake/checks/principled_keys.py --write", file=sys.stderr)
        return 1
    print(f"{len(values)} keys")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
