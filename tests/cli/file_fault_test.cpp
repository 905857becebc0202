// File operations fail, one after the other (tests/faults/file_fault.cpp), in a rendering that reads a scene
// of several files and a checkpoint and writes a checkpoint, two images and a report, with a warm cache.
// Whatever fails, each file is the old or the new one, and messages and exit codes say which; what was
// rendered is there, if need be elsewhere.
#include <array>
#include <cerrno>
#include <map>
#include <sstream>

#include "cli/cli_fixture.h"
#include "film/checkpoint.h"
#include "film/identity.h"

#ifdef CANDELA_FILE_FAULT

namespace candela {
namespace {

namespace fs = std::filesystem;

// No errors: a write of half its bytes, and the name of the picture that becomes a folder.
constexpr int SHORT_COUNT = 0, BECOMES_FOLDER = -1;
constexpr std::array FAULTS{ENOSPC, EIO, EDQUOT, EBUSY, EPERM, EINTR, SHORT_COUNT, BECOMES_FOLDER};

constexpr uint32_t OLD_SPP = 2, NEW_SPP = 4;

class FileFaults : public CliTest {
  protected:
    FileFaults() {
        fs::create_directory(folder_);
        write_scene();
        const ProcessResult first = render(OLD_SPP);
        EXPECT_EQ(first.exit_code, 0) << first.err;
        save("old");
        const ProcessResult result = render(NEW_SPP);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        save("new");
        EXPECT_EQ(render(NEW_SPP, {}, {"--report", "-"}).exit_code, 0);
    }

    // Makes every call fail, each in `ways` of the ways FAULTS, of which the next call has the next ones.
    void expect_faults_lose_nothing(size_t ways) const {
        size_t calls = 1;
        for (size_t call = 1; call <= calls; ++call) {
            for (size_t i = 0; i < ways; ++i) {
                const size_t count =
                    expect_fault_loses_nothing(call, FAULTS[(ways * call + i) % FAULTS.size()]);
                if (count == 0) return;  // The program ended before that call.
                calls = std::max(calls, count + 1);
            }
            ASSERT_LT(calls, 1000u);
        }
    }

  private:
    static constexpr std::array<const char*, 4> FILES{"a.exr", "a.png", "report.json", "state.exr"};

    std::string in_folder(const std::string& name) const { return (folder_ / name).string(); }

    // A quad that emits onto another, from an OBJ file with materials, below a sky of two texels.
    void write_scene() const {
        std::ofstream(in_folder("scene.json")) << R"({
            "cameras": {"main": {"position": [0, 1, 4], "look_at": [0, 0.5, 0], "vertical_fov": 40}},
            "shapes": [{"type": "obj", "file": "quads.obj"}],
            "environment": {"file": "sky.hdr"}})";
        std::ofstream(in_folder("quads.obj")) << "mtllib quads.mtl\n"
                                                 "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\n"
                                                 "v -1 2 -1\nv -1 2 1\nv 1 2 1\nv 1 2 -1\n"
                                                 "usemtl grey\nf 4 3 2 1\nusemtl lamp\nf 8 7 6 5\n";
        std::ofstream(in_folder("quads.mtl"))
            << "newmtl grey\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 3 3 3\n";
        std::ofstream(in_folder("sky.hdr"), std::ios::binary)
            << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x40\x40\x40\x7f\x40\x40\x80\x7f";
    }

    ProcessResult render(uint32_t spp, const std::map<std::string, std::string>& fault = {},
                         const Words& more = {}) const {
        const Words arguments{"render",       in_folder("scene.json"),
                              "--size",       "16x16",
                              "--spp",        std::to_string(spp),
                              "-o",           in_folder("a.exr"),
                              "-o",           in_folder("a.png"),
                              "--checkpoint", in_folder("state.exr"),
                              "--resume",     "--quiet"};
        ProcessOptions surroundings = options(fault);
        surroundings.environment["XDG_CACHE_HOME"] = in_folder("cache");
        surroundings.environment["CANDELA_VALIDATION"] = "0";  // Its layer has files of its own.
        return run_process(
            call(arguments + (more.empty() ? Words{"--report", in_folder("report.json")} : more)),
            surroundings);
    }

    void save(const std::string& state) const {
        fs::create_directory(directory_ / state);
        for (const char* name : FILES)
            fs::copy_file(folder_ / name, directory_ / state / name);
    }
    void restore(const std::string& state) const {
        if (fs::is_directory(picture())) fs::remove(picture());
        fs::remove(file_of("a.exr"));
        for (const char* name : FILES)
            fs::copy_file(directory_ / state / name, folder_ / name, fs::copy_options::overwrite_existing);
    }

    fs::path picture() const { return folder_ / "a.exr"; }
    // Where it is now, if its name has become a folder.
    fs::path file_of(const std::string& name) const {
        const fs::path was = folder_ / (name + ".was");
        return fs::exists(was) ? was : folder_ / name;
    }

    // The contents of the file of that name, which lies at `path`, except for times.
    static std::string contents(const std::string& name, const fs::path& path) {
        if (name == "a.exr") return std::to_string(image_hash(read_exr(path)));
        if (name == "a.png") return read_file(path);
        if (name == "report.json") return nlohmann::json::parse(read_file(path))["image_hash"];
        return std::to_string(load_checkpoint(path).states.at(0).total_samples());
    }
    bool is(const std::string& state, const char* name) const {
        return contents(name, file_of(name)) == contents(name, directory_ / state / name);
    }

    // Removes what the messages say was kept elsewhere, which must be new; returns how many files that are.
    size_t take_kept(const std::string& messages) const {
        const std::string words = "; the data is saved in \"";
        size_t kept = 0;
        for (size_t at = messages.find(words); at != std::string::npos; at = messages.find(words, at)) {
            at += words.size();
            const fs::path path = messages.substr(at, messages.find('"', at) - at);
            std::string name = path.filename().string();  // Such as a-1.exr.
            name.erase(name.find("-1"), 2);
            EXPECT_EQ(contents(name, path), contents(name, directory_ / "new" / name));
            fs::remove(path);
            ++kept;
        }
        return kept;
    }

    // The line of the log for that call, and how many lines it has.
    std::string log_line(size_t call, size_t& lines) const {
        std::ifstream log(directory_ / "log");
        std::string line, found;
        for (lines = 0; std::getline(log, line); ++lines) {
            std::istringstream words(line);
            size_t number = 0;
            if (words >> number && number == call) found = line;
        }
        return found;
    }

    // Returns how many calls there were; 0 if none failed.
    size_t expect_fault_loses_nothing(size_t call, int error) const {
        restore("old");
        fs::remove(directory_ / "log");
        const ProcessResult result = render(
            NEW_SPP, {{"LD_PRELOAD", CANDELA_FILE_FAULT},
                      {"FILE_FAULT_FOLDER", folder_.string()},
                      {"FILE_FAULT_LOG", file("log")},
                      {"FILE_FAULT_AT", std::to_string(call)},
                      {"FILE_FAULT_ERRNO", std::to_string(std::max(error, 0))},
                      {"FILE_FAULT_BECOMES_FOLDER", error == BECOMES_FOLDER ? picture().string() : ""}});
        size_t calls = 0;
        const std::string line = log_line(call, calls);
        SCOPED_TRACE(line + ", errno " + std::to_string(error) + ": " + result.err);
        const bool of_cache = line.find("/cache/") != std::string::npos;
        const bool to_remove = line.find(" unlink ") != std::string::npos;
        const bool passes =
            error == SHORT_COUNT || (error == EINTR && line.find(" rename ") == std::string::npos &&
                                     line.find(" mmap ") == std::string::npos);
        EXPECT_EQ(result.signal, 0);
        if (error == BECOMES_FOLDER) {
            EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << result.exit_code;
        } else {
            EXPECT_EQ(result.exit_code, line.empty() || of_cache || to_remove || passes ? 0 : 1);
        }
        EXPECT_EQ(result.err.starts_with("candela: error: "), result.exit_code == 1);
        size_t old = 0;
        for (const char* name : FILES) {
            const bool is_old = is("old", name);
            EXPECT_TRUE(is_old || is("new", name)) << name;
            old += is_old;
        }
        const size_t kept = take_kept(result.err);
        // Nothing was rendered, or all of it is kept.
        EXPECT_TRUE(old == FILES.size() ? kept == 0 : old == kept) << old << ' ' << kept;
        EXPECT_EQ(old == 0, result.exit_code == 0);
        expect_nothing_left(to_remove);
        return line.empty() ? 0 : calls;
    }

    // No temporary file stays but the one that could not be removed.
    void expect_nothing_left(bool to_remove) const {
        size_t left = 0;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_))
            left += entry.path().filename().string().starts_with(".candela-");
        EXPECT_LE(left, to_remove ? 1u : 0u);
    }

    const fs::path folder_ = directory_ / "work";
};

TEST_F(FileFaults, EveryCallMayFailInSomeWay) {
    expect_faults_lose_nothing(1);
}

using SlowFileFaults = FileFaults;

TEST_F(SlowFileFaults, EveryCallMayFailInEveryWay) {
    expect_faults_lose_nothing(FAULTS.size());
}

}  // namespace
}  // namespace candela

#endif
