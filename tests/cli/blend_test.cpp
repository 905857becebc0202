// Files of Blender, which a stand-in for Blender exports: a script that writes what it is called with.
#include <filesystem>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

class Blend : public CliTest {
  protected:
    // A program of that name.
    std::string program(const std::string& name, const std::string& script) {
        const std::string path = write(name, "#!/bin/sh\n" + script + "\n");
        fs::permissions(path, fs::perms::owner_all);
        return path;
    }
    ProcessResult info(std::map<std::string, std::string> environment) {
        return candela({"info", write("a scene.blend", "BLENDER"), "--json"},
                       environment + std::map<std::string, std::string>{{"TMPDIR", temporary()}} + NO_DRIVER);
    }
    std::string temporary() {
        fs::create_directory(file("tmp"));
        return file("tmp");
    }
    bool is_clean() { return fs::is_empty(temporary()); }

    // A glTF file of one triangle, at the path that the last argument is.
    const std::string export_ = R"(for target; do :; done
        echo "$@" >")" + file("call") +
                                R"("
        cat >"$target" <<'GLTF'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}
GLTF)";
};

TEST_F(Blend, IsExportedByTheBlenderOnThePath) {
    program("blender", export_);
    const ProcessResult result = info({{"PATH", directory_.path().string() + ":/usr/bin:/bin"}});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(nlohmann::json::parse(result.out)["primitives"], 1);
    const std::string call = read_file(file("call"));
    EXPECT_CONTAINS(call, "--background --factory-startup --disable-autoexec " + file("a scene.blend"));
    EXPECT_TRUE(is_clean());
}

TEST_F(Blend, IsExportedByThePythonThatAVariableNames) {
    const std::string python = program("python3.11", export_);
    const ProcessResult result = info({{"CANDELA_BLENDER", python}});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_CONTAINS(read_file(file("call")), "export.py -- " + file("a scene.blend"));
}

TEST_F(Blend, SaysWhatToInstallWithoutBlender) {
    const ProcessResult result = info({{"PATH", "/nonexistent"}});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_CONTAINS(result.err,
                    "a scene.blend: only Blender can read it, and \"blender\" cannot be run (No such");
    EXPECT_CONTAINS(result.err,
                    "install Blender 4.2 or newer, or name one in the environment variable CANDELA_BLENDER");
    EXPECT_TRUE(is_clean());
}

TEST_F(Blend, SaysWhyBlenderFailed) {
    for (const char* const script :
         {"echo Error: too old; echo; echo Blender quit; exit 1", "echo Error: too old"}) {
        const ProcessResult result = info({{"CANDELA_BLENDER", program("fails", script)}});
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_CONTAINS(result.err, "cannot export it: Error: too old; export it to glTF in Blender");
    }
    EXPECT_CONTAINS(info({{"CANDELA_BLENDER", program("fails", "kill -9 $$")}}).err, "it said nothing");
    EXPECT_TRUE(is_clean());
}

}  // namespace
}  // namespace candela
