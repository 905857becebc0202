# SPDX-License-Identifier: GPL-3.0-or-later
"""What cannot be said to candela, to be named in one list after rendering."""


class Notices:
    """Notices by what they are about, each once, in the order in which they were found."""

    def __init__(self):
        self._notices = {}

    def add(self, place, text):
        """place: Blender's name of a thing, such as 'Material "Glass", node "Noise Texture"'."""
        self._notices.setdefault(f"{place}: {text}")

    def take(self, others):
        """Those of other Notices, too."""
        self._notices.update(others._notices)

    def __iter__(self):
        return iter(self._notices)

    def __len__(self):
        return len(self._notices)
