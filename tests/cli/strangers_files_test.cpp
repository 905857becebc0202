// Scene files of strangers: which files they may name, what messages tell of them, and what they may cost.
#include <filesystem>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

const std::string CAMERA =
    R"({"cameras": {"main": {"position": [0, 0, 3], "look_at": [0, 0, 0], "vertical_fov": 40}}, )";
const std::string TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
// The buffer of a triangle, in base64.
const std::string POSITIONS = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
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

// Whatever the format and the kind of file: refused, or left out if a picture can do without it, and read if
// that is allowed.
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
        "buffers": [{"uri": "data:;base64,)" +
                               POSITIONS + R"(", "byteLength": 36}],
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
        const bool can_do_without = name.ends_with(".obj");
        const ProcessResult refused = candela({"info", file(name)});
        EXPECT_EQ(refused.exit_code, can_do_without ? 0 : 1);
        EXPECT_CONTAINS(refused.err, "../out/" + outside +
                                         "\": with links followed, it is not in the folder of "
                                         "the file that is opened, \"" +
                                         file("in") + "\"");
        for (const Words& allowed : {Words{"--allow-folder", file("none/.."), "--allow-folder", file("out")},
                                     Words{"--allow-folder", file("")}, Words{"--allow-any-folder"}}) {
            if (allowed.back() == file("out")) fs::create_directories(file("none"));
            const ProcessResult read = candela(Words{"info"} + allowed + Words{file(name)});
            EXPECT_EQ(read.exit_code, 0) << read.err;
            EXPECT_EQ(read.err.find("links followed"), std::string::npos) << read.err;
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
    expect_hidden(in_scene("obj"), "secret.obj:1: a vertex needs three numbers, found (not shown)");
    write("in/secret.obj", TRIANGLE + "f 1 2 " + SECRET + "\n");
    expect_hidden(in_scene("obj"), "secret.obj:4: face 1 has the malformed corner (not shown); write ");
    write("in/secret.ply", "ply\n" + SECRET + "\n");
    expect_hidden(in_scene("ply"), "secret.ply:2: unknown statement (not shown) (known: ");
    write("in/secret.mtl", SECRET + ":x:0\n");
    write("in/m.obj", "mtllib secret.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\n");
    expect_hidden(file("in/m.obj"), "secret.mtl:1: (not shown) comes before the first newmtl");
    write("in/secret.gltf", '"' + SECRET + '"');
    expect_hidden(scene(R"("scene": "secret.gltf")"),
                  "the scene: expected an object { ... }, as every glTF file is, found (not shown)");
    // What the user opens or trusts is shown.
    EXPECT_CONTAINS(candela({"info", file("in/m.obj"), "--allow-any-folder"}).err, SECRET);
    write("in/own.obj", "v " + SECRET + " 2 3\n");
    EXPECT_CONTAINS(candela({"info", file("in/own.obj")}).err, "found \"" + SECRET + "\"");
}

// A WebP file of that many black pixels across and down: of each Huffman code it says that there is one
// symbol, 0, and so the pixels take no bits.
std::string black_webp(uint32_t size) {
    const uint32_t header = (size - 1) | (size - 1) << 14;
    const std::string pixels{
        '\x2f', char(header), char(header >> 8), char(header >> 16), char(header >> 24), '\x88',
        '\x88', '\x08'};
    return std::string("RIFF\x14\0\0\0WEBPVP8L\x08\0\0\0", 20) + pixels;
}

// `count` copies of a text, with commas between them.
std::string repeated(const std::string& text, size_t count) {
    std::string list;
    for (size_t i = 0; i < count; ++i)
        list += (i == 0 ? "" : ",") + text;
    return list;
}

class CostOfFiles : public StrangersFiles {
  protected:
    // A glTF file with these members, of at most 64 KB, and what candela says of it with a limit of 100 MB.
    ProcessResult info_of(const std::string& members) const {
        const std::string text = R"({"asset": {"version": "2.0"}, )" + members + "}";
        EXPECT_LE(text.size(), 65536u);
        return candela({"info", write("in/m.gltf", text), "--memory-limit", "100M"});
    }
    void expect_refused(const std::string& members, const std::string& place, const std::string& what) const {
        const ProcessResult result = info_of(members);
        EXPECT_EQ(result.exit_code, 5) << result.err;
        EXPECT_CONTAINS(result.err, place);
        EXPECT_CONTAINS(result.err, "there is not enough memory for " + what + ", which needs at least ");
        EXPECT_CONTAINS(result.err, " are in use and --memory-limit allows 95.4 MiB");
    }
};

// 8192x8192 texels take 192 MiB; the faces, as numbers, would take 4.5 GiB.
TEST_F(CostOfFiles, OfImagesIsTheirPixels) {
    write("in/a.webp", black_webp(8192));
    expect_refused(R"("images": [{"uri": "a.webp"}], "scenes": [{"extensions": {"EXT_lights_image_based":
        {"light": 0}}}], "extensions": {"EXT_lights_image_based": {"lights": [{"specularImages":
        [[0, 0, 0, 0, 0, 0]]}]}})",
                   "m.gltf#/extensions/EXT_lights_image_based/lights/0/specularImages/0/0\": ", "its pixels");
}

// 3 MB each, of which there are 300.
TEST_F(CostOfFiles, OfOneImageUnderManyIndicesIsThatOfOne) {
    write("in/a.webp", black_webp(1024));
    std::string materials, textures;
    for (int i = 0; i < 300; ++i) {
        const std::string comma = i == 0 ? "" : ",", number = std::to_string(i);
        textures += comma + R"({"source": )" + number + "}";
        materials += comma + R"({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": )" + number + "}}";
    }
    std::string primitives;
    for (int i = 0; i < 300; ++i)
        primitives += (i == 0 ? "" : ",") + std::string(R"({"attributes": {"POSITION": 0}, "material": )") +
                      std::to_string(i) + "}";
    const ProcessResult result =
        info_of(R"("images": [)" + repeated(R"({"bufferView": 1})", 300) + R"(], "textures": [)" + textures +
                R"(], "materials": [)" + materials + R"(], "buffers": [{"uri": "data:;base64,)" + POSITIONS +
                R"(", "byteLength": 36}, {"uri": "a.webp", "byteLength": 28}], "bufferViews": [{"buffer": 0,
        "byteLength": 36}, {"buffer": 1, "byteLength": 28}], "accessors": [{"bufferView": 0,
        "componentType": 5126, "count": 3, "type": "VEC3"}], "meshes": [{"primitives": [)" +
                primitives + R"(]}], "nodes": [{"mesh": 0}])");
    EXPECT_EQ(result.exit_code, 0) << result.err;
}

// 600 nodes show 20 000 instances each.
TEST_F(CostOfFiles, OfInstancesIsTheirProductWithTheNodes) {
    write("in/zeros.bin", std::string(240'000, '\0'));
    expect_refused(
        R"("buffers": [{"uri": "zeros.bin", "byteLength": 240000}, {"uri": "data:;base64,)" + POSITIONS +
            R"(", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 240000}, {"buffer": 1,
            "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 20000,
            "type": "VEC3"}, {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 1}}]}], "nodes": [)" +
            repeated(R"({"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing":
            {"attributes": {"TRANSLATION": 0}}}})",
                     600) +
            "]",
        "m.gltf#/nodes/", "what the node shows");
}

// 1000 primitives of 30 000 vertices each, which are the same.
TEST_F(CostOfFiles, OfPrimitivesIsThatOfTheirVertices) {
    std::string bytes;
    for (int i = 0; i < 30'000; ++i) {
        const float p[3] = {float(i % 3 == 1), float(i % 3 == 2), float(i)};
        bytes.append(reinterpret_cast<const char*>(p), sizeof p);
    }
    write("in/mesh.bin", bytes);
    expect_refused(R"("buffers": [{"uri": "mesh.bin", "byteLength": 360000}], "bufferViews": [{"buffer": 0,
        "byteLength": 360000}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 30000,
        "type": "VEC3"}], "meshes": [{"primitives": [)" +
                       repeated(R"({"attributes": {"POSITION": 0}})", 1000) +
                       R"(]}], "nodes": [{"mesh": 0}])",
                   "m.gltf#/nodes/0: ", "what the node shows");
}

// Memory of the device, too, if that is the computer itself.
TEST_F(CostOfFiles, OfAPictureIsItsPixels) {
    const std::string file = scene(R"("film": {"size": [4096, 4096]}, "shapes": [])");
    const ProcessResult result =
        candela({"render", file, "--spp", "1", "-o", this->file("a.png"), "--memory-limit", "100M"});
    EXPECT_EQ(result.exit_code, 5) << result.err;
    EXPECT_CONTAINS(result.err, "rendering a picture of 4096x4096 needs ");
    EXPECT_CONTAINS(result.err, " GiB are in use and --memory-limit allows 0.09 GiB; use a smaller picture");
}

// What a picture of 4096x4096 with these arguments is said to need [GiB].
class CostOfPictures : public StrangersFiles {
  protected:
    double gibibytes(const Words& arguments) {
        const std::string scene_file = scene(R"("film": {"size": [4096, 4096]}, "shapes": [])");
        const ProcessResult result =
            candela(Words{"render", scene_file, "--spp", "1", "-o", file("a.exr"), "--memory-limit", "100M"} +
                    arguments);
        EXPECT_EQ(result.exit_code, 5) << result.err;
        const std::string needs = " needs ";
        const size_t number = result.err.find(needs);
        return number == std::string::npos ? 0.0 : std::stod(result.err.substr(number + needs.size()));
    }
    static constexpr double GIBIBYTES_OF_FOUR_BYTES_A_PIXEL = 4 * 4096.0 * 4096.0 / (1 << 30);
};

// Of ids and motion, the channels of a file, 4 bytes each, and less than as much again for how they are made.
TEST_F(CostOfPictures, AreAlsoThoseOfIds) {
    const double none = gibibytes({"--aov", "none"});
    for (const auto& [layers, channels] : {std::pair("ids", 3), std::pair("cryptomatte", 24)}) {
        const double least = channels * GIBIBYTES_OF_FOUR_BYTES_A_PIXEL;
        const double more = gibibytes({"--aov", layers}) - none;
        EXPECT_GT(more, least) << layers;
        EXPECT_LT(more, least + 1.0) << layers;
    }
}

// What a denoiser needs is counted before it is needed: its guides, and 256 MiB for itself.
TEST_F(CostOfPictures, AreAlsoThoseOfADenoiser) {
    const Words guided = {"--aov", "albedo,n,variance,samples,denoising"};
    const double without = gibibytes(guided), with = gibibytes(guided + Words{"--denoise", "variance"});
    const double denoised = 3 * GIBIBYTES_OF_FOUR_BYTES_A_PIXEL;
    EXPECT_GT(with - without, 0.24 + denoised);
    EXPECT_LT(with - without, 0.26 + 3 * denoised);
}

TEST_F(CostOfFiles, HasALimitThatIsASize) {
    const ProcessResult result = candela({"info", CORNELL_BOX, "--memory-limit", "much"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_CONTAINS(result.err, "a size such as 500M, 1.5GB or 4GiB");
}

}  // namespace
}  // namespace candela
