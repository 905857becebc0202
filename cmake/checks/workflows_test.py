#!/usr/bin/env python3
"""Checks what the workflows in .github/workflows may reach: they only read the repository, and what they use from
others is named by its hash, which nobody can move."""
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
USES = re.compile(r"\buses:\s*(\S+)")
IMAGE = re.compile(r"""\b(?:container|image):\s*["']?([^"'\s,}]+)""")


def faults(text):
    """What is wrong with a workflow, line by line."""
    found = []
    if not re.search(r"^permissions:\n  contents: read\n(?! )", text, re.MULTILINE) or text.count("permissions:") > 1:
        found.append("the workflow may do more than read the repository")
    for used in USES.findall(text):
        if not re.search(r"^\./|@[0-9a-f]{40}$", used):
            found.append(f"{used} is not pinned by the hash of a commit")
    for image in IMAGE.findall(text):
        if not image.startswith("$") and not re.search(r"@sha256:[0-9a-f]{64}$", image):
            found.append(f"{image} is not pinned by its digest")
    return found


class Workflows(unittest.TestCase):
    def test_each_is_pinned_and_only_reads(self):
        workflows = list((ROOT / ".github/workflows").glob("*.y*ml"))
        self.assertTrue(workflows)
        for path in workflows:
            self.assertEqual(faults(path.read_text()), [], path)

    def test_what_can_be_moved_is_found(self):
        start = "on: push\npermissions:\n  contents: read\n"
        commit, digest = "0123456789" * 4, "01234567" * 8
        self.assertEqual(faults(f"{start}- uses: a/b@{commit}  # v1\ncontainer: c:1@sha256:{digest}\n"), [])
        self.assertEqual(faults(f"{start}container: ${{{{ matrix.container }}}}\n"), [])
        self.assertEqual(len(faults(f"{start}- uses: a/b@v1\n- uses: a/b@{commit[1:]}\n- uses: a/b\n")), 3)
        self.assertEqual(len(faults(f"{start}container: c:1\nimage: 'c@sha256:{digest[1:]}'\n"
                                    "- { name: d, container: \"d:1\" }\n")), 3)
        self.assertEqual(len(faults("on: push\n")), 1)
        self.assertEqual(len(faults("permissions: write-all\n")), 1)
        self.assertEqual(len(faults(f"{start}  packages: write\n")), 1)
        self.assertEqual(len(faults(f"{start}jobs:\n  a:\n    permissions: write-all\n")), 1)


if __name__ == "__main__":
    unittest.main()
