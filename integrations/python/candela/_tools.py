"""What the command line does for images and devices."""
from __future__ import annotations

import json
import os
import re
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Union

from ._driver import environment
from ._errors import Error
from ._image import Image
from ._program import find_program

_DONE, _FAILED, _DIFFER = 0, 1, 6


@dataclass(frozen=True)
class Comparison:
    """Whether two images of a picture agree within their noise. `relmse` is their relative mean squared error, `text` what
    the command line prints."""

    agree: bool
    relmse: float
    text: str

    def __bool__(self) -> bool:
        return self.agree


@dataclass(frozen=True)
class Verdict:
    """What candela's checks of a device found. `report` has all of them."""

    passed: bool
    report: Dict[str, Any]

    def __bool__(self) -> bool:
        return self.passed


def _run(arguments: List[str], fine: int) -> subprocess.CompletedProcess[str]:
    """Runs the program; raises Error unless it ends with 0 or the code `fine`, and prints a result."""
    program = find_program()
    done = subprocess.run([program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False,
                          env=environment(program))
    if done.returncode not in (_DONE, fine) or not done.stdout:
        lines = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
        raise Error(re.sub("^candela: error: ", "", lines[-1]), code=done.returncode)
    return done


def compare(a: Union[Image, str, os.PathLike[str]], b: Union[Image, str, os.PathLike[str]]) -> Comparison:
    """Compares two images, or files (.exr), by z-tests if both have their variance, else by the relative mean squared
    error."""
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for name, image in (("a.exr", a), ("b.exr", b)):
            if isinstance(image, Image):
                path = Path(folder) / name
                image.save(path)
                files.append(str(path))
            else:
                files.append(os.fspath(image))
        done = _run(["compare", *files], _DIFFER)
    found = re.search(r"relMSE\s+(\S+)", done.stdout)
    return Comparison(done.returncode == _DONE, float(found[1]) if found else float("nan"), done.stdout)


def selftest(effort: str = "quick") -> Verdict:
    """Checks that images are right on the default device. effort: "quick", or "full", which takes a minute on a CPU."""
    done = _run(["selftest", "--json", "--effort", effort], _FAILED)
    return Verdict(done.returncode == _DONE, json.loads(done.stdout))
