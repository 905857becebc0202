// See blend_file.h.
#include "cli/blend_file.h"

#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/printable.h"
#include "base/text.h"
#include "load/quote.h"
#include "os/process.h"
#include "os/program.h"

namespace candela {
namespace fs = std::filesystem;

namespace {

constexpr const char* VARIABLE = "CANDELA_BLENDER";

// What Blender runs, in the file, or a Python that opens it first.
constexpr const char* SCRIPT = R"(import os
import sys
import bpy
import addon_utils
*source, target = sys.argv[sys.argv.index("--") + 1:]
if source:
    bpy.ops.wm.open_mainfile(filepath=source[0], use_scripts=False)
addon_utils.enable("io_scene_gltf2")
bpy.ops.export_scene.gltf(filepath=target, export_format="GLB", export_apply=True, export_cameras=True,
                          export_lights=True, export_animations=False)
if source:
    os._exit(0)  # The end of Python crashes the module of Blender 4.2.
)";

// The call of the program that exports a file.
std::vector<std::string> call_of(const std::string& program, const fs::path& script, const fs::path& file,
                                 const fs::path& target) {
    const std::string path = fs::absolute(file).string();
    if (fs::path(program).filename().string().starts_with("python"))
        return {program, script.string(), "--", path, target.string()};
    return {program,
            "--background",
            "--factory-startup",
            "--disable-autoexec",
            path,
            "--python-exit-code",
            "1",
            "--python",
            script.string(),
            "--",
            target.string()};
}

// The last line about an error, otherwise the last that says something.
std::string last_words(const fs::path& file) {
    std::string error, last = "it said nothing";
    std::ifstream lines(file);
    for (std::string line; std::getline(lines, line);) {
        if (line.find_first_not_of(' ') == std::string::npos) continue;
        if (line.find("Error") != std::string::npos) error = line;
        last = line;
    }
    return error.empty() ? last : error;
}

}  // namespace

bool is_blend_file(const fs::path& file) {
    return file.extension() == ".blend";
}

ExportedBlend::ExportedBlend(const fs::path& file) : folder_(file.string()) {
    const std::string named = os::environment(VARIABLE), program = named.empty() ? "blender" : named;
    const fs::path script = folder_.path() / "export.py", messages = folder_.path() / "messages";
    write_file_atomically(script, SCRIPT);
    os::ProgramEnd end;
    try {
        end = os::run_program(
            {.words = call_of(program, script, file, gltf()), .variables = {}, .output = messages});
    } catch (const std::system_error& error) {
        throw Error(concat(file.string(), ": only Blender can read it, and ", quote(program),
                           " cannot be run (", error.code().message(),
                           "); install Blender 4.2 or newer, or name one in the ", "environment variable ",
                           VARIABLE, ", or a Python that has the module bpy"));
    }
    std::error_code ignored;
    if (!end.succeeded() || !fs::exists(gltf(), ignored)) {
        throw Error(concat(file.string(), ": ", quote(program),
                           " cannot export it: ", printable(last_words(messages), MAX_MESSAGE_BYTES),
                           "; export it to glTF in Blender"));
    }
}

}  // namespace candela
