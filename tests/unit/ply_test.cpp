// PLY files in their three formats: what is read, and what is refused, with which message.
#include "load/ply/ply.h"

#include <algorithm>
#include <bit>
#include <clocale>
#include <cmath>

#include <gtest/gtest.h>

#include "scene_fixture.h"

namespace candela {
namespace {

// The bytes of a number, in the order of the file.
template <class T>
std::string bytes_of(T value, bool big_endian) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
    return {raw.begin(), raw.end()};
}

const std::string VERTEX = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string FACE = "element face 2\nproperty list uchar int vertex_indices\n";
const std::string POINTS = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string header(const std::string& format, const std::string& elements) {
    return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

// A square of two triangles; its last line has no end.
std::string ascii_square() {
    return header("ascii", VERTEX + FACE) + POINTS + "3 0 1 2\n3 0 2 3";
}

std::string binary_square(bool big_endian) {
    std::string text = header(big_endian ? "binary_big_endian" : "binary_little_endian", VERTEX + FACE);
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f})
        text += bytes_of(x, big_endian);
    for (const auto& triangle : {uvec3(0, 1, 2), uvec3(0, 2, 3)}) {
        text += char(3);
        for (glm::length_t i = 0; i < 3; ++i)
            text += bytes_of(int32_t(triangle[i]), big_endian);
    }
    return text;
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
    const size_t at = text.find(old);
    if (at == std::string::npos) throw std::logic_error("no " + old);
    return text.replace(at, old.size(), by);
}

class Ply : public testing::Test {
  protected:
    TriangleMesh load(const std::string& text, MeshNormals normals = MeshNormals::file) {
        folder_.write("m.ply", text);
        warnings_.clear();
        return placed(load_ply(folder_.path() / "m.ply", normals, warnings_), Transform());
    }

    void expect_error(const std::string& text, const std::string& message) {
        SCOPED_TRACE(text);
        EXPECT_EQ(folder_.without_folder(error_of([&] { load(text); })), message);
    }

    void expect_square(const TriangleMesh& mesh) {
        EXPECT_EQ(mesh.positions, (std::vector<vec3>{vec3(0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)}));
        EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{uvec3(0, 1, 2), uvec3(0, 2, 3)}));
        EXPECT_TRUE(mesh.normals.empty());
        EXPECT_TRUE(warnings_.empty());
    }

    SceneFolder folder_;
    std::vector<std::string> warnings_;
};

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
                   names[0] + " texcoord\nelement vertex 3\nproperty " + names[1] + " y\nproperty " +
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
    EXPECT_EQ(area, 2.0);  // Of small whole numbers: exact.
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
    // Two components of three are no normal.
    EXPECT_TRUE(load(replaced(text, "float nz", "float nw")).normals.empty());
    // What is not used may be anything.
    const std::string nan = replaced(text, "0 0 1 9", "0 nan 1 9");
    expect_error(nan, "m.ply:14: vertex 0 needs a finite ny, found nan");
    EXPECT_NO_THROW(load(nan, MeshNormals::flat));
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

TEST_F(Ply, RefusesBadHeaders) {
    const std::string good = ascii_square();
    const auto bad = [&](const std::string& old, const std::string& by, const std::string& message) {
        expect_error(replaced(good, old, by), message);
    };
    bad("ply", "", "m.ply: the file does not begin with the line \"ply\"; is it a PLY file?");
    bad("ply", "plx", "m.ply: the file does not begin with the line \"ply\"; is it a PLY file?");
    bad("end_header", "end_heade",
        "m.ply:9: unknown statement \"end_heade\" (known: format, comment, obj_info, element, property, "
        "end_header)");
    bad("end_header\n" + POINTS + "3 0 1 2\n3 0 2 3", "",
        "m.ply: the header has no line \"end_header\"; is the file cut off?");
    bad("format ascii 1.0\n", "",
        "m.ply:8: the header does not state its format; write \"format ascii 1.0\"");
    const std::string formats = " (known: ascii, binary_little_endian, binary_big_endian; each 1.0)";
    bad("ascii 1.0", "ascii 2.0", "m.ply:2: unknown format \"ascii 2.0\"" + formats);
    bad("ascii 1.0", "binary", "m.ply:2: unknown format \"binary\"" + formats);
    const std::string element = "an element needs a name and a number of rows, as \"element vertex 8\"";
    bad("vertex 4", "vertex", "m.ply:3: " + element);
    bad("vertex 4", "vertex -4", "m.ply:3: " + element);
    bad("vertex 4", "vertex 4.5", "m.ply:3: " + element);
    bad("vertex 4", "vertex 99999999999999999999", "m.ply:3: " + element);
    bad("element face", "element vertex", "m.ply:7: element \"vertex\" is declared twice");
    bad("element vertex 4\n", "", "m.ply:3: a property stands before the first element");
    bad("float z", "float x", "m.ply:6: property \"x\" is declared twice");
    bad("float z", "float", "m.ply:6: a property needs a type and a name, as \"property float x\"");
    bad("float z", "half z",
        "m.ply:6: unknown type \"half\" (known: char, uchar, short, ushort, int, uint, float, double, and "
        "those as "
        "int8 to float64)");
    bad("uchar int", "float int", "m.ply:8: the length of a list must be of an integer type");
}

TEST_F(Ply, RefusesFilesWithoutAMesh) {
    const std::string good = ascii_square();
    const auto bad = [&](const std::string& old, const std::string& by, const std::string& message) {
        expect_error(replaced(good, old, by), message);
    };
    const auto no_rows = [](const std::string& name) {
        return "m.ply: the file has no rows of the element \"" + name + "\"; a mesh needs vertices and faces";
    };
    bad("element vertex", "element vertices", no_rows("vertex"));
    bad("element vertex 4", "element vertex 0", no_rows("vertex"));
    bad(FACE, "", no_rows("face"));
    bad("element face 2", "element face 0", no_rows("face"));
    bad("float y", "float Y", "m.ply:3: the element \"vertex\" needs the property \"y\", a number");
    bad("float z", "list uchar float z",
        "m.ply:3: the element \"vertex\" needs the property \"z\", a number");
    const std::string indices =
        "m.ply:7: the element \"face\" needs the property \"vertex_indices\", a list of integers";
    bad("vertex_indices", "vertices", indices);
    bad("list uchar int", "list uchar float", indices);
    bad("list uchar int", "int", indices);
}

TEST_F(Ply, RefusesBadRows) {
    const std::string good = ascii_square();
    const auto bad = [&](const std::string& old, const std::string& by, const std::string& message) {
        expect_error(replaced(good, old, by), message);
    };
    bad("1 1 0", "1 x 0", "m.ply:12: vertex 2 has \"x\" in place of a number of 4 bytes");
    bad("1 1 0", "1 1,5 0", "m.ply:12: vertex 2 has \"1,5\" in place of a number of 4 bytes");
    bad("1 1 0", "1 inf 0", "m.ply:12: vertex 2 needs a finite y, found inf");
    bad("1 1 0", "1 1e39 0", "m.ply:12: vertex 2 needs a finite y, found 1e+39");
    bad("1 1 0", "1 1", "m.ply:12: vertex 2 has too few numbers; is the file cut off?");
    bad("1 1 0", "1 1 0 0", "m.ply:12: vertex 2 has more numbers than the header announces");
    bad("3 0 1 2", "3 0 1", "m.ply:14: face 0 has too few numbers; is the file cut off?");
    bad("3 0 1 2", "3 0 1 2 3", "m.ply:14: face 0 has more numbers than the header announces");
    bad("3 0 2 3", "3 0 2 4", "m.ply:15: face 1 uses vertex 4, but the vertices are 0 to 3");
    bad("3 0 2 3", "\n3 0 2 -1", "m.ply:16: face 1 uses vertex -1, but the vertices are 0 to 3");
    bad("3 0 2 3", "3 0 2 2.5", "m.ply:15: face 1 has \"2.5\" in place of an integer of 4 bytes");
    bad("3 0 2 3", "3 0 2 2147483648",
        "m.ply:15: face 1 has \"2147483648\" in place of an integer of 4 bytes");
    bad("3 0 2 3", "2 0 2", "m.ply:15: face 1 has 2 corners; a face needs at least 3");
    bad("3 0 2 3", "256 0 2", "m.ply:15: face 1 has \"256\" in place of an integer of 1 byte");
    bad("3 0 2 3", "-1 0 2", "m.ply:15: face 1 has \"-1\" in place of an integer of 1 byte");
    bad("\n3 0 2 3", "", "m.ply:14: face 1 is missing or incomplete; is the file cut off?");
    expect_error(replaced(replaced(good, "uchar int", "ushort int"), "3 0 2 3", "1025"),
                 "m.ply:15: face 1 has 1025 corners, but at most 1024 are read; cut it into triangles");
    expect_error(replaced(replaced(good, "uchar int", "char int"), "3 0 2 3", "-128"),
                 "m.ply:15: face 1 has -128 corners; a face needs at least 3");
    expect_error(replaced(replaced(good, "vertex_indices\n", "vertex_indices\nproperty list char int a\n"),
                          "3 0 1 2", "3 0 1 2 -1"),
                 "m.ply:15: face 0 has a list of -1 numbers");
    const std::string binary = binary_square(false);
    expect_error(binary.substr(0, binary.size() - 4) + bytes_of(int32_t(9), false),
                 "m.ply: face 1 uses vertex 9, but the vertices are 0 to 3");
    expect_error(replaced(binary, bytes_of(1.0f, false), bytes_of(NAN, false)),
                 "m.ply: vertex 1 needs a finite x, found nan");
}

TEST_F(Ply, MakesNoRoomForWhatTheFileCannotHold) {
    const std::string binary = binary_square(false);
    const size_t left = binary.size() - header("binary_little_endian", VERTEX + FACE).size();
    expect_error(replaced(binary, "vertex 4", "vertex 18446744073709551615"),
                 "m.ply:3: 18446744073709551615 rows of \"vertex\" do not fit into the remaining " +
                     std::to_string(left) + " bytes; is the file cut off?");
    expect_error(
        replaced(ascii_square(), "face 2", "face 4000000000"),
        "m.ply:7: 4000000000 rows of \"face\" do not fit into the remaining 15 bytes; is the file cut off?");
    std::string list = replaced(binary, "list uchar int", "list uint int");
    expect_error(list.substr(0, list.size() - 26) + bytes_of(~0u, false) + "1234567",
                 "m.ply: face 0 has 4294967295 corners, but at most 1024 are read; cut it into triangles");
    list = replaced(binary, "list uchar int vertex_indices",
                    "list uint int a\nproperty list uchar int vertex_index");
    expect_error(list.substr(0, list.size() - 26) + bytes_of(~0u, false) + "12345678",
                 "m.ply: face 0 is missing or incomplete; is the file cut off?");
}

// Cutting within the last number of a text would leave another number; here it has one digit.
TEST_F(Ply, IsRefusedWhenCutOffAnywhere) {
    for (const std::string& text : {ascii_square(), binary_square(false), binary_square(true)}) {
        for (size_t size = 0; size < text.size(); ++size) {
            SCOPED_TRACE(size);
            EXPECT_FALSE(error_of([&] { load(text.substr(0, size)); }).empty());
        }
    }
}

TEST_F(Ply, LoadsOrIsRefusedAfterAnyChangeOfAByte) {
    size_t refused = 0;
    size_t tried = 0;
    for (const std::string& good : {ascii_square(), binary_square(false), binary_square(true)}) {
        for (size_t at = 0; at < good.size(); ++at) {
            for (const char by : {'\n', '9', '-', '\xFF'}) {
                std::string text = good;
                text[at] = by;
                ++tried;
                try {
                    const TriangleMesh mesh = load(text);
                    for (const uvec3 t : mesh.triangles)
                        EXPECT_TRUE(glm::all(glm::lessThan(t, uvec3(uint32_t(mesh.positions.size())))));
                } catch (const Error&) {
                    ++refused;
                }
            }
        }
    }
    EXPECT_GT(refused, tried / 3);
    EXPECT_LT(refused, tried);
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
