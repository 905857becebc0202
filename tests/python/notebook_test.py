#!/usr/bin/env python3
"""Runs the cells of the notebooks as a script, one after the other. usage: notebook_test.py CANDELA"""
import ast
import json
import os
import sys
import unittest
import warnings
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "integrations/python"))


def run(path):
    """Runs a notebook; returns what its cells show."""
    shown, names = [], {"__name__": "__main__"}
    for i, cell in enumerate(json.loads(path.read_text(encoding="utf-8"))["cells"]):
        if cell["cell_type"] != "code":
            continue
        tree = ast.parse("".join(cell["source"]), f"{path.name}, cell {i}")
        last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, f"{path.name}, cell {i}", "exec"), names)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), f"{path.name}, cell {i}", "eval"), names)
            png = getattr(value, "_repr_png_", None)
            shown.append(repr(value) if png is None else png())
    return shown


class Notebooks(unittest.TestCase):
    def test_all_run(self):
        warnings.simplefilter("error")
        paths = sorted((ROOT / "integrations/python/examples").glob("*.ipynb"))
        self.assertEqual([path.name for path in paths], ["arrays.ipynb"])
        for path in paths:
            shown = run(path)
            self.assertIn("Device(index=0", shown[0])
            self.assertGreaterEqual(sum(isinstance(value, bytes) and value.startswith(b"\x89PNG") for value in shown), 2)


if __name__ == "__main__":
    os.environ["CANDELA"] = os.path.abspath(sys.argv.pop(1))
    unittest.main()
