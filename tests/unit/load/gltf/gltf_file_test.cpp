// glTF files as files: their two containers, their versions, and the buffers that they name.
// Ref: Khronos, "glTF 2.0 Specification", sections 2.8, 3.2, 3.6.1 and 4.4.
#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

using GltfFileTest = Gltf;

void expect_corner(const Scene& scene) {
    ASSERT_EQ(scene.shapes.size(), 1u);
    const TriangleMesh mesh = world_mesh(scene);
    EXPECT_EQ(mesh.positions, (std::vector<vec3>{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)}));
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{uvec3(0, 1, 2)}));
    EXPECT_TRUE(scene.warnings.empty());
}

// The triangle with its bytes where this URI says.
std::string naming(const std::string& uri) {
    return corner_file().document(uri);
}

TEST_F(GltfFileTest, ReadsBuffersInLineBesideAndInBinaryFiles) {
    const GltfFile file = corner_file();
    expect_corner(load_text(file.gltf()));
    folder_.write("b.bin", file.bytes);
    const Scene beside = load_text(file.document("b.bin"));
    expect_corner(beside);
    EXPECT_EQ(beside.files,
              (std::vector<std::filesystem::path>{folder_.path() / "m.gltf", folder_.path() / "b.bin"}));
    expect_corner(load_text(file.glb(), {}, "m.glb"));
    // Told apart by their first bytes.
    expect_corner(load_text(file.glb(), {}, "m.gltf"));
    expect_corner(load_text(glb_of(glb_chunk("JSON", file.document("b.bin"))), {}, "m.glb"));
}

TEST_F(GltfFileTest, ABinaryFileMayHoldFurtherChunksAndZerosAsSpaces) {
    const GltfFile file = corner_file();
    const std::string json = file.document();
    expect_corner(load_text(glb_of(glb_chunk("JSON", json + std::string(3, '\0')) +
                                   glb_chunk("BIN\0", file.bytes + "more") + glb_chunk("XTRA", "anything")),
                            {}, "m.glb"));
    const Scene scene = load_text(file.glb() + "rest", {}, "m.glb");
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(folder_.without_folder(scene.warnings[0]),
              "m.glb: ignored what follows the last chunk, at byte " + std::to_string(file.glb().size()));
    // The buffer after a chunk of another kind.
    expect_corner(load_text(
        glb_of(glb_chunk("JSON", json) + glb_chunk("XTRA", "anything") + glb_chunk("BIN\0", file.bytes)), {},
        "m.glb"));
}

// Programs forget the headers of file and chunks in the length that the header states.
TEST_F(GltfFileTest, ReadsAllChunksIfTheHeaderStatesFewerBytes) {
    const std::string glb = corner_file().glb();
    for (const size_t length : {size_t(0), size_t(40), glb.size() - 12, glb.size() - 20}) {
        std::string text = glb;
        text.replace(8, 4, little_endian(uint32_t(length)));
        const Scene scene = load_text(text, {}, "m.glb");
        EXPECT_EQ(scene.shapes.size(), 1u);
        ASSERT_EQ(scene.warnings.size(), 1u);
        EXPECT_EQ(folder_.without_folder(scene.warnings[0]),
                  concat("m.glb: the header states ", length, " bytes, but the chunks have ", glb.size(),
                         "; all are read"));
    }
    std::string text = glb + "abc";
    text.replace(8, 4, little_endian(uint32_t(text.size())));
    const Scene scene = load_text(text, {}, "m.glb");
    EXPECT_EQ(scene.shapes.size(), 1u);
    EXPECT_EQ(folder_.without_folder(scene.warnings.at(0)),
              concat("m.glb: ignored what follows the last chunk, at byte ", glb.size()));
}

TEST_F(GltfFileTest, RefusesDamagedBinaryFiles) {
    const auto expect = [&](const std::string& text, const std::string& message) {
        expect_text_error(text, "m.glb: " + message, "m.glb");
    };
    const auto cut_off = [](const std::string& what) {
        return "the file is cut off: " + what + "; copy or export it again";
    };
    const std::string glb = corner_file().glb();
    expect("glTF\2", cut_off("its header has 12 bytes"));
    expect(glb.substr(0, 100), cut_off("it is shorter than its header says"));
    expect(glb_of("JSON"), cut_off("a chunk's header has 8 bytes"));
    expect(glb_of(little_endian(9) + "JSON{}"), cut_off("a chunk is shorter than its header says"));
    expect(glb_of(little_endian(UINT32_MAX) + "JSON{}"), cut_off("a chunk is shorter than its header says"));
    expect(glb_of("", 1),
           "the file is binary glTF of version 1; version 2 is read: export the scene as glTF 2.0");
    const std::string no_json = "the first chunk of the file is not its JSON document; export it again";
    expect(glb_of(""), no_json);
    expect(glb_of(glb_chunk("BIN\0", "1234") + glb_chunk("JSON", "{}  ")), no_json);
    expect("glTF" + little_endian(2) + little_endian(5), no_json);
    expect_text_error(glb_of(glb_chunk("JSON", corner_file().document())),
                      "m.glb#/buffers/0: the buffer has neither a uri nor, as the first of a .glb, a binary "
                      "chunk; export the file again",
                      "m.glb");
}

TEST_F(GltfFileTest, ReadsVersionTwoAlone) {
    const auto expect_refused = [&](const Json& asset, const std::string& key, const std::string& version) {
        GltfFile file;
        file.root["asset"] = asset;
        expect_error(file, "#/asset/" + key + ": only glTF 2.0 is read, not \"" + version +
                               "\"; export the scene as glTF 2.0");
    };
    expect_refused({{"version", "1.0"}}, "version", "1.0");
    expect_refused({{"version", "20"}}, "version", "20");
    expect_refused({{"version", "2.1"}, {"minVersion", "2.1"}}, "minVersion", "2.1");
    for (const Json& asset : {Json{{"version", "2.1"}}, Json{{"version", "3.0"}, {"minVersion", "2.0"}}}) {
        GltfFile file = corner_file();
        file.root["asset"] = asset;
        expect_corner(load(file));
    }
    expect_text_error("{}", "m.gltf#: the key \"asset\" is missing here; add it");
    expect_text_error(R"({"asset": {}})", "m.gltf#/asset: the key \"version\" is missing here; add it");
    expect_text_error("[]",
                      "m.gltf#: the scene: expected an object { ... }, as every glTF file is, found []");
    expect_text_error("{\n  \"asset\" 1}",
                      "m.gltf:2:11: syntax error while parsing object separator - unexpected "
                      "number literal; expected ':'");
}

TEST_F(GltfFileTest, MayBeginWithAByteOrderMark) {
    expect_corner(load_text("\xEF\xBB\xBF" + corner_file().gltf()));
}

// As programs on Windows write names.
TEST_F(GltfFileTest, BytesThatAreNotUtf8AreLatin1) {
    folder_.write("größe €.bin", corner_file().bytes);
    std::string text = naming("NAME €.bin");
    const Scene scene = load_text(text.replace(text.find("NAME"), 4, "gr\xF6\xDF\x65"));
    EXPECT_EQ(scene.shapes.size(), 1u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(folder_.without_folder(scene.warnings[0]),
              "m.gltf: the text is not UTF-8; other bytes are read as Latin-1");
}

TEST_F(GltfFileTest, DecodesTheNamesOfFiles) {
    std::filesystem::create_directory(folder_.path() / "sub");
    for (const char* name :
         {"two words.bin", "größe.bin", "50%.bin", "as%20is.bin", "sub/b.bin", "sub/5% b.bin"})
        folder_.write(name, corner_file().bytes);
    for (const char* uri :
         {"two%20words.bin", "two words.bin", "gr%C3%B6%c3%9fe.bin", "größe.bin", "50%25.bin", "as%20is.bin",
          "as%2520is.bin", "sub/b.bin", "sub%2fb.bin", "./sub/../two%20words.bin",
          // As they should not be, and as Windows has them.
          "50%.bin", R"(sub\b.bin)", "sub%5Cb.bin", R"(.\sub\5% b.bin)"}) {
        SCOPED_TRACE(uri);
        expect_corner(load_text(naming(uri)));
    }
    // In the folder above, too, as RFC 3986 has it, if that is allowed.
    folder_.write("sub/m.gltf", naming("../two%20words.bin"));
    Scene scene;
    scene.reach = FileReach(folder_.path() / "sub/m.gltf", {.folders = {folder_.path()}});
    GltfFiles files;
    add_gltf_scene(folder_.path() / "sub/m.gltf", {}, scene, no_progress, files);
    expect_corner(scene);
}

TEST_F(GltfFileTest, NamesNoFileOutsideOfItsFolder) {
    std::filesystem::create_directory(folder_.path() / "sub");
    folder_.write("secret.bin", corner_file().bytes);
    std::filesystem::create_symlink(folder_.path() / "secret.bin", folder_.path() / "sub/link.bin");
    for (const std::string uri : {"../secret.bin", "%2e%2e/secret.bin", R"(..\secret.bin)", "..%5csecret.bin",
                                  "x/../../secret.bin", "link.bin", "../none.bin"}) {
        expect_text_error(
            naming(uri),
            "sub/m.gltf#/buffers/0/uri: cannot read \"" + uri +
                "\": with links followed, it is not in the folder of the file that is opened, "
                "\"sub\"; if you trust that file, allow the folder of this one (--allow-folder DIR), "
                "or all (--allow-any-folder)",
            "sub/m.gltf");
    }
}

TEST_F(GltfFileTest, ReadsOnlyFilesThatAreNamedRelativeToIt) {
    for (const std::string uri : {"https://example.org/b.bin", "file:///b.bin", "C:\\b.bin", "/tmp/b.bin",
                                  "\\\\host\\b.bin", "%2Ftmp%2Fb.bin", "%5Cb.bin"}) {
        expect_text_error(
            naming(uri),
            "m.gltf#/buffers/0/uri: only files that are named relative to this one are read, not " +
                Json(uri).dump() + "; put the file beside this one");
    }
    const auto expect = [&](const std::string& uri, const std::string& message) {
        expect_text_error(naming(uri), "m.gltf#/buffers/0/uri: " + message);
    };
    expect("", "the URI is empty; name a file");
    for (const char* uri : {"a%2", "a%", "a%2x.bin", "%x2.bin"})
        expect(uri, "a % in a URI is followed by two hexadecimal digits; write % itself as %25");
    expect("a%00b", "a file name cannot hold the character U+0000; remove it");
    expect(std::string("a\0b", 3), "a file name cannot hold the character U+0000; remove it");
    expect("none.bin", "cannot read \"none.bin\": the file does not exist; check the name");
}

TEST_F(GltfFileTest, RefusesDataThatAreNoBase64) {
    const auto expect = [&](const std::string& uri, const std::string& message) {
        expect_text_error(naming(uri), "m.gltf#/buffers/0/uri: " + message);
    };
    const std::string not_base64 = "the data of the URI is not base64; is the file cut off?";
    expect("data:;base64,AAAA*", not_base64);
    expect("data:;base64,AAAAA", not_base64);
    expect("data:;base64,AA=A", not_base64);
    expect("data:;base64,AAA===", not_base64);
    expect("data:;base64,AAA%3", not_base64);
    const std::string kind = "data in a URI must be base64, data:TYPE;base64,DATA; encode it so";
    expect("data:text/plain,hello", kind);
    expect("data:;base64", kind);
    // Without the padding, and of any type.
    GltfFile file = corner_file();
    file.bytes += "abcd";
    std::string text = base64(file.bytes);
    ASSERT_TRUE(text.ends_with("=="));
    text.resize(text.size() - 2);
    expect_corner(load_text(file.document("data:application/gltf-buffer;base64," + text)));
    // In lines, as mail has them; percent-encoded, as of any URI; a scheme in capitals.
    expect_corner(load_text(file.document("data:;base64," + text.insert(20, "\r\n ") + "%3D%3D")));
    expect_corner(load_text(file.document("DATA:application/octet-stream;charset=utf-8;base64," + text)));
}

TEST_F(GltfFileTest, RefusesBuffersAndViewsThatAreTooShort) {
    GltfFile file = corner_file();
    const auto expect = [&](const std::string& message) { expect_error(file, message); };
    file.root["buffers"] = {{{"byteLength", 37}, {"uri", "data:;base64," + base64(file.bytes)}}};
    // What is missing is not needed.
    EXPECT_EQ(
        expect_warning(file,
                       "#/buffers/0: the buffer has 36 bytes, not the 37 that its byteLength states; is "
                       "a file cut off?")
            .shapes.size(),
        1u);
    file.root["bufferViews"][0]["byteLength"] = 37;
    expect("#/bufferViews/0: the view ends at byte 37 of its buffer, which has 36; is a file cut off?");
    file.root["bufferViews"][0]["byteLength"] = 36;
    file.root["buffers"][0]["byteLength"] = 35;
    expect("#/bufferViews/0: the view ends at byte 36 of its buffer, which has 35; is a file cut off?");
    file.root["buffers"][0]["byteLength"] = 0;
    expect("#/buffers/0/byteLength: \"byteLength\": expected a whole number from 1 to 4294967295, found 0");
    file.root["buffers"][0]["byteLength"] = 36;
    Json& view = file.root["bufferViews"][0];
    view["byteOffset"] = 4294967295;
    expect(
        "#/bufferViews/0: the view ends at byte 4294967331 of its buffer, which has 36; is a file cut off?");
    view["byteOffset"] = -4;
    expect(
        "#/bufferViews/0/byteOffset: \"byteOffset\": expected a whole number from 0 to 4294967295, found -4");
    view["byteOffset"] = 0;
    view["byteLength"] = 37;
    expect("#/bufferViews/0: the view ends at byte 37 of its buffer, which has 36; is a file cut off?");
    view["byteLength"] = 36;
    view["buffer"] = 1;
    expect(
        "#/bufferViews/0/buffer: \"buffers\" has no element 1, only 0 to 0; name one that the file "
        "has");
    file.root.erase("buffers");
    file.bytes.clear();
    expect(
        "#/bufferViews/0/buffer: \"buffers\" has no element 1: it is empty or missing; name one that the "
        "file has");
}

TEST_F(GltfFileTest, MembersThatAreNullAreAbsent) {
    GltfFile file = corner_file();
    file.root["animations"] = file.root["extensionsRequired"] = file.root["scene"] = nullptr;
    file.root["nodes"][0].update({{"name", nullptr}, {"translation", nullptr}, {"children", nullptr}});
    file.root["meshes"][0]["primitives"][0]["material"] = nullptr;
    file.root["bufferViews"][0]["byteOffset"] = nullptr;
    expect_corner(load(file));
    file.root["bufferViews"][0]["byteLength"] = nullptr;
    expect_error(file, "#/bufferViews/0: the key \"byteLength\" is missing here; add it");
}

}  // namespace
}  // namespace candela
