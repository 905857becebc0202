// See blend_file.h.
#include "cli/blend_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/printable.h"
#include "base/text.h"
#include "load/quote.h"

namespace candela {
namespace fs = std::filesystem;

namespace {

constexpr const char* VARIABLE = "CANDELA_BLENDER";

// What Blender runs, in the file, or a Python that opens it first.
constexpr const char* SCRIPT = R"(import sys
import bpy
import addon_utils
*source, target = sys.argv[sys.argv.index("--") + 1:]
if source:
    bpy.ops.wm.open_mainfile(filepath=source[0], use_scripts=False)
addon_utils.enable("io_scene_gltf2")
bpy.ops.export_scene.gltf(filepath=target, export_format="GLB", export_apply=True, export_cameras=True,
                          export_lights=True, export_animations=False)
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

// Runs a program, whose messages go to a file; `status` says how it ended, as wait() does. Returns errno if
// it cannot be run, and otherwise 0.
int run(std::vector<std::string> words, const fs::path& messages, int& status) {
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, messages.c_str(),
                                       O_WRONLY | O_CREAT | O_TRUNC, S_IRUSR | S_IWUSR);
    ::posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    pid_t pid = 0;
    const int error = ::posix_spawnp(&pid, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    while (error == 0 && ::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    return error;
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
    const char* const named = std::getenv(VARIABLE);
    const std::string program = named != nullptr && *named != '\0' ? named : "blender";
    const fs::path script = folder_.path() / "export.py", messages = folder_.path() / "messages";
    write_file_atomically(script, SCRIPT);
    int status = 0;
    if (const int error = run(call_of(program, script, file, gltf()), messages, status); error != 0) {
        throw Error(concat(file.string(), ": only Blender can read it, and ", quote(program),
                           " cannot be run (", std::strerror(error),
                           "); install Blender 4.2 or newer, or name one in the ", "environment variable ",
                           VARIABLE, ", or a Python that has the module bpy"));
    }
    std::error_code ignored;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !fs::exists(gltf(), ignored)) {
        throw Error(concat(file.string(), ": ", quote(program),
                           " cannot export it: ", printable(last_words(messages), MAX_MESSAGE_BYTES),
                           "; export it to glTF in Blender"));
    }
}

}  // namespace candela
