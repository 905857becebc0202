// Signals at any moment of a rendering: it ends as the signal ends programs, or with valid files. Nothing
// else happens, and no file is ever half a one.
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <functional>
#include <random>
#include <thread>
#include <tuple>

#include "base/file.h"
#include "cli/cli_fixture.h"
#include "film/checkpoint.h"
#include "image/texel_io.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t FEW = 64, ENDLESS = 16777216;  // Samples per pixel.

class Kills : public CliTest {
  protected:
    // Sends signals to that many renderings: to some at any moment, to others once they render; half of them
    // would never end. The numbers of a seed are the same everywhere, what they hit is not.
    void expect_valid_ends(int kills) const {
        std::mt19937 random{uint32_t(kills)};
        constexpr std::array SIGNALS{SIGINT, SIGTERM, SIGHUP, SIGKILL};
        for (int i = 0; i < kills; ++i) {
            const int signal = SIGNALS[random() % SIGNALS.size()];
            const uint32_t spp = random() % 2 == 0 ? FEW : ENDLESS;
            const bool renders = random() % 2 == 0;
            const std::chrono::milliseconds moment(random() % 600);
            SCOPED_TRACE("kill " + std::to_string(i) + ", signal " + std::to_string(signal) + " after " +
                         std::to_string(moment.count()) + " ms");
            fs::create_directory(folder_);
            Process process(rendering(spp), options({{"CANDELA_VALIDATION", "0"}}));
            if (renders) process.wait_for_err("rendering");
            std::this_thread::sleep_for(moment);
            process.send(signal);
            expect_valid_end(process.finish(), signal, spp);
            fs::remove_all(folder_);
        }
    }

  private:
    Words rendering(uint32_t spp) const {
        return call({"render",       CORNELL_BOX,     "--size",
                     "32x32",        "--spp",         std::to_string(spp),
                     "-o",           in("a.exr"),     "-o",
                     in("a.png"),    "--report",      in("r.json"),
                     "--checkpoint", in("state.exr"), "--checkpoint-every",
                     "0.02s",        "--write-every", "0.03s",
                     "--progress",   "json"});
    }
    std::string in(const std::string& name) const { return (folder_ / name).string(); }

    // The files that are there are whole: an Error of their readers fails the test. Returns their number.
    size_t count_valid() const {
        std::vector<std::string> warnings;
        const std::map<std::string, std::function<void(const std::string&)>> readers = {
            {"a.exr", [](const std::string& path) { read_exr(path); }},
            {"a.png", [&](const std::string& path) { decode_texels(read_file(path), path, warnings); }},
            {"r.json", [](const std::string& path) { std::ignore = nlohmann::json::parse(read_file(path)); }},
            {"state.exr", [](const std::string& path) { load_checkpoint(path); }}};
        size_t files = 0;
        for (const auto& [name, read] : readers) {
            if (!fs::exists(in(name))) continue;
            read(in(name));
            ++files;
        }
        EXPECT_EQ(warnings, std::vector<std::string>{});
        return files;
    }

    void expect_valid_end(const ProcessResult& result, int signal, uint32_t spp) const {
        const size_t valid = count_valid();
        if (result.signal != 0) {
            EXPECT_EQ(result.signal, signal) << result.err;
            return;
        }
        EXPECT_TRUE(result.exit_code == 0 || (result.exit_code == 130 && signal != SIGKILL))
            << result.exit_code << ": " << result.err;
        const bool loading = result.err.find("interrupted while the scene was loaded") != std::string::npos;
        EXPECT_EQ(valid, loading ? 0u : 4u) << result.err;
        if (result.exit_code == 0) {
            const Image image = read_exr(in("a.exr"));
            EXPECT_EQ(std::ranges::min(image.find("SampleCount.V")->values), float(spp));
        }
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
            EXPECT_FALSE(entry.path().filename().string().starts_with(".candela-")) << entry;
    }

    const fs::path folder_ = directory_ / "work";
};

TEST_F(Kills, EndARenderingOrLeaveValidFiles) {
    expect_valid_ends(6);
}

using SlowKills = Kills;

TEST_F(SlowKills, EndARenderingOrLeaveValidFiles) {
    expect_valid_ends(200);
}

}  // namespace
}  // namespace candela
