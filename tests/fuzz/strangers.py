#!/usr/bin/env python3
"""Changes glTF files and native scenes where their structure is, and has candela describe each.

usage: strangers.py CANDELA [--count 10000] [--seed N]

Each file has at most 64 KB; candela gets 512 MB. Prints how many runs ended in which way. Exits 1, and keeps the file in
build/fuzz/findings, if one ended otherwise than with 0, 1 or 5 (done, an error, out of memory), printed a control
character or "this is a bug", took more memory, or did not end within a minute. As root, candela runs as nobody.
"""
import argparse
import collections
import concurrent.futures
import copy
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIMIT = 512_000_000
SLACK = 160_000_000  # Memory of the program itself, and kept by malloc.
MAX_BYTES = 65536
HANG = 60.0
NUMBERS = [0, 1, -1, 2, 3, 255, 65535, 65536, 1 << 31, (1 << 32) - 1, 1 << 32, 1 << 53, 0.5, -0.0, 1e-300, 1e30, -1e38,
           3.4e38, 1e300]
NAMES = ["a.png", "a.obj", "a.mtl", "a.ply", "a.hdr", "a.glb", "../secret", "%2e%2e/secret", "..\\secret", "/dev/zero",
         "pipe", "outwards", ".", "", "data:;base64,AAAA", "data:;base64,*", "http://x/y", "a\u001b[31mb", "\u202egnp.a",
         "\u2028", "\u009b31m", "x" * 5000, "%", "%00", "a/../a.png"]
CONTROL = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069]")


def documents():
    """The files to begin with, by whether they are glTF."""
    found = []
    for folder, gltf in ((ROOT / "tests/fuzz/corpora/gltf", True), (ROOT / "tests/fuzz/corpora/scene", False),
                         (ROOT / "tests/fuzz/corpora/cost", True)):
        for path in sorted(folder.iterdir()):
            try:
                document = json.loads(path.read_text())
            except (UnicodeDecodeError, json.JSONDecodeError):
                continue
            if isinstance(document, dict):
                found.append((gltf, document))
    return found


def places(value, found):
    """All (container, key) of a document."""
    for key in range(len(value)) if isinstance(value, list) else list(value):
        found.append((value, key))
        if isinstance(value[key], (list, dict)):
            places(value[key], found)
    return found


def new_value(rng, old, document, others):
    kind = rng.randrange(10)
    if kind < 3 and isinstance(old, (int, float)):
        return rng.choice(NUMBERS) if kind else old + rng.choice([-1, 1])
    if kind < 4 and isinstance(old, str):
        return rng.choice(NAMES)
    if kind < 6:
        source = document if kind == 4 else rng.choice(others)[1]
        container, key = rng.choice(places(source, []))
        return copy.deepcopy(container[key])
    if kind < 8 and isinstance(old, list) and old:
        return old * rng.choice([2, 10, 100, 1000]) if len(json.dumps(old)) < 2000 else old[: len(old) // 2]
    if kind == 8:
        return rng.choice([None, True, [], {}, rng.choice(NUMBERS), rng.choice(NAMES)])
    return [old, old]


def mutate(rng, others):
    gltf, document = copy.deepcopy(rng.choice(others))
    for _ in range(rng.choice([1, 1, 2, 3, 5, 8])):
        found = places(document, [])
        if not found:
            break
        container, key = rng.choice(found)
        action = rng.randrange(12)
        if action == 0:
            del container[key]
        elif action == 1 and isinstance(container, list):
            container.insert(rng.randrange(len(container) + 1), copy.deepcopy(container[key]))
        elif action == 2 and isinstance(container, dict):
            container[rng.choice(NAMES + [k for c, k in found if isinstance(k, str)])] = container[key]
        elif action == 3 and isinstance(container[key], str) and container[key].startswith("data:"):
            text = list(container[key])
            for _ in range(rng.randrange(1, 9)):
                text[rng.randrange(len(text))] = rng.choice("ABCDwxyz0189+/=")
            container[key] = "".join(text)
        else:
            container[key] = new_value(rng, container[key], document, others)
    return gltf, json.dumps(document)


def make_folder(base):
    """What the files may name, and what they may not."""
    folder = base / "in"
    folder.mkdir()
    (base / "secret").write_text("secret " * 100)
    (folder / "outwards").symlink_to("../secret")
    os.mkfifo(folder / "pipe")
    shutil.copy(ROOT / "tests/references/grain.png", folder / "a.png")
    shutil.copy(ROOT / "scenes/sky.hdr", folder / "a.hdr")
    (folder / "a.obj").write_text("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n")
    (folder / "a.mtl").write_text("newmtl a\nmap_Kd a.png\n")
    (folder / "a.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                  "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                  "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    for path in (base, folder):
        path.chmod(0o755)
    return folder


def run(candela, path):
    """How a run ended; a finding begins with "!"."""
    user = {"user": 65534, "group": 65534, "extra_groups": []} if os.geteuid() == 0 else {}
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen([candela, "info", "--memory-limit", str(LIMIT), path], stdin=subprocess.DEVNULL,
                                   stdout=output, stderr=output, cwd=path.parent, **user,
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0)))
        end = time.monotonic() + HANG
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() > end:
                os.kill(process.pid, signal.SIGKILL)
                os.wait4(process.pid, 0)
                process.returncode = -9
                return "! hang"
            time.sleep(0.005)
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        text = output.read().decode(errors="backslashreplace")
    if process.returncode not in (0, 1, 5):
        return f"! exit code {process.returncode}"
    if usage.ru_maxrss * 1024 > LIMIT + SLACK:
        return f"! {usage.ru_maxrss // 1024} MiB"
    if "this is a bug" in text:
        return "! bug: " + text.strip().splitlines()[-1][:200]
    if CONTROL.search(text):
        return f"! control character {CONTROL.search(text).group()!r}"
    if "secret secret" in text:
        return "! secret"
    return {0: "done", 1: "refused", 5: "out of memory"}[process.returncode]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("candela", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=int(time.strftime("%Y%m%d")))
    options = parser.parse_args()
    rng = random.Random(options.seed)
    others = documents()
    findings = ROOT / "build/fuzz/findings"
    ends = collections.Counter()
    with tempfile.TemporaryDirectory() as base:
        folder = make_folder(pathlib.Path(base))
        candela = shutil.copy(options.candela, pathlib.Path(base) / "candela")  # Where every user may run it.

        def step(number, gltf, text):
            path = folder / f"{number}.{'gltf' if gltf else 'json'}"
            path.write_text(text)
            end = run(candela, path)
            if end.startswith("!"):
                findings.mkdir(parents=True, exist_ok=True)
                kept = shutil.copy(path, findings / f"strangers-{options.seed}-{path.name}")
                print(f"{kept}: {end[2:]}", flush=True)
            path.unlink()
            return end.split(":")[0]

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            waiting = set()
            for number in range(options.count):
                gltf, text = mutate(rng, others)
                while len(text) > MAX_BYTES:
                    gltf, text = mutate(rng, others)
                waiting.add(pool.submit(step, number, gltf, text))
                if len(waiting) >= 4 * os.cpu_count():
                    done, waiting = concurrent.futures.wait(waiting, return_when="FIRST_COMPLETED")
                    ends.update(future.result() for future in done)
            ends.update(future.result() for future in waiting)
    print(f"seed {options.seed}:", ", ".join(f"{count} {end}" for end, count in ends.most_common()))
    sys.exit(any(end.startswith("!") for end in ends))


if __name__ == "__main__":
    main()
