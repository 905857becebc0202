// PLY files in their three formats: what is read.
#include <clocale>

#include <gtest/gtest.h>

#include "unit/load/ply/ply_fixture.h"

namespace candela {
namespace {

TEST_F(Ply, ReadsTheThreeFormats) {
    expect_square(load(ascii_square()));
    expect_square(load(ascii_square() + "\n \n"));
    // The shortest row there is, at the end of a file that lacks the end of its last line.
    expect_square(load(header("ascii", VERTEX + FACE + "element last 1\nproperty uchar a\n") + POINTS +
                       "3 0 1 2\n3 0 2 3\n5"));
    expect_square(load(binary_square(false)));
    expect_square(load(binary_square(true)));
}

TEST_F(Ply, LinesEndInAnyWay) {
    for (const std::string end : {"\r\n", "\r"}) {
        std::string ascii;
        for (const char c : ascii_square())
            ascii += c == '\n' ? end : std::string(1, c);
        expect_square(load(ascii));
        // The first byte of the rows may look like the end of a line.
        std::string binary =
            header("binary_little_endian",
                   replaced(VERTEX, "element vertex 4\n", "element vertex 3\nproperty uchar first\n") +
                       replaced(FACE, "2", "1"));
        std::string text;
        for (const char c : binary)
            text += c == '\n' ? end : std::string(1, c);
        for (const vec3 p : {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)})
            text += '\n' + bytes_of(p.x, false) + bytes_of(p.y, false) + bytes_of(p.z, false);
        text += char(3);
        for (const int32_t i : {2, 1, 0})
            text += bytes_of(i, false);
        const TriangleMesh mesh = load(text);
        EXPECT_EQ(mesh.positions, (std::vector<vec3>{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)}));
        EXPECT_EQ(mesh.triangles, std::vector<uvec3>(1, uvec3(2, 1, 0)));
    }
}

// Every type, in both byte orders, in elements and lists that are read and in those that are skipped. The
// values need all bytes of their types.
template <class X, class Y, class Z, class Length, class Index>
std::string file_of_types(const std::array<std::string, 5>& names, bool big_endian, X x, Y y, Z z) {
    const auto put = [&](auto value) { return bytes_of(value, big_endian); };
    std::string text =
        header(big_endian ? "binary_big_endian" : "binary_little_endian",
               "comment a b c\nobj_info d\nelement camera 2\nproperty " + names[0] + " fov\nproperty list " +
                   names[3] + ' ' + names[1] +
                   " lens\nelement nothing 99999999999\nelement face 1\nproperty " + names[2] +
                   " red\nproperty list " + names[3] + ' ' + names[4] + " vertex_index\nproperty list uint " +
                   names[0] + " weights\nelement vertex 3\nproperty " + names[1] + " y\nproperty " +
                   names[0] + " x\nproperty " + names[2] + " z\nproperty list uchar uchar w\n");
    text += put(x) + put(Length(2)) + put(y) + put(y) + put(x) + put(Length(0));
    text +=
        put(z) + put(Length(3)) + put(Index(2)) + put(Index(0)) + put(Index(1)) + put(uint32_t(1)) + put(x);
    for (int i = 0; i < 3; ++i)
        text += put(Y(y + Y(i))) + put(x) + put(z) + char(i) + std::string(size_t(i), 'w');
    return text;
}

TEST_F(Ply, ReadsAllTypes) {
    const auto check = [&](const std::string& text, vec3 first) {
        const TriangleMesh mesh = load(text);
        ASSERT_EQ(mesh.positions.size(), 3u);
        for (size_t i = 0; i < 3; ++i)
            EXPECT_EQ(mesh.positions[i], first + vec3(0, float(i), 0));
        EXPECT_EQ(mesh.triangles, std::vector<uvec3>(1, uvec3(2, 0, 1)));
        for (const std::string& warning : warnings_)  // Steps of floats near 10^9 are coarse.
            EXPECT_NE(warning.find("16 steps of the file's 32-bit coordinates"), std::string::npos);
    };
    for (const bool big : {false, true}) {
        check(file_of_types<int8_t, int16_t, int32_t, uint8_t, uint16_t>(
                  {"char", "short", "int", "uchar", "ushort"}, big, int8_t(-100), int16_t(-30000),
                  int32_t(-0x765432)),
              vec3(-100, -30000, -0x765432));
        check(file_of_types<uint8_t, uint16_t, uint32_t, int8_t, int32_t>(
                  {"uint8", "uint16", "uint32", "int8", "int32"}, big, uint8_t(200), uint16_t(60000),
                  uint32_t(0x98765400)),
              vec3(200, 60000, 0x98765400));
        check(file_of_types<float, double, double, int16_t, uint32_t>(
                  {"float", "double", "float64", "int16", "uint"}, big, -1.25f, 0.5, 1e30),
              vec3(-1.25f, 0.5f, 1e30f));
    }
}

TEST_F(Ply, CutsPolygons) {
    const std::string arrow = "0 0 0\n2 1 0\n4 0 0\n2 2 0\n";  // Concave at the second corner.
    const TriangleMesh mesh =
        load(header("ascii", VERTEX + replaced(FACE, "2", "1")) + arrow + "4 0 1 2 3\n");
    ASSERT_EQ(mesh.triangles.size(), 2u);
    double area = 0.0;
    for (const uvec3 t : mesh.triangles) {
        const vec3 p = mesh.positions[t.x];
        const float twice = cross(mesh.positions[t.y] - p, mesh.positions[t.z] - p).z;
        EXPECT_GT(twice, 0.0f);
        area += 0.5 * double(twice);
    }
    EXPECT_EQ(area, 2.0);  // Exact, for small whole numbers.
}

TEST_F(Ply, KeepsTheOrderOfFacesOfAnySize) {
    const TriangleMesh mesh =
        load(header("ascii", VERTEX + replaced(FACE, "2", "3")) + POINTS + "3 3 1 2\n4 0 1 2 3\n3 2 0 3\n");
    ASSERT_EQ(mesh.triangles.size(), 4u);
    EXPECT_EQ(mesh.triangles.front(), uvec3(3, 1, 2));
    EXPECT_EQ(mesh.triangles.back(), uvec3(2, 0, 3));
}

TEST_F(Ply, TakesNormalsFromTheFileOrNot) {
    const std::string elements =
        VERTEX + "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n" + FACE;
    const std::string text = header("ascii", elements) +
                             "0 0 0 0 0 1 9\n1 0 0 0 1 0 9\n1 1 0 0 0 0 9\n0 1 0 3 0 0 9\n3 0 1 2\n3 0 2 3\n";
    EXPECT_EQ(load(text).normals, (std::vector<vec3>{vec3(0, 0, 1), vec3(0, 1, 0), vec3(0), vec3(1, 0, 0)}));
    EXPECT_TRUE(load(text, MeshNormals::flat).normals.empty());
    EXPECT_EQ(load(text, MeshNormals::smooth).normals, std::vector<vec3>(4, vec3(0, 0, 1)));
    // Two components of three are not a normal.
    EXPECT_TRUE(load(replaced(text, "float nz", "float nw")).normals.empty());
}

TEST_F(Ply, NormalsThatAreNotFiniteAreNone) {
    const std::string elements = VERTEX + "property float nx\nproperty double ny\nproperty float nz\n" + FACE;
    const auto with = [&](const std::string& first, const std::string& second) {
        return load(header("ascii", elements) + "0 0 0 " + first + "\n1 0 0 " + second +
                    "\n1 1 0 0 0 0\n0 1 0 3 0 0\n3 0 1 2\n3 0 2 3\n")
            .normals;
    };
    EXPECT_EQ(with("0 nan 1", "0 1 0"), (std::vector<vec3>{vec3(0), vec3(0, 1, 0), vec3(0), vec3(1, 0, 0)}));
    EXPECT_EQ(warning(), "m.ply: 1 normal is not finite; those of the faces are used there");
    EXPECT_EQ(with("1.#QNAN 0 1", "0 1e300 -inf"),
              (std::vector<vec3>{vec3(0), vec3(0), vec3(0), vec3(1, 0, 0)}));
    EXPECT_EQ(warning(), "m.ply: 2 normals are not finite; those of the faces are used there");
    with("0 0 0", "0 0 0");
    EXPECT_TRUE(warnings_.empty());
}

// They may also be far away: nothing of them is left.
TEST_F(Ply, VerticesThatNoFaceUsesMayBeAnything) {
    const std::string elements = replaced(VERTEX, "4", "6") +
                                 "property float nx\nproperty float ny\nproperty float nz\n"
                                 "property float u\nproperty float v\nproperty float red\n"
                                 "property float green\nproperty float blue\n" +
                                 FACE;
    const std::string used = " 0 0 1 0.5 0.25 1 0 0\n";
    const TriangleMesh mesh =
        load(header("ascii", elements) + "nan 1e39 inf nan nan nan nan nan 7 nan -1\n0 0 0" + used + "1 0 0" +
             used + "1e30 0 0 0 0 0 0 0 0 0 0\n1 1 0" + used + "0 1 0" + used + "3 1 2 4\n3 1 4 5\n");
    EXPECT_EQ(mesh.positions, (std::vector<vec3>{vec3(0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)}));
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{uvec3(0, 1, 2), uvec3(0, 2, 3)}));
    EXPECT_EQ(mesh.normals, std::vector<vec3>(4, vec3(0, 0, 1)));
    EXPECT_EQ(mesh.uv0, std::vector<vec2>(4, vec2(0.5f, 0.25f)));
    EXPECT_EQ(mesh.colors, std::vector<vec4>(4, vec4(1, 0, 0, 1)));
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(Ply, LeavesOutFacesOfFewerThanThreeCorners) {
    const std::string start = header("ascii", VERTEX + replaced(FACE, "2", "5")) + POINTS;
    const std::string small = "2 0 1\n0\n", square = "3 0 1 2\n3 0 2 3\n";
    TriangleMesh mesh = load(start + small + square + "1 3\n");
    EXPECT_EQ(warning(), "m.ply: left out 3 faces of fewer than 3 corners");
    warnings_.clear();
    expect_square(mesh);
    mesh = load(replaced(start, "5", "3") + "2 1 1\n" + square);
    EXPECT_EQ(warning(), "m.ply: left out 1 face of fewer than 3 corners");
    warnings_.clear();
    expect_square(mesh);
    folder_.write("m.ply", replaced(start, "5", "1") + "2 0 1\n");
    EXPECT_EQ(folder_.without_folder(error_of([&] { load_ply_scene(folder_.path() / "m.ply"); })),
              "m.ply: the mesh has no triangle with an area; check its positions");
}

TEST_F(Ply, AcceptsOtherHeaders) {
    const std::string mark = "\xEF\xBB\xBF";
    expect_square(load(mark + ascii_square()));
    expect_square(load(mark + binary_square(true)));
    for (const std::string& good : {ascii_square(), binary_square(false)}) {
        expect_square(load(replaced(good, "ply\n", "ply \t\n\n")));
        expect_square(load(replaced(good, "element face 2", " comment\telement\nelement\tface  2 ")));
        expect_square(load(replaced(good, "end_header", "comment a\r\nobj_info\r\nend_header\r")));
        expect_square(load(replaced(good, "ply\n", "ply\r\n")));
    }
}

// A square as one strip; then with strips that begin anew, and corners that repeat to turn one around.
TEST_F(Ply, ReadsStripsOfTriangles) {
    const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    const auto area = [](const TriangleMesh& mesh, size_t i) {
        const uvec3 t = mesh.triangles[i];
        const vec3 p = mesh.positions[t.x];
        return 0.5f * cross(mesh.positions[t.y] - p, mesh.positions[t.z] - p).z;
    };
    TriangleMesh mesh = load(header("ascii", VERTEX + strips) + POINTS + "4 0 1 3 2\n");
    ASSERT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.triangles[0], uvec3(0, 1, 3));
    EXPECT_EQ(area(mesh, 0), 0.5f);
    EXPECT_EQ(area(mesh, 1), 0.5f);  // Counter-clockwise, too.
    mesh = load(header("ascii", VERTEX + strips) + POINTS + "12 0 1 -1 0 1 2 -1 0 2 2 0 3\n");
    ASSERT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.triangles[0], uvec3(0, 1, 2));
    EXPECT_EQ(mesh.triangles[1], uvec3(2, 0, 3));
    EXPECT_TRUE(warnings_.empty());

    std::string binary = header("binary_big_endian", VERTEX + FACE + strips);
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f})
        binary += bytes_of(x, true);
    binary = replaced(binary, "face 2", "face 1") + char(3);
    for (const int32_t i : {0, 1, 2, 4, -1, 0, 2, 3})
        binary += bytes_of(i, true);
    expect_square(load(binary));
}

TEST_F(Ply, WarnsOfLooksThatAreNotRead) {
    const std::string good = ascii_square();
    load(replaced(good, "ply\n", "ply\ncomment TextureFile wood 1.png\n"));
    EXPECT_EQ(warning(), "m.ply: ignored the texture \"wood 1.png\"; name it in a material of a scene file");
    load(replaced(good, "ply\n", "ply\ncomment TextureFile a\ncomment TextureFile b\ncomment by hand\n"));
    EXPECT_EQ(warning(),
              "m.ply: ignored the texture \"a\" and others; name it in a material of a scene file");
    const auto with_property = [&](const std::string& property, const std::string& first,
                                   const std::string& second) {
        return replaced(replaced(replaced(good, "vertex_indices\n", "vertex_indices\n" + property), "3 0 1 2",
                                 "3 0 1 2 " + first),
                        "3 0 2 3", "3 0 2 3 " + second);
    };
    load(with_property("property uchar red\nproperty uchar green\nproperty uchar blue\n", "1 2 3", "4 5 6"));
    EXPECT_EQ(warning(), "m.ply: ignored the colours of faces; save them as those of vertices");
    load(with_property("property list uchar float texcoord\n", "6 0 0 1 0 1 1", "0"));
    EXPECT_EQ(warning(),
              "m.ply: ignored the texture coordinates of faces (texcoord); save them as those of vertices");
}

TEST_F(Ply, IsAShapeOfAScene) {
    folder_.write("m.ply", ascii_square() + "\n1 2 3\n");
    const Scene scene = folder_.load(scene_of(
        R"({"type": "ply", "file": "m.ply", "material": "white", "emission": 2, "normals": "smooth", "transform": [{"scale": [1, 1, -2]}, {"translate": [0, 0, 3]}]})"));
    const TriangleMesh mesh = world_mesh(scene);
    EXPECT_EQ(mesh.positions[2], vec3(1, 1, 3));
    EXPECT_EQ(mesh.triangles[0], uvec3(0, 2, 1));  // The front stays the front.
    EXPECT_EQ(scene.shapes[0].emission->radiance, vec3(2));
    EXPECT_EQ(scene.materials[scene.shapes[0].material].name, "white");
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(folder_.without_folder(scene.warnings[0]),
              "scene.json:3:36: m.ply: ignored 6 bytes after the last row");
    folder_.expect_error(scene_of(R"(@{"type": "ply", "file": "m.ply"})"),
                         "the shape has neither material nor emission; add one of them");
    folder_.expect_error(scene_of(R"({"type": "ply", "file": @"no.ply", "material": "white"})"),
                         "cannot read \"no.ply\": the file does not exist; check the name");
    folder_.write("m.ply", "v 0 0 0\n");
    folder_.expect_error(scene_of(R"({"type": "ply", "file": @"m.ply", "material": "white"})"),
                         "m.ply: the file does not begin with the line \"ply\"; is it a PLY file?");
}

TEST_F(Ply, WarnsOfTrailingBytes) {
    load(binary_square(true) + '\n');
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_EQ(folder_.without_folder(warnings_[0]), "m.ply: ignored 1 byte after the last row");
    load(ascii_square() + "\n\n 3 0 1 2\n");
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_EQ(folder_.without_folder(warnings_[0]), "m.ply: ignored 9 bytes after the last row");
}

// A square of 1 cm, 10 km away: floats have steps of a millimetre there.
TEST_F(Ply, WarnsOfFloatsThatAreTooCoarse) {
    const std::string rows = "10000 0 0\n10000.01 0 0\n10000.01 0.01 0\n10000 0.01 0\n3 0 1 2\n3 0 2 3\n";
    std::string floats = ascii_square();
    floats = floats.substr(0, floats.find("end_header\n") + 11) + rows;
    load(floats);
    EXPECT_EQ(warnings_.size(), 1u);
    EXPECT_EQ(folder_.without_folder(warnings_.at(0)),
              "m.ply: 2 of 2 triangles are smaller than 16 steps of the file's 32-bit coordinates; write x, "
              "y and z "
              "as doubles, or nearer to 0");
    std::string doubles = floats;
    for (const char* name : {"x", "y", "z"})
        doubles = replaced(doubles, std::string("float ") + name, std::string("double ") + name);
    load(doubles);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(Ply, IgnoresTheLocale) {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    for (const char* name : {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8"}) {
        if (std::setlocale(LC_ALL, name) != nullptr) break;
    }
    const TriangleMesh mesh = load(replaced(ascii_square(), "1 1 0", "1.5 1e-1 +.25"));
    std::setlocale(LC_ALL, before.c_str());
    EXPECT_EQ(mesh.positions[2], vec3(1.5f, 0.1f, 0.25f));
}

}  // namespace
}  // namespace candela
