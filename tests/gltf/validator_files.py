#!/usr/bin/env python3
"""Reads the test files of Khronos' glTF-Validator with candela, and tests what becomes of every flaw:

    python3 tests/gltf/validator_files.py CANDELA CHECKOUT      # glTF-Validator: class and pointer of every flaw
    python3 tests/gltf/validator_files.py CANDELA --any FOLDER  # any files: no crash, no hang, errors with their place

CHECKOUT is a copy of https://github.com/KhronosGroup/glTF-Validator, which has a report beside each file. validator.md
states for each code, in places within a file if need be, whether a flaw is refused, warned of or ignored, and why; it
also has the exceptions, file by file. Each file is read twice: as it stands, and with a scene that shows everything in
the file (wire.py), with its animations and variants. A flaw is considered if it lies in what is read (reach.py).

The class of a file is that of the strictest flaw considered. The pointer of an error must match that of a flaw to be
refused. Each flaw to be warned of must match a warning, and each warning such a flaw. Pointers match if they are equal;
if one lies within the other and both name an element of a top-level array; or if one is a reference to what the other
lies in, over any number of steps within data and images. Ends with 1 if anything differs.
"""
import collections
import fnmatch
import json
import math
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import reach
import wire

CLASSES = ("ignore", "warn", "refuse")
MOVING = ("--time", "0.5", "--animation", "all")
HANG = 60  # Seconds.
# Said of files without a flaw, too.
REMARKS = re.compile(r"there is no light;|there is no camera;|the scene has no surfaces|left out points or lines"
                     r"|left out a primitive without area|the extension .* is not read: |what these extensions add |range of a light is ignored"
                     r"|posed by the first animation|has no animations|ignored what KHR_animation_pointer moves"
                     r"|only small or dim surfaces emit light")
LINE = re.compile(r"candela: (error|warning): (.*)")
# The pointer is empty if the message is about the file as a whole, and None if it names a line of it.
Message = collections.namedtuple("Message", "kind pointer text")
Result = collections.namedtuple("Result", "outcome messages problem")
Rule = collections.namedtuple("Rule", "code where outcome reason")


def read(candela, file, options=()):
    try:
        run = subprocess.run([candela, "info", file, *options], capture_output=True, text=True, errors="replace",
                             timeout=HANG, check=False)
    except subprocess.TimeoutExpired:
        return Result("refuse", [], "hangs")
    messages, problem = [], None
    for kind, text in LINE.findall(run.stderr):
        place = re.match(re.escape(str(file)) + r"(#(?:/[^:]*)?|:\d+:\d+)?: ", text)
        if place:
            at = place.group(1) or ""
            messages.append(Message(kind, None if at.startswith(":") else at[1:], text[place.end():]))
        else:
            problem = f"names no place: {text}"
    errors = [message for message in messages if message.kind == "error"]
    if run.returncode not in (0, 1):
        problem = f"exit code {run.returncode}: {run.stderr.strip()[-200:]}"
    elif (run.returncode == 1) != (len(errors) == 1):
        problem = problem or f"exit code {run.returncode} with {len(errors)} errors"
    outcome = "refuse" if run.returncode else "warn" if any(not REMARKS.search(m.text) for m in messages) else "ignore"
    return Result(outcome, messages, problem)


def rows_of(text, heading):
    """The cells of the table below a heading, without its head."""
    table = text.split(heading + "\n")[1].split("\n## ")[0]
    lines = [line for line in table.splitlines() if line.startswith("|")][2:]
    return [[cell.strip().strip("`") for cell in line.strip("|").split(" | ")] for line in lines]


def rule_for(rules, code, pointer):
    return next((rule for rule in rules if rule.code == code and fnmatch.fnmatchcase(pointer or "", rule.where)), None)


def matches(document, ours, theirs):
    """Whether two pointers are about the same thing."""
    if theirs in (None, "", "/") or ours is None:
        return True  # Of the file as a whole, or text that is not JSON.

    def nested(a, b):
        return a == b or (a.count("/") >= 2 and b.startswith(a + "/"))

    def about(a, b):
        return nested(a, b) or nested(b, a)

    return about(ours, theirs) or any(about(target, theirs) for target in reach.targets_of(document, ours)) or \
        any(about(target, ours) for target in reach.targets_of(document, theirs))


def check(result, document, counting):
    """What is wrong with a result, given the considered flaws, as (rule, pointer)."""
    if result.problem:
        return result.problem
    expected = max((rule.outcome for rule, _ in counting), key=CLASSES.index, default="ignore")
    flaws = [(rule, pointer) for rule, pointer in counting if rule.outcome == expected]
    notable = [m for m in result.messages if not REMARKS.search(m.text)]
    if expected == "refuse" and result.outcome == "refuse":
        error = next(m for m in result.messages if m.kind == "error")
        if not any(matches(document, error.pointer, pointer) for _, pointer in flaws):
            return f"the error is at {error.pointer}, not at {' or '.join(str(p) for _, p in flaws)}"
        return None
    if expected == "warn":
        for rule, pointer in flaws:
            if result.outcome != "refuse" and not any(matches(document, m.pointer, pointer) for m in result.messages):
                return f"no warning of {rule.code} at {pointer}"
        for message in notable:
            if result.outcome == "warn" and not any(matches(document, message.pointer, p) for _, p in flaws):
                return f"a warning at {message.pointer}, where no flaw is: {message.text}"
        if result.outcome == "ignore":  # What is said of files without a flaw, too, was about this one.
            return None
    if result.outcome != expected:
        codes = ", ".join(sorted({f"{rule.code} at {pointer}" for rule, pointer in flaws})) or "nothing to be said"
        return f"{result.outcome}, not {expected} ({codes}): {'; '.join(f'#{m.pointer}: {m.text}' for m in notable)}"
    return None


def parse(file):
    """The JSON document of a file; None if there is none. Of a .glb also the chunks after it, and what is too much."""
    data, rest = file.read_bytes(), None
    if data.startswith(b"glTF"):
        if len(data) < 20 or data[16:20] != b"JSON":
            return None, None
        end, size = struct.unpack_from("<8xII", data)
        data, rest = data[20:20 + size], (data[20 + size:end], data[end:])
    try:
        document = json.loads(data.decode("utf-8"), parse_constant=float)
    except ValueError:
        return None, None
    return (document, rest) if isinstance(document, dict) else (None, None)


def write_wired(file, document, rest, folder):
    for beside in file.parent.iterdir():
        if not (folder / beside.name).exists() and beside != file:
            (folder / beside.name).symlink_to(beside.resolve())
    text = json.dumps(document).encode("utf-8")
    path = folder / file.name
    if rest is None:
        path.write_bytes(text)
    else:
        text += b" " * (-len(text) % 4)
        chunks, excess = rest
        header = struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(chunks), len(text), b"JSON")
        path.write_bytes(header + text + chunks + excess)
    return path


def test_file(candela, file, rules, excused):
    """Yields for each way to read a file: the way, its result, what counted, and what is wrong."""
    issues = json.loads(Path(f"{file}.report.json").read_text(encoding="utf-8"))["issues"]["messages"]
    flaws = [(rule_for(rules, m["code"], m.get("pointer")), m.get("pointer")) for m in issues]
    document, rest = parse(file)

    def counting(document, timed, variant):
        reader = reach.Reader(document, timed, variant) if document is not None else None
        return [(rule, pointer) for rule, pointer in flaws
                if not pointer or reader is None or reader.is_reached(pointer)
                or reach.value_at(document, pointer) in (math.inf, -math.inf)]  # These are not numbers of JSON.

    ways = [("as it stands", lambda: (file, document), False, None)]
    always = [rule for rule, pointer in counting(document, False, None) if rule.outcome == "refuse"]
    if document is not None and not always:
        variants = bool(((document.get("extensions") or {}).get("KHR_materials_variants") or {}).get("variants"))

        def wired():
            full = wire.wired(document, lambda d: reach.Reader(d, True, variants).seen, rest is not None)
            return write_wired(file, full, rest, Path(folder)), full

        ways.append(("all shown", wired, True, "0" if variants else None))
    with tempfile.TemporaryDirectory() as folder:
        for way, make, timed, variant in ways:
            path, made = make()
            timed = timed and bool(made.get("animations"))
            options = [*(MOVING if timed else ()), *(("--variant", variant) if variant else ())]
            result = read(candela, path, options)
            count = counting(made, timed, variant)
            problem = check(result, made or {}, count)
            excuse = next((outcome for (name, at), outcome in excused.items()
                           if at in (way, "both") and str(file).endswith("/" + name)), None)
            if excuse and not result.problem:
                problem = "is no exception" if not problem else \
                    f"{result.outcome}, not {excuse} as an exception" if result.outcome != excuse else None
            yield way, result, count, problem


def print_outcomes(outcomes):
    for way, counts in outcomes.items():
        total = sum(counts.values())
        print(f"{way}: " + ", ".join(f"{counts[c]} {c}" for c in reversed(CLASSES)) + f", of {total} files")


def test_validator(candela, checkout):
    files = sorted(path for path in Path(checkout, "test").rglob("*") if path.suffix in (".gltf", ".glb"))
    if not files:
        sys.exit(f"{checkout}/test has no glTF files; name a copy of glTF-Validator")
    text = Path(__file__).with_suffix("").with_name("validator.md").read_text(encoding="utf-8")
    rules = [Rule(*row[:1], row[1] or "*", *row[2:]) for row in rows_of(text, "## Codes")]
    excused = {(file, way): outcome for file, way, outcome, _ in rows_of(text, "## Exceptions")}
    wrong, outcomes, counted = [], collections.defaultdict(collections.Counter), collections.Counter()
    for rule in rules:
        if rule.outcome not in CLASSES or not rule.reason:
            wrong.append(f"validator.md: {rule.code} has no class or no reason")
    for file in files:
        report = json.loads(Path(f"{file}.report.json").read_text(encoding="utf-8"))
        missing = {m["code"] for m in report["issues"]["messages"] if not rule_for(rules, m["code"], m.get("pointer"))}
        if missing:
            wrong.append(f"validator.md has no row for {', '.join(sorted(missing))} of {file.name}")
            continue
        for way, result, count, problem in test_file(candela, file, rules, excused):
            outcomes[way][result.outcome] += 1
            counted.update({rule for rule, _ in count})
            if problem:
                wrong.append(f"{file.relative_to(Path(checkout, 'test'))} ({way}): {problem}")
    wrong += [f"validator.md: the exception of {name} is for no file" for name, _ in excused
              if not any(str(file).endswith("/" + name) for file in files)]
    print_outcomes(outcomes)
    print(f"{len(rules)} rules for {len({rule.code for rule in rules})} codes; without a flaw that counts: " +
          (", ".join(f"{rule.code} {rule.where}" for rule in rules if not counted[rule]) or "none"))
    return wrong


def test_any(candela, folder):
    files = sorted(path for path in Path(folder).rglob("*") if path.suffix in (".gltf", ".glb"))
    wrong, outcomes = [], collections.defaultdict(collections.Counter)
    for file in files:
        document, rest = parse(file)
        with tempfile.TemporaryDirectory() as wired_folder:
            ways = {"as it stands": (file, ())}
            if document and "asset" in document:
                full = wire.wired(document, lambda d: reach.Reader(d, True, False).seen, rest is not None)
                ways["all shown"] = (write_wired(file, full, rest, Path(wired_folder)),
                                     MOVING if full.get("animations") else ())
            for way, (path, options) in ways.items():
                result = read(candela, path, options)
                outcomes[way][result.outcome] += 1
                wrong += [f"{file} ({way}): {result.problem}"] if result.problem else []
                for message in result.messages:
                    if not REMARKS.search(message.text):
                        print(f"{file.relative_to(folder)} ({way}): {message.kind}: #{message.pointer}: {message.text}")
    print_outcomes(outcomes)
    return wrong if files else [f"{folder} has no glTF files"]


if __name__ == "__main__":
    if len(sys.argv) == 4 and sys.argv[2] == "--any":
        WRONG = test_any(sys.argv[1], sys.argv[3])
    elif len(sys.argv) == 3:
        WRONG = test_validator(*sys.argv[1:])
    else:
        sys.exit(__doc__)
    print("\n".join(WRONG), file=sys.stderr)
    sys.exit(1 if WRONG else 0)
