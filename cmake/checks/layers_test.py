#!/usr/bin/env python3
"""Tests layers.py: a tree that keeps the rules passes, and each planted violation is found, with its place."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CHECKER = Path(__file__).resolve().with_name("layers.py")
TABLE = CHECKER.parents[2] / "CONTRIBUTING.md"

GOOD = {
    "CONTRIBUTING.md": TABLE.read_text(encoding="utf-8"),
    "host/CMakeLists.txt": "candela_library(os)\ncandela_library(base candela_os)\ncandela_library(image candela_base PNG::PNG)\n"
    "candela_library(scene candela_image)\n",
    "host/base/error.h": "// Errors.\n#pragma once\n",
    "host/base/math.h": "// Math.\n#pragma once\n#include <glm/glm.hpp>\n",
    "host/image/image_io.cpp": "// Files.\n#include <ImfHeader.h>\n#include <stb_image_write.h>\n",
    "host/vk/device.h": '// A device.\n#pragma once\n#include <volk.h>\n#include "base/error.h"\n',
    "host/scene/scene.h": '// A scene.\n#pragma once\n#include "base/math.h"\n',
    "host/load/json.h": "// JSON.\n#pragma once\n#include <nlohmann/json.hpp>\n",
    "host/bvh/bvh.cpp": '// A tree.\n#include "shared/types.h"\n',
    "host/render/renderer.cpp": '// Renders.\n#include "scene/scene.h"\n#include "vk/device.h"\n',
    "host/cli/options.h": '// Options.\n#pragma once\n#include "session/version.h"\n',
    "host/session/version.h.in": "// The version.\n#pragma once\n",
    "host/main.cpp": '// Starts.\n#include "cli/options.h"\nint main() {}\n',
    "shaders/shared/types.h": "// Types.\n#ifndef SHARED_TYPES_H\n#define SHARED_TYPES_H\n"
    '#include "base/math.h"\n#endif\n',
    "shaders/base/warp.glsl": "// Warps.\n#ifndef BASE_WARP_GLSL\n#define BASE_WARP_GLSL\n"
    '#include "shared/types.h"\n#endif\n',
    "shaders/scene/scene_data.glsl": "// Data.\n#ifndef SCENE_SCENE_DATA_GLSL\n#define SCENE_SCENE_DATA_GLSL\n"
    "layout(binding = 0) uniform usamplerBuffer nodes;\n#endif\n",
    "shaders/kernels/render.comp.glsl": '// Renders.\n#include "base/warp.glsl"\nvoid main() {}\n',
    "tests/unit/a_test.cpp": "// Tests a.\n",
}

GUARD = "#ifndef BSDF_A_GLSL\n#define BSDF_A_GLSL\n"

# (what is planted, its file, its text, what the checker must say)
VIOLATIONS = [
    ("a scene that knows Vulkan", "host/scene/a.cpp", '// A.\n#include "vk/device.h"\n',
     'host/scene/a.cpp:2: includes "vk/device.h", but host/scene/ may include only host/scene, host/base, host/image'),
    ("base that knows of ours", "host/base/a.cpp", '// A.\n\n#include "scene/scene.h"\n',
     'host/base/a.cpp:3: includes "scene/scene.h", but host/base/ may include only host/base, host/os'),
    ("Vulkan objects that know vectors", "host/vk/a.cpp", '// A.\n#include "base/math.h"\n',
     "host/vk/a.cpp:2: includes"),
    ("the renderer that knows the command line", "host/render/a.cpp", '// A.\n#include "cli/options.h"\n',
     'host/render/a.cpp:2: includes "cli/options.h", but host/render/ may include only '),
    ("a file that is nowhere", "host/render/a.cpp", '// A.\n#include "a.h"\n',
     'includes "a.h", which is neither below host/ nor below shaders/'),
    ("Vulkan by its own name", "host/bvh/a.cpp", "// A.\n#include <vulkan/vulkan.h>\n",
     "host/bvh/a.cpp:2: sees Vulkan (<vulkan/vulkan.h>), but host/bvh/ must not"),
    ("a rival in the renderer", "host/render/a.cpp", "// A.\n#include <embree3/rtcore.h>\n",
     "host/render/a.cpp:2: sees Embree (<embree3/rtcore.h>), but host/render/ must not"),
    ("JSON through another file", "host/render/a.cpp", '// A.\n#include "load/json.h"\n',
     "sees nlohmann-json (<nlohmann/json.hpp>) through host/load/json.h:3, but host/render/ must not"),
    ("a BSDF that sees buffers", "shaders/bsdf/a.glsl", f'// A.\n{GUARD}#include "scene/scene_data.glsl"\n#endif\n',
     "shaders/bsdf/a.glsl:4: includes"),
    ("a BSDF that declares one", "shaders/bsdf/a.glsl",
     f"// A.\n{GUARD}layout(std430, binding = 7) buffer B {{ uint b; }};\n#endif\n",
     "shaders/bsdf/a.glsl:4: declares a buffer or an image"),
    ("a library with main()", "shaders/bsdf/a.glsl", f"// A.\n{GUARD}void main() {{}}\n#endif\n",
     "they alone, define main()"),
    ("a kernel without main()", "shaders/kernels/a.comp.glsl", "// A.\n", "they alone, define main()"),
    ("a kernel elsewhere", "shaders/bsdf/a.comp.glsl", "// A.\nvoid main() {}\n", "*.comp.glsl in shaders/kernels/"),
    ("a missing guard", "shaders/bsdf/a.glsl", "// A.\n", "lacks the include guard BSDF_A_GLSL"),
    ("a missing pragma", "host/base/a.h", "// A.\n", "host/base/a.h:1: lacks #pragma once"),
    ("a library that links what its folder may not include", "host/CMakeLists.txt",
     "candela_library(image)\ncandela_library(vk candela_base)\n\ncandela_library(scene candela_image candela_vk)\n",
     "host/CMakeLists.txt:4: candela_scene links candela_vk, which host/scene/ may not include"),
    ("a library that does not link what its folder may include", "host/CMakeLists.txt",
     "candela_library(os)\ncandela_library(base candela_os)\ncandela_library(film nlohmann_json::nlohmann_json)\n",
     "host/CMakeLists.txt:3: candela_film does not link candela_base, which host/film/ may include"),
    ("a window system below the window", "host/view/a.cpp", "// A.\n#include <GLFW/glfw3.h>\n",
     "host/view/a.cpp:2: sees GLFW (<GLFW/glfw3.h>), but host/view/ must not"),
    ("a public header that shows more", "host/session/session.h", '// A.\n#pragma once\n#include "base/error.h"\n',
     "host/session/session.h:3: includes base/error.h, but may include only the standard library"),
    ("a cycle", "shaders/bsdf/a.glsl", f'// A.\n{GUARD}#include "bsdf/a.glsl"\n#endif\n', "includes itself in the end"),
    ("an unknown folder", "host/gui/a.cpp", "// A.\n", "the folder host/gui/ is not in the table of layers"),
    ("a file without a comment", "host/base/a.cpp", "int a;\n", "host/base/a.cpp:1: must begin with a comment"),
    ("a line that is too long", "shaders/shared/a.inc", f"// A.\n// {118 * 'a'}\n", "shaders/shared/a.inc:2: is longer"),
    ("a test without a comment", "tests/unit/b_test.cpp", "int b;\n", "tests/unit/b_test.cpp:1: must begin with"),
]


def check(files):
    """Exit code and output of the checker on a tree of those files."""
    with tempfile.TemporaryDirectory() as root:
        for name, text in files.items():
            path = Path(root, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        result = subprocess.run([sys.executable, CHECKER, root], capture_output=True, text=True, check=False)
        return result.returncode, result.stdout


class Layers(unittest.TestCase):
    def test_a_tree_that_keeps_the_rules_passes(self):
        self.assertEqual(check(GOOD), (0, "15 files, 0 problems\n"))

    def test_each_planted_violation_is_found_and_nothing_else(self):
        for what, name, text, message in VIOLATIONS:
            with self.subTest(what):
                code, output = check(GOOD | {name: text})
                self.assertEqual(code, 1)
                self.assertIn(message, output)
                for line in output.splitlines()[:-1]:
                    self.assertTrue(line.startswith(name + ":"), line)

    def test_an_empty_tree_is_an_error(self):
        self.assertEqual(check({})[0], 1)


if __name__ == "__main__":
    unittest.main()
