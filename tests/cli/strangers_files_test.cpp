// Scene files of strangers: which files they may name, and what messages tell of them.
#include <filesystem>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

const std::string CAMERA =
    R"({"cameras": {"main": {"position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40}}, )";
const std::string TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string SECRET = "hunter2";

class StrangersFiles : public CliTest {
  protected:
    StrangersFiles() {
        fs::create_directory(file("in"));
        fs::create_directory(file("out"));
    }

    // The native scene that has these members besides its camera, in the folder `in`.
    std::string scene(const std::string& members) const {
        return write("in/scene.json", CAMERA + members + "}");
    }
};

// Whatever the format and the kind of file: refused, and read if that is allowed.
TEST_F(StrangersFiles, NameOnlyWhatIsInTheirFolderUnlessTheUserAllowsMore) {
    fs::copy_file(CANDELA_SCENES "/sky.hdr", file("out/sky.hdr"));
    fs::copy_file(CANDELA_SCENES "/knot.ply", file("out/knot.ply"));
    fs::copy_file(CANDELA_SCENES "/../tests/references/grain.png", file("out/grain.png"));
    write("out/m.obj", "mtllib m.mtl\n" + TRIANGLE + "vt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
    write("out/m.mtl", "newmtl a\nmap_Kd grain.png\n");
    write("in/far.mtl", "newmtl a\nmap_Kd ../out/grain.png\n");
    write("in/library.obj", "mtllib ../out/m.mtl\n" + TRIANGLE + "vt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
    write("in/texture.obj", "mtllib far.mtl\n" + TRIANGLE + "vt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
    write("in/image.gltf", R"({"asset": {"version": "2.0"}, "images": [{"uri": "%2e%2e/out/grain.png"}],
        "textures": [{"source": 0}], "materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}],
        "buffers": [{"uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA", "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}], "nodes": [{"mesh": 0}]})");
    const std::map<std::string, std::string> members{
        {"sky.hdr", R"("shapes": [], "environment": {"file": "../out/sky.hdr"})"},
        {"knot.ply", R"("shapes": [{"type": "ply", "file": "../out/knot.ply", "emission": 1}])"},
        {"m.obj", R"("shapes": [{"type": "obj", "file": "../out/m.obj", "emission": 1}])"},
        {"grain.png", R"("shapes": [{"type": "quad", "vertices": [[0,0,0],[1,0,0],[1,1,0],[0,1,0]],
             "emission": {"image": "../out/grain.png"}}])"}};
    std::vector<std::pair<std::string, std::string>> scenes{{"in/library.obj", "m.mtl"},
                                                            {"in/texture.obj", "grain.png"}};
    for (const auto& [name, text] : members)
        scenes.emplace_back("in/" + name + ".json", name);
    for (const auto& [name, text] : members)
        write("in/" + name + ".json", CAMERA + text + "}");
    for (const auto& [name, outside] : scenes) {
        SCOPED_TRACE(name);
        const ProcessResult refused = candela({"info", file(name)});
        EXPECT_EQ(refused.exit_code, 1);
        EXPECT_CONTAINS(refused.err, "../out/" + outside +
                                         "\": with links followed, it is not in the folder of "
                                         "the file that is opened, \"" +
                                         file("in") + "\"");
        for (const Words& allowed : {Words{"--allow-folder", file("none/.."), "--allow-folder", file("out")},
                                     Words{"--allow-folder", file("")}, Words{"--allow-any-folder"}}) {
            if (allowed[1] == file("none/..")) fs::create_directories(file("none"));
            const ProcessResult read = candela(Words{"info"} + allowed + Words{file(name)});
            EXPECT_EQ(read.exit_code, 0) << read.err;
        }
    }
    EXPECT_CONTAINS(candela({"info", file("in/image.gltf")}).err,
                    "image.gltf#/images/0/uri: cannot read \"%2e%2e/out/grain.png\": with links followed");
    const ProcessResult wrong = candela({"info", file("in/library.obj"), "--allow-folder", file("nowhere")});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_CONTAINS(wrong.err,
                    "--allow-folder: \"" + file("nowhere") + "\" is not a folder; name one that exists");
}

// A file of the folder may be one that whoever reads the messages must not see.
TEST_F(StrangersFiles, ShowNoValuesOfOtherFiles) {
    const auto expect_hidden = [&](const std::string& opened, const std::string& message) {
        const ProcessResult result = candela({"info", opened});
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_CONTAINS(result.err, message);
        EXPECT_EQ(result.err.find(SECRET), std::string::npos) << result.err;
    };
    const std::string shape = R"("shapes": [{"type": "KIND", "file": "secret.KIND", "emission": 1}])";
    const auto in_scene = [&](const std::string& kind) {
        std::string text = shape;
        for (size_t at = text.find("KIND"); at != std::string::npos; at = text.find("KIND"))
            text.replace(at, 4, kind);
        return scene(text);
    };
    write("in/secret.obj", "v " + SECRET + " 2 3\n");
    expect_hidden(in_scene("obj"), "secret.obj:1: a vertex needs three finite numbers, found (not shown)");
    write("in/secret.obj", TRIANGLE + "f 1 2 " + SECRET + "\n");
    expect_hidden(in_scene("obj"), "secret.obj:4: face 1 has the malformed corner (not shown); write ");
    write("in/secret.ply", "ply\n" + SECRET + "\n");
    expect_hidden(in_scene("ply"), "secret.ply:2: unknown statement (not shown) (known: ");
    write("in/secret.mtl", SECRET + ":x:0\n");
    write("in/m.obj", "mtllib secret.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\n");
    expect_hidden(file("in/m.obj"), "secret.mtl:1: (not shown) stands before the first newmtl");
    write("in/secret.gltf", '"' + SECRET + '"');
    expect_hidden(scene(R"("scene": "secret.gltf")"),
                  "the scene: expected an object { ... }, as every glTF file is, found (not shown)");
    // What the user opens or trusts is shown.
    EXPECT_CONTAINS(candela({"info", file("in/m.obj"), "--allow-any-folder"}).err, SECRET);
    write("in/own.obj", "v " + SECRET + " 2 3\n");
    EXPECT_CONTAINS(candela({"info", file("in/own.obj")}).err, "found \"" + SECRET + "\"");
}

}  // namespace
}  // namespace candela
