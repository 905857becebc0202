# SPDX-License-Identifier: GPL-3.0-or-later
"""The program, which goes on running between pictures."""
import os
from pathlib import Path

import bpy

from . import candela

_session = None
_options = None


def session():
    """The running program, which begins when it is first needed, when another device is chosen, and after it has ended."""
    global _session, _options
    preferences = _preferences()
    options = (preferences.program if preferences else "", preferences.device if preferences else "")
    if _session is not None and (not _session.is_open or options != _options):
        close()
    if _session is None:
        program, device = options
        make_executable()
        if program:
            os.environ["CANDELA"] = bpy.path.abspath(program)
        _session = candela.Session(device=device or None)
        _options = options
    return _session


def make_executable():
    """Lets the program in the add-on run, which Blender unpacks as a file like any other."""
    inside = Path(candela.__file__).with_name("candela")
    if inside.is_file() and not os.access(inside, os.X_OK):
        inside.chmod(inside.stat().st_mode | 0o755)


def close():
    """Ends the program."""
    global _session
    if _session is not None:
        _session.close()
        _session = None


def _preferences():
    found = bpy.context.preferences.addons.get(__package__) if bpy.context.preferences else None
    return found.preferences if found is not None else None
