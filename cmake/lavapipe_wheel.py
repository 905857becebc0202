#!/usr/bin/env python3
"""Writes the wheel candela_lavapipe of Debian's packages, which lavapipe_wheel.sh has unpacked.
usage: lavapipe_wheel.py FOLDER WHEELS"""
import base64
import hashlib
import json
import re
import subprocess
import sys
import zipfile
from pathlib import Path

NAME, SUMMARY = "candela_lavapipe", "A Vulkan driver for CPUs, for candela where there is no other"
ROOTS = ("libvulkan_lvp.so", "libvulkan.so.1")
GLIBC = re.compile(r"^(ld-linux.*|lib(c|m|dl|rt|pthread|util|resolv|anl|mvec)\.so.*)$")
MOST_BYTES = 100 * 10**6
INIT = '"""Vulkan\'s loader and a driver for CPUs, from Debian: `candela` uses them where there is no driver."""\n'


def main(folder, wheels):
    """Writes the wheel, and prints its size."""
    root = folder / "root"
    places = {}  # Of libraries, by their names.
    for path in sorted(root.glob("usr/lib/x86_64-linux-gnu/*.so*")) + sorted(root.glob("lib/x86_64-linux-gnu/*.so*")):
        places.setdefault(path.name, path)
    owners = dict(line.split(" ", 1)[::-1] for line in (folder / "files/list").read_text().splitlines())
    owners = {Path(path.split(" -> ")[0]).name: package for path, package in owners.items()}
    needed, queue = {}, list(ROOTS)
    while queue:
        name = queue.pop()
        if name in needed or GLIBC.match(name):
            continue
        needed[name] = places[name].resolve()
        dynamic = subprocess.run(["objdump", "-p", needed[name]], check=True, stdout=subprocess.PIPE, text=True).stdout
        queue += re.findall(r"^\s*NEEDED\s+(\S+)", dynamic, re.MULTILINE)
    files = {f"{NAME}/__init__.py": INIT.encode(), f"{NAME}/lvp_icd.json": manifest(root)}
    packages = set()
    for name, path in needed.items():
        files[f"{NAME}/lib/{name}"] = path.read_bytes()
        packages.add(owners[name])
    versions = []
    for package in sorted(packages):
        files[f"{NAME}/licenses/{package}.txt"] = (root / f"usr/share/doc/{package}/copyright").read_bytes()
        versions.append((folder / f"files/{package}.version").read_text())
    files[f"{NAME}/packages.txt"] = "\n".join(versions).encode()
    mesa = re.search(r"^Version: (?:\d+:)?([0-9.]+)", (folder / "files/mesa-vulkan-drivers.version").read_text(),
                     re.MULTILINE)[1]
    minor = glibc_minor(needed.values())
    wheel = write(wheels, mesa, f"py3-none-manylinux_2_{minor}_x86_64", files)
    size = wheel.stat().st_size
    print(f"{wheel}: {size / 1e6:.1f} MB, {len(needed)} libraries of {len(packages)} packages, Mesa {mesa}")
    if size > MOST_BYTES:
        sys.exit(f"It has more than {MOST_BYTES / 1e6:.0f} MB.")


def manifest(root):
    """The driver's manifest, with its library beside it."""
    icd = json.loads((root / "usr/share/vulkan/icd.d/lvp_icd.x86_64.json").read_text())
    icd["ICD"]["library_path"] = f"./lib/{ROOTS[0]}"
    return json.dumps(icd, indent=4).encode()


def glibc_minor(paths):
    """The N of the newest GLIBC_2.N that any of them needs."""
    found = []
    for path in paths:
        symbols = subprocess.run(["objdump", "-T", path], check=True, stdout=subprocess.PIPE, text=True).stdout
        found += [int(minor) for minor in re.findall(r"\bGLIBC_2\.(\d+)", symbols)]
    return max(found)


def write(wheels, version, tag, files):
    """Writes a wheel: https://packaging.python.org/specifications/binary-distribution-format."""
    info = f"{NAME}-{version}.dist-info"
    files[f"{info}/METADATA"] = (f"Metadata-Version: 2.1\nName: {NAME.replace('_', '-')}\nVersion: {version}\n"
                                 f"Summary: {SUMMARY}\nRequires-Python: >=3.9\n").encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: candela\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    lines = []
    path = wheels / f"{NAME}-{version}-{tag}.whl"
    for old in wheels.glob(f"{NAME}-*.whl"):
        old.unlink()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, data in files.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            lines.append(f"{name},sha256={digest},{len(data)}\n")
            archive.writestr(entry(name), data)
        archive.writestr(entry(f"{info}/RECORD"), "".join(lines) + f"{info}/RECORD,,\n")
    return path


def entry(name):
    """An entry of an archive that is the same at any time."""
    found = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
    found.external_attr = 0o644 << 16
    found.compress_type = zipfile.ZIP_DEFLATED
    return found


main(Path(sys.argv[1]), Path(sys.argv[2]))
