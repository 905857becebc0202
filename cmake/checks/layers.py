#!/usr/bin/env python3
"""Checks the rules of CONTRIBUTING.md, "Layers": who includes and links whom, and the form of every source file.

usage: layers.py ROOT      Prints one line per violation; exits 1 if there is any.
"""
import re
import sys
from pathlib import Path

# Where kernels are, what several of them share, and the only other files that declare buffers or images.
KERNEL_FOLDERS = ("shaders/kernels", "shaders/probes")
KERNEL_BODIES = ("shaders/kernels/pixel.glsl", "shaders/kernels/render.glsl")
DECLARE_BUFFERS = ("shaders/scene/scene_data.glsl", "shaders/probes/items.glsl", *KERNEL_BODIES)

# Library -> what its includes look like. The table of layers says which folders may see it, directly or through other
# files.
LIBRARIES = {
    "GLM": r"glm/",
    "stb": r"stb_",
    "OpenEXR": r"(OpenEXR/|Imath/)?(Imf|Imath|Iex|openexr|half\.h)",
    "libpng": r"png\.h",
    "libjpeg": r"jpeglib\.h|jerror\.h",
    "libwebp": r"webp/",
    "Basis Universal": r"basisu_transcoder",
    "Draco": r"draco/",
    "meshoptimizer": r"meshoptimizer",
    "nlohmann-json": r"nlohmann/",
    "tinyobjloader": r"tiny_obj_loader",
    "tinygltf": r"tiny_gltf",
    "CLI11": r"CLI/",
    "Vulkan": r"volk|vulkan/",
    "Embree": r"embree3/",
    "GLFW": r"GLFW/",
    "Dear ImGui": r"imgui|backends/imgui",
}

# Who may include a folder that may see one of these may see it, too: our own headers show it.
SHOWN = ("GLM", "Vulkan")

# The header of the library candela_session, for programs elsewhere: it hides the rest.
PUBLIC_HEADER = "host/session/session.h"

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)
MAIN = re.compile(r"^\s*void\s+main\s*\(", re.MULTILINE)
BINDING = re.compile(r"^\s*layout\s*\([^)]*\bbinding\b", re.MULTILINE)
ROW = re.compile(r"^\| `((?:host|shaders)[\w/]*)` \|.*\| ([^|]+) \|$", re.MULTILINE)
LINKS = re.compile(r"^ *candela_library\(([^)]*)\)", re.MULTILINE)


def read_layers(text):
    """The table of layers: folder -> folders and headers that its files may include besides itself; folder -> names of
    libraries."""
    may_include, libraries = {}, {}
    for folder, cell in ROW.findall(text):
        ours, _, others = cell.partition(";")
        top = folder.partition("/")[0]
        names = re.findall("`([^`]+)`", ours)
        may_include[folder] = [n if n.startswith(("host/", "shaders/")) else f"{top}/{n}" for n in names]
        if ours.strip() == "everything":
            may_include[folder] = ["host", "shaders/shared"] if top == "host" else ["shaders"]
        libraries[folder] = {name for name in LIBRARIES if re.search(rf"\b{name}\b", others)}
    for name in SHOWN:
        shown = {folder for folder in libraries if name in libraries[folder]}
        for folder, allowed in may_include.items():
            if shown & set(allowed) or "host" in allowed:
                libraries[folder].add(name)
    return may_include, libraries


class Checker:
    def __init__(self, root):
        self.root = root
        self.problems = []
        self.files = {}  # Path below the root -> text.
        table = root / "CONTRIBUTING.md"
        self.may_include, self.libraries = read_layers(table.read_text(encoding="utf-8") if table.exists() else "")
        for pattern in ("host/**/*.cpp", "host/**/*.h", "host/**/*.h.in", "shaders/**/*.glsl", "shaders/**/*.h",
                        "shaders/**/*.inc", "host/**/*.inc"):
            for path in sorted(root.glob(pattern)):
                self.files[path.relative_to(root).as_posix()] = path.read_text(encoding="utf-8")
        # File -> list of (line, what the line says, file of ours or None).
        self.includes = {name: self.find_includes(name, text) for name, text in self.files.items()}

    def report(self, name, line, message):
        self.problems.append(f"{name}:{line}: {message}")

    def find_includes(self, name, text):
        """Quoted includes start at host/ or shaders/, as the compilers' search paths do; CMake generates NAME.h
        from NAME.h.in."""
        found = []
        for match in INCLUDE.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            quoted, library = match.groups()
            candidates = (f"host/{quoted}", f"shaders/{quoted}", f"host/{quoted}.in")
            target = next((candidate for candidate in candidates if candidate in self.files), None)
            if quoted and target is None:
                self.report(name, line, f'includes "{quoted}", which is neither below host/ nor below shaders/')
            found.append((line, quoted or library, target))
        return found

    def reachable(self, name):
        """All files of ours that `name` includes, directly or not."""
        seen, stack = set(), [name]
        while stack:
            for _, _, target in self.includes[stack.pop()]:
                if target and target not in seen:
                    seen.add(target)
                    stack.append(target)
        return seen

    def check_edges(self, name, folder):
        allowed = [folder] + self.may_include[folder]
        for line, said, target in self.includes[name]:
            if target and not any(target == a or target.startswith(a + "/") for a in allowed):
                self.report(name, line, f'includes "{said}", but {folder}/ may include only {", ".join(allowed)}')

    def check_libraries(self, name, folder):
        """Shaders see no C++ library: the preprocessor hides them there."""
        for library, pattern in LIBRARIES.items():
            if library in self.libraries[folder] or folder.startswith("shaders/"):
                continue
            for source in sorted({name} | self.reachable(name)):
                for line, said, target in self.includes[source]:
                    if target is None and re.match(pattern, said):
                        how = "" if source == name else f" through {source}:{line}"
                        where = line if source == name else 1
                        self.report(name, where, f"sees {library} (<{said}>){how}, but {folder}/ must not")

    def check_links(self):
        """A library links, directly or through others, the folders that it may include, and directly none else."""
        name = "host/CMakeLists.txt"
        if not (self.root / name).exists():
            return
        text = (self.root / name).read_text(encoding="utf-8")
        links = {}
        for match in LINKS.finditer(text):
            folder, *linked = match[1].split()
            linked = re.findall(r"candela_(\w+)", " ".join(linked))
            all_linked = set(linked).union(*(links.get(other, set()) for other in linked))
            links[folder] = all_linked
            line = text.count("\n", 0, match.start()) + 1
            may = self.may_include.get(f"host/{folder}", [])
            needed = {path.split("/")[1] for path in may if path.startswith("host/")}
            for other in sorted(set(linked) - needed if "host" not in may else []):
                self.report(name, line,
                            f"candela_{folder} links candela_{other}, which host/{folder}/ may not include")
            for other in sorted(needed - all_linked):
                self.report(name, line,
                            f"candela_{folder} does not link candela_{other}, which host/{folder}/ may include")

    def check_public(self):
        for line, said, _ in self.includes.get(PUBLIC_HEADER, []):
            if not re.fullmatch("[a-z_0-9]+", said):
                self.report(PUBLIC_HEADER, line, f"includes {said}, but may include only the standard library")

    def check_cycles(self, name):
        if name in self.reachable(name):
            self.report(name, 1, "includes itself in the end; break the cycle")

    def check_comment(self, name, text):
        if not text.startswith("//"):
            self.report(name, 1, "must begin with a comment that says what the file is for")

    def check_form(self, name, folder):
        text = self.files[name]
        self.check_comment(name, text)
        if name.endswith(".inc"):  # A list that is read more than once, and that clang-format does not understand.
            for number, line in enumerate(text.splitlines(), 1):
                if len(line) > 120 or line != line.rstrip() or "\t" in line:
                    self.report(name, number, "is longer than 120 columns, ends with a blank or has a tab")
            return
        if name.startswith("host/"):
            if not name.endswith(".cpp") and not re.search(r"^#pragma once$", text, re.MULTILINE):
                self.report(name, 1, "lacks #pragma once")
            return
        is_kernel = name.endswith(".comp.glsl")
        stray = not is_kernel and folder == "shaders/kernels" and name not in KERNEL_BODIES
        if is_kernel and folder not in KERNEL_FOLDERS or stray:
            self.report(name, 1, "kernels, and they alone, are *.comp.glsl in shaders/kernels/; probes are in shaders/probes/")
        if is_kernel != bool(MAIN.search(text)):
            self.report(name, 1, "kernels, and they alone, define main()")
        guard = re.sub(r"\W", "_", name.removeprefix("shaders/")).upper()
        if not is_kernel and f"#ifndef {guard}\n#define {guard}\n" not in text:
            self.report(name, 1, f"lacks the include guard {guard}")
        binding = BINDING.search(text)
        if binding and not is_kernel and name not in DECLARE_BUFFERS:
            line = text.count("\n", 0, binding.end()) + 1
            self.report(name, line, "declares a buffer or an image; only scene/scene_data.glsl, kernels and probes do")

    def run(self):
        for name in self.files:
            folder = name.rpartition("/")[0]
            if folder not in self.may_include:
                self.report(name, 1, f"the folder {folder}/ is not in the table of layers")
                continue
            self.check_edges(name, folder)
            self.check_libraries(name, folder)
            self.check_cycles(name)
            self.check_form(name, folder)
        self.check_links()
        self.check_public()
        for pattern in ("tests/**/*.cpp", "tests/**/*.h", "tests/**/*.glsl"):
            for path in sorted(self.root.glob(pattern)):
                self.check_comment(path.relative_to(self.root).as_posix(), path.read_text(encoding="utf-8"))
        if not self.files:
            self.problems.append(f"{self.root}: no source file found")
        return self.problems


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    checker = Checker(Path(sys.argv[1]))
    problems = checker.run()
    for problem in problems:
        print(problem)
    print(f"{len(checker.files)} files, {len(problems)} problems")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
