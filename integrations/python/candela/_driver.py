"""The Vulkan driver of the package candela-lavapipe, for machines that have no other."""
from __future__ import annotations

import functools
import glob
import importlib.util
import json
import os
import subprocess
from pathlib import Path
from typing import Dict, List, Optional

PACKAGE = "candela_lavapipe"
# By these, users tell Vulkan's loader which drivers there are.
_NAMED = ("VK_DRIVER_FILES", "VK_ICD_FILENAMES")
_MANIFESTS = "vulkan/icd.d/*.json"


def environment(program: str) -> Optional[Dict[str, str]]:
    """What the program needs besides this process's environment: nothing if there is a driver, or no such package."""
    folder = _folder()
    if folder is None or any(name in os.environ for name in _NAMED) or (_has_manifests() and _has_device(program)):
        return None
    libraries = [str(folder / "lib"), *filter(None, [os.environ.get("LD_LIBRARY_PATH")])]
    manifest = str(folder / "lvp_icd.json")
    return {**os.environ, "LD_LIBRARY_PATH": os.pathsep.join(libraries), **{name: manifest for name in _NAMED}}


def advice() -> str:
    """What else may help where no driver is."""
    return "" if _folder() is not None else "; or install the driver for CPUs by pip install candela-lavapipe"


def _folder() -> Optional[Path]:
    found = importlib.util.find_spec(PACKAGE)
    return None if found is None or found.origin is None else Path(found.origin).parent


def _has_manifests() -> bool:
    """Whether a driver says that it is there, where Vulkan's loader looks."""
    home = os.environ.get("HOME", "/nonexistent")
    folders: List[str] = ["/etc", os.environ.get("XDG_CONFIG_HOME") or f"{home}/.config",
                          os.environ.get("XDG_DATA_HOME") or f"{home}/.local/share"]
    for name, usual in (("XDG_CONFIG_DIRS", "/etc/xdg"), ("XDG_DATA_DIRS", "/usr/local/share:/usr/share")):
        folders += (os.environ.get(name) or usual).split(":")
    return any(glob.glob(f"{glob.escape(folder)}/{_MANIFESTS}") for folder in folders)


@functools.lru_cache(maxsize=None)
def _has_device(program: str) -> bool:
    """Whether such a driver has a device: its library, or its GPU, may be missing."""
    done = subprocess.run([program, "devices", "--json"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
    try:
        return any(device["usable"] for device in json.loads(done.stdout))
    except (ValueError, LookupError, TypeError):
        return False
