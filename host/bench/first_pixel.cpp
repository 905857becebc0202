// See first_pixel.h.
#include "bench/first_pixel.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"
#include "base/text.h"
#include "bench/clocks.h"
#include "probe/embedded.h"

namespace candela {
namespace {

double seconds(const timeval& time) {
    return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
}

std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> result;
    for (std::string& word : words)
        result.push_back(word.data());
    result.push_back(nullptr);
    return result;
}

// Our environment with these variables ("NAME=value") added or replaced.
std::vector<std::string> environment_with(const std::vector<std::string>& variables) {
    std::vector<std::string> all = variables;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string_view old(*variable);
        const auto same_name = [&](const std::string& s) {
            return old.starts_with(s.substr(0, s.find('=') + 1));
        };
        if (std::ranges::none_of(variables, same_name)) all.emplace_back(old);
    }
    return all;
}

// Runs a program to its end; it must succeed.
Clocks run_program(std::vector<std::string> arguments, const std::vector<std::string>& variables) {
    std::vector<std::string> environment = environment_with(variables);
    const Stopwatch watch;
    pid_t pid = 0;
    const int error = ::posix_spawn(&pid, arguments[0].c_str(), nullptr, nullptr, pointers(arguments).data(),
                                    pointers(environment).data());
    if (error != 0) throw Error("cannot start " + arguments[0] + ": " + std::strerror(error));
    int status = 0;
    rusage usage{};
    while (::wait4(pid, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    const double wall = watch.elapsed().wall;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        std::string call;
        for (const std::string& word : arguments)
            call += (call.empty() ? "" : " ") + word;
        const std::string end = WIFEXITED(status) ? concat("exited with ", WEXITSTATUS(status))
                                                  : concat("was ended by signal ", WTERMSIG(status));
        throw Error("first-pixel: `" + call + "` " + end + "; see its messages above");
    }
    return {seconds(usage.ru_utime) + seconds(usage.ru_stime), wall};
}

}  // namespace

std::vector<Row> bench_first_pixel(const BenchOptions& options, const std::filesystem::path& program,
                                   const std::optional<std::filesystem::path>& scene_file,
                                   const std::optional<std::string>& device) {
    const std::string name = scene_file ? scene_file->string() : "Cornell box";
    options.progress("first-pixel: " + name);
    const TemporaryFolder scratch("first-pixel");
    const std::filesystem::path file = scene_file.value_or(scratch.path() / "cornell-box.json");
    if (!scene_file) write_file_atomically(file, embedded::cornell_box_json);
    std::vector<std::string> call{
        program.string(), "render", file.string(), "--spp", "1",
        "--size",         "64x64",  "--quiet",     "-o",    (scratch.path() / "first.png").string()};
    if (device) call.insert(call.end(), {"--device", *device});
    const std::vector<std::string> cold{"CANDELA_NO_CACHE=1", "MESA_SHADER_CACHE_DISABLE=true"};
    const std::vector<std::string> warm{"XDG_CACHE_HOME=" + scratch.path().string()};
    run_program(call, warm);  // Fills the caches.

    std::vector<Row> rows;
    rows.push_back({.subject = name, .what = "first image, cold", .unit = "s"});
    rows.push_back({.subject = name, .what = "first image, warm", .unit = "s"});
    for (uint32_t run = 0; run < options.runs; ++run) {
        for (Row& row : rows) {
            const Clocks clocks = run_program(call, &row == &rows[0] ? cold : warm);
            row.ours.push_back(clocks.cpu);
            row.ours_wall.push_back(clocks.wall);
        }
    }
    return rows;
}

}  // namespace candela
