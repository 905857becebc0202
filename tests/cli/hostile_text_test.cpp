// What files hold never reaches a terminal as it is, however it is named, and messages about it stay short.
#include <algorithm>
#include <string_view>

#include "cli/cli_fixture.h"

namespace candela {
namespace {

using Json = nlohmann::json;

// Colours, the title of a window, a line that looks like one of ours, a C1 control, DEL, an override of
// direction, a separator of lines, a tag.
const std::string HARM = "\x1B[31m\x1B]0;title\a\nfake line\u009B2J\x7F\u202E\u2028\U000E0041";
constexpr int MANY = 3000;

bool is_control(std::string_view text, size_t i) {
    const auto byte = uint8_t(text[i]);
    const std::string_view rest = text.substr(i);
    return (byte < 0x20 && byte != '\n') || byte == 0x7F || (byte == 0xC2 && uint8_t(rest[1]) < 0xA0) ||
           rest.starts_with("\u202E") || rest.starts_with("\u2028") || rest.starts_with("\U000E0041");
}

void expect_harmless(const std::string& text) {
    size_t controls = 0;
    for (size_t i = 0; i < text.size(); ++i)
        controls += is_control(text, i) ? 1 : 0;
    EXPECT_EQ(controls, 0u);
    EXPECT_EQ(text.find("\nfake line"), std::string::npos);
    EXPECT_NO_THROW(Json(text).dump());  // It is UTF-8.
}

class HostileText : public CliTest {
  protected:
    // What docs/files.md promises for the messages of a run.
    static constexpr size_t MAX_BYTES = 128 << 10;

    ProcessResult expect_harmless_run(const Words& arguments, int exit_code, const std::string& part) const {
        SCOPED_TRACE(arguments[0] + ' ' + arguments[1].substr(0, 100));
        const ProcessResult result = candela(arguments, NO_DRIVER);
        EXPECT_EQ(result.exit_code, exit_code) << result.err.substr(0, 1000);
        expect_harmless(result.err);
        expect_harmless(result.out);
        EXPECT_LE(result.err.size(), MAX_BYTES);
        EXPECT_NE((result.err + result.out).find(part), std::string::npos) << result.err.substr(0, 1000);
        return result;
    }
    void expect_harmless_error(const Words& arguments, const std::string& part, int exit_code = 1) const {
        expect_harmless_run(arguments, exit_code, part);
    }

    std::string gltf() const {
        const Json camera = {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}};
        Json root = {{"asset", {{"version", "2.0"}, {"generator", HARM}, {"copyright", HARM + large_}}},
                     {"cameras", Json::array({camera})},
                     {"meshes", {{{"primitives", Json::array()}}}},
                     {"nodes", {{{"mesh", 0}}}},
                     {"scenes", {{{"nodes", Json::array()}}}},
                     {"extensionsUsed", Json::array()}};
        for (int i = 0; i < 16; ++i)
            root["meshes"][0]["primitives"].push_back({{"mode", 0}, {"attributes", Json::object()}});
        for (int i = 0; i < MANY; ++i) {
            root["extensionsUsed"].push_back(HARM + std::to_string(i));
            root["nodes"].push_back({{"camera", 0}, {"name", HARM + std::to_string(i)}});
        }
        for (size_t i = 0; i < root["nodes"].size(); ++i)
            root["scenes"][0]["nodes"].push_back(i);
        return write("a.gltf", root.dump());
    }

    // A scene in which `change` differs from a sound one.
    std::string scene(const Json& change) const {
        Json root = {
            {"cameras", {{"m", {{"position", {0, 0, 3}}, {"look_at", {0, 0, 0}}, {"vertical_fov", 40}}}}},
            {"materials", {{"d", {{"type", "diffuse"}, {"reflectance", 0.5}}}}},
            {"shapes", {{{"type", "sphere"}, {"radius", 1}, {"material", "d"}}}}};
        root.merge_patch(change);
        return write("a.json", root.dump());
    }

    // An image with what `merge` looks for.
    std::string part(const std::string& name, const std::string& samples, const std::string& text,
                     const std::string& attribute = "candela.device", int channels = 0) const {
        Image image{.full = {2, 2}, .data = {0, 0, 2, 2}, .channels = {}, .attributes = {}};
        for (const char* channel : {"R", "G", "B", "A"})
            image.add(channel, 1.0f);
        for (int i = 0; i < channels; ++i)
            image.add(HARM + std::to_string(i), 1.0f);
        image.attributes["candela.identity"] = "1";
        for (const char* key : {"seed", "sampler", "estimator", "lightSampler", "terminator", "maxDepth",
                                "rrDepth", "camera", "frame", "device", "driver", "version"})
            image.attributes[std::string("candela.") + key] = "x";
        image.attributes["candela.samples"] = samples;
        image.attributes["samplesPerPixel"] = 1.0f;
        image.attributes[attribute] = text;
        write_exr(file(name), image);
        return file(name);
    }

    const std::string large_ = std::string(1 << 20, 'x');
};

TEST_F(HostileText, OfGltfFilesIsEscapedAndCounted) {
    const std::string path = gltf();
    const ProcessResult info = expect_harmless_run({"info", path}, 0, "and 2980 more");
    EXPECT_LE(info.out.size(), 16u << 10);
    EXPECT_CONTAINS(info.err, "left out points or lines, which have no surface (16 times)\n");
    EXPECT_CONTAINS(info.err, "2997 more like the last");
    EXPECT_CONTAINS(info.out, "\\u001b[31m");
    const ProcessResult json = expect_harmless_run({"info", path, "--json"}, 0, "\\u009b2J");
    const Json read = Json::parse(json.out);
    EXPECT_EQ(read["cameras"][0], HARM + "0");  // Programs get the text as it is.
    EXPECT_EQ(read["attributes"]["gltf.copyright"], HARM + large_);
    expect_harmless_error({"render", path, "-o", file("a.png"), "--camera", "?"}, "and 2980 more)", 2);
    expect_harmless_error({"info", path, "--scene", HARM}, "has nothing called", 2);
    expect_harmless_error({"info", write("b.gltf", Json({{"asset", {{"version", HARM + large_}}}}).dump())},
                          "only glTF 2.0 is read");
    const Json beside = {
        {"asset", {{"version", "2.0"}}},
        {"buffers", {{{"byteLength", 9}, {"uri", HARM + large_}}}},
        {"bufferViews", {{{"buffer", 0}, {"byteLength", 9}}}},
        {"accessors", {{{"bufferView", 0}, {"componentType", 5121}, {"count", 3}, {"type", "VEC3"}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
        {"nodes", {{{"mesh", 0}}}}};
    expect_harmless_error({"info", write("c.gltf", beside.dump())}, "c.gltf#/buffers/0/uri: cannot read");
}

TEST_F(HostileText, OfSceneFilesIsEscapedAndCut) {
    Json materials;
    for (int i = 0; i < MANY; ++i)
        materials[HARM + std::to_string(i)] = {{"type", "diffuse"}, {"reflectance", 0.5}};
    const Json shapes = {{{"type", "sphere"}, {"radius", 1}, {"material", "?" + HARM}}};
    expect_harmless_error({"info", scene({{"materials", materials}, {"shapes", shapes}})}, "and 2981 more)");
    expect_harmless_error({"info", scene({{HARM + large_, 1}})}, "unknown key");
    expect_harmless_error({"info", scene({{"cameras", {{HARM + large_, 1}}}})}, "expected an object");
    expect_harmless_error({"info", scene({{"film", HARM + large_}})}, "expected an object { ... }, found \"");
    expect_harmless_error({"info", scene({{"environment", {{"file", HARM + large_}}}})},
                          "it is not in the folder of the file that is opened");
    expect_harmless_error({"info", write("b.json", "{\"" + large_ + "\": 1, \"" + large_ + "\": 2}")},
                          "duplicate key");
    expect_harmless_error({"info", file(HARM + ".json")}, "the file does not exist");
}

TEST_F(HostileText, OfMeshFilesIsEscapedAndCounted) {
    std::string mtl, obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < MANY; ++i) {
        const std::string name = "m\x1B[31m\u009B" + std::to_string(i);
        mtl += "newmtl " + name + "\nKd 2 2 2\n";
        obj += "usemtl " + name + "\nf 1 2 3\n";
    }
    write("a.mtl", mtl);
    const ProcessResult info = expect_harmless_run({"info", write("a.obj", obj)}, 0, "a.mtl");
    EXPECT_CONTAINS(info.err, "(3000 times)");
    expect_harmless_error({"info", write("b.obj", "v 0 0 \x1B[31m\x9B" + large_)}, "needs three numbers");
    expect_harmless_error({"info", write("a.ply", "ply\nformat \x1B[31m\u009B" + large_ + "\n")},
                          "unknown format");
    expect_harmless_error({"info", write("b.ply", "ply\n\x1B[31m\u202E" + large_ + "\n")},
                          "unknown statement");
}

TEST_F(HostileText, OfImagesIsEscapedAndCut) {
    expect_harmless_error({"compare", part("a.exr", "0..1", HARM), file(HARM + ".exr")},
                          "the file does not exist");
    const std::string sound = part("b.exr", "1..2", "y");
    expect_harmless_error(
        {"merge", sound, part("c.exr", "2..3", HARM + large_, "candela.camera"), "-o", file("o.exr")},
        "its camera is");
    expect_harmless_error(
        {"merge", part("d.exr", "2..3", HARM + large_, "candela.identity"), "-o", file("o.exr")},
        "the attribute candela.identity is");
    expect_harmless_error({"merge", part("e.exr", HARM + large_, HARM), "-o", file("o.exr")},
                          "the attribute candela.samples is");
    const ProcessResult merged = expect_harmless_run(
        {"merge", sound, part("f.exr", "2..3", HARM, "candela.device", 300), "-o", file("o.exr")}, 0,
        "samples 1..3");
    EXPECT_CONTAINS(merged.err, "297 more like the last");
    Image image{.full = {2, 1}, .data = {0, 0, 2, 1}, .channels = {}, .attributes = {}};
    for (int i = 0; i < MANY; ++i)
        image.add(HARM + std::to_string(i), 1.0f);
    write_exr(file("sky.exr"), image);
    expect_harmless_error({"info", scene({{"environment", {{"file", "sky.exr"}}}})}, "and 2980 more");
}

TEST_F(HostileText, OfReportsIsEscapedInMessagesAndDrawings) {
    expect_harmless_error({"plot", write(HARM + ".json", "{}"), "-o", file("a.svg")}, "it has no errors");
    const Json report = {{"reference", HARM}, {"convergence", {{{"seconds", 1}, {"relmse", 0.5}}}}};
    const std::string path = write(HARM + "<\xFF>.json", report.dump());
    expect_harmless_run({"plot", path, "-o", file("a.svg")}, 0, "");
    const std::string svg = read_file(file("a.svg"));
    expect_harmless(svg);
    EXPECT_CONTAINS(svg, "\\u001b[31m");
    EXPECT_CONTAINS(svg, "&lt;\\xff&gt;");
}

}  // namespace
}  // namespace candela
