"""Where the program is."""
from __future__ import annotations

import os
import shutil
from pathlib import Path

from ._errors import Error


def find_program() -> str:
    """The path of the program: that of the environment variable CANDELA, else in the package, else on the PATH."""
    named = os.environ.get("CANDELA")
    if named:
        if not os.access(named, os.X_OK) or os.path.isdir(named):
            raise Error(f"cannot run {named!r}, which the environment variable CANDELA names; name the program candela")
        return named
    inside = Path(__file__).with_name("candela")
    found = str(inside) if os.access(inside, os.X_OK) and inside.is_file() else shutil.which("candela")
    if found is None:
        raise Error("cannot find the program candela: it is neither in the package nor on the PATH; install it, or name "
                    "it in the environment variable CANDELA")
    return found
