// Where finished work goes if its place has become something else, or is gone, since it was checked.
#include <csignal>
#include <functional>

#include <sys/stat.h>

#include "cli/view_fixture.h"
#include "film/checkpoint.h"

namespace candela {
namespace {

// While it renders into the folder "place", from the folder "working", its places change; then Ctrl-C ends
// it.
class ChangedPlaces : public CliTest {
  protected:
    ChangedPlaces() {
        for (const char* folder : {"place", "working", "temporary"})
            std::filesystem::create_directory(file(folder));
    }

    std::string place(const std::string& name) const { return file("place/" + name); }
    std::string working(const std::string& name) const { return file("working/" + name); }

    // Returns its messages; the exit code is 1.
    std::string messages_after(const std::function<void()>& change) const {
        ProcessOptions surroundings = options({{"CANDELA_VALIDATION", "0"}, {"TMPDIR", file("temporary")}});
        surroundings.terminal = true;
        Process process(Words{"/usr/bin/env", "-C", file("working")} +
                            call({"render", CORNELL_BOX, "--size", "32x32", "--spp", "16777216", "-o",
                                  place("a.exr"), "-o", place("a.png"), "-o", working("b.exr"), "--report",
                                  place("r.json"), "--checkpoint", place("state.exr")}),
                        surroundings);
        EXPECT_TRUE(process.wait_for_err("Msamples/s"));
        change();
        process.send(SIGINT);
        const ProcessResult result = process.finish();
        EXPECT_EQ(result.exit_code, 1);
        return result.err;
    }
    static void expect_said(const std::string& messages, const std::string& asked, const std::string& kept) {
        const std::string error = "candela: error: cannot write \"" + asked + "\": ";
        const size_t start = messages.find(error);
        ASSERT_NE(start, std::string::npos) << messages;
        const std::string line = messages.substr(start, messages.find('\n', start) - start);
        EXPECT_CONTAINS(line, "; the data is saved in \"" + kept + '"');
    }
    static void expect_all_there(const std::string& folder) {
        EXPECT_EQ(read_exr(folder + "/a-1.exr").full, uvec2(32, 32));
        EXPECT_EQ(read_file(folder + "/a-1.png").substr(1, 3), "PNG");
        EXPECT_EQ(nlohmann::json::parse(read_file(folder + "/r-1.json"))["complete"], false);
        EXPECT_GT(load_checkpoint(folder + "/state-1.exr").states.at(0).total_samples(), 0u);
    }
};

TEST_F(ChangedPlaces, ThatAreFoldersOrPipesPutThePictureBeside) {
    const std::string messages = messages_after([&] {
        std::filesystem::create_directory(place("a.exr"));
        std::filesystem::create_directory(place("r.json"));
        std::filesystem::create_directory(place("state.exr"));
        ASSERT_EQ(::mkfifo(place("a.png").c_str(), 0600), 0);
    });
    for (const char* name : {"a", "r", "state"}) {
        const std::string extension = name == std::string("r") ? ".json" : ".exr";
        expect_said(messages, place(name + extension), place(name + ("-1" + extension)));
    }
    expect_said(messages, place("a.png"), place("a-1.png"));
    expect_all_there(file("place"));
    EXPECT_EQ(read_exr(working("b.exr")).full, uvec2(32, 32));
}

TEST_F(ChangedPlaces, ThatAreGonePutThePictureIntoTheWorkingFolder) {
    const std::string messages = messages_after([&] { std::filesystem::remove(file("place")); });
    expect_said(messages, place("a.exr"), working("a-1.exr"));
    expect_all_there(file("working"));
    EXPECT_EQ(read_exr(working("b.exr")).full, uvec2(32, 32));
}

TEST_F(ChangedPlaces, ThatAreAllGonePutThePictureAmongTheTemporaryFiles) {
    const std::string messages = messages_after([&] {
        std::filesystem::remove(file("place"));
        std::filesystem::remove(file("working"));
    });
    size_t pictures = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(file("temporary"))) {
        if (entry.is_directory()) continue;
        EXPECT_CONTAINS(messages, "; the data is saved in \"" + entry.path().string() + '"');
        if (entry.path().filename() == "a-1.exr") {
            ++pictures;
            EXPECT_EQ(read_exr(entry.path()).full, uvec2(32, 32));
        }
    }
    EXPECT_EQ(pictures, 1u);
}

#ifdef CANDELA_FILE_FAULT

// The environment in which the file becomes a folder (tests/faults/file_fault.cpp) once its place has been
// checked, which takes two calls: a file is made there, and removed.
std::map<std::string, std::string> becoming_a_folder(const std::string& path, const std::string& log) {
    return {{"LD_PRELOAD", CANDELA_FILE_FAULT},
            {"FILE_FAULT_FOLDER", path.substr(0, path.rfind('/'))},
            {"FILE_FAULT_AT", "3"},
            {"FILE_FAULT_ERRNO", "0"},
            {"FILE_FAULT_LOG", log},
            {"FILE_FAULT_BECOMES_FOLDER", path}};
}

TEST_F(ChangedPlaces, ConcernAllCommandsThatWrite) {
    const std::string picture = working("a.exr"), report = working("r.json");
    ASSERT_EQ(render({"-o", picture, "--size", "8x8"}).exit_code, 0);
    ASSERT_EQ(render({"-o", working("b.exr"), "--size", "8x8", "--reference", picture, "--seed", "2",
                      "--report", report})
                  .exit_code,
              0);
    for (const Words& command : {Words{"merge", picture, "-o", place("a.exr")},
                                 Words{"compare", picture, picture, "--heatmap", place("a.png")},
                                 Words{"plot", report, "-o", place("a.svg")}}) {
        const std::string output = command.back();
        const ProcessResult result = candela(command, becoming_a_folder(output, file("log")));
        EXPECT_EQ(result.exit_code, 1) << command.front();
        const std::string kept = place("a-1" + output.substr(output.rfind('.')));
        expect_said(result.err, output, kept);
        EXPECT_GT(std::filesystem::file_size(kept), 0u);
    }
}

using ChangedPlacesOfAWindow = ViewTest;

TEST_F(ChangedPlacesOfAWindow, KeepEachScreenshot) {
    std::filesystem::create_directory(file("place"));
    const std::string folder = file("place/a.exr");
    const ProcessResult result =
        view({"--size", "100x60", "--frames", "2", "--screenshot", folder, "--screenshot", file("b.exr")},
             CORNELL_BOX, becoming_a_folder(folder, file("log")))
            .finish();
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_CONTAINS(result.err, "; the data is saved in \"" + file("place/a-1.exr") + '"');
    for (const char* name : {"place/a-1.exr", "b.exr"})
        EXPECT_EQ(read_exr(file(name)).full, uvec2(100, 60));
}

#endif

}  // namespace
}  // namespace candela
