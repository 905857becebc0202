# SPDX-License-Identifier: GPL-3.0-or-later
"""candela as a render engine of Blender. Runs the program `candela serve` and speaks its protocol; loads no compiled
module, so it does not break with a release of Blender."""
from . import engine, panels, settings

_PARTS = (settings, engine, panels)


def register() -> None:
    for part in _PARTS:
        part.register()


def unregister() -> None:
    for part in reversed(_PARTS):
        part.unregister()
