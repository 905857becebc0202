// PLY files that are refused, with which message.
#include <cmath>

#include <gtest/gtest.h>

#include "unit/load/ply/ply_fixture.h"

namespace candela {
namespace {

TEST_F(Ply, RefusesBadHeaders) {
    const std::string good = ascii_square();
    const auto bad = [&](const std::string& old, const std::string& by, const std::string& message) {
        expect_error(replaced(good, old, by), message);
    };
    bad("ply", "", "m.ply: the file does not begin with the line \"ply\"; is it a PLY file?");
    bad("ply\nformat", "plyformat",
        "m.ply: the file does not begin with the line \"ply\"; is it a PLY file?");
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
    bad("element vertex 4\n", "", "m.ply:3: a property comes before the first element");
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
    const std::string points =
        "m.ply: the file has points, but no faces; make a mesh of them, for example with MeshLab";
    bad(FACE, "", points);
    bad("element face 2", "element face 0", points);
    bad("element face 2", "element tristrips 0", points);
    expect_error(replaced(replaced(good, FACE, ""), "float z\n", "float z\nproperty float f_dc_0\n"),
                 "m.ply: the file holds Gaussian splats, which have no surface; give a mesh");
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
    bad("1 1 0", "1 inf 0", "m.ply: vertex 2, which a face uses, needs a finite y, found inf");
    bad("1 1 0", "1 1e39 0", "m.ply: vertex 2, which a face uses, needs a finite y, found 1e+39");
    bad("1 1 0", "1 -1.#IND 0", "m.ply: vertex 2, which a face uses, needs a finite y, found nan");
    bad("1 1 0", "1 1", "m.ply:12: vertex 2 has too few numbers; is the file cut off?");
    bad("1 1 0", "1 1 0 0", "m.ply:12: vertex 2 has more numbers than the header announces");
    bad("3 0 1 2", "3 0 1", "m.ply:14: face 0 has too few numbers; is the file cut off?");
    bad("3 0 1 2", "3 0 1 2 3", "m.ply:14: face 0 has more numbers than the header announces");
    bad("3 0 2 3", "3 0 2 4", "m.ply:15: face 1 uses vertex 4, but the vertices are 0 to 3");
    bad("3 0 2 3", "\n3 0 2 -1", "m.ply:16: face 1 uses vertex -1, but the vertices are 0 to 3");
    bad("3 0 2 3", "3 0 2 2.5", "m.ply:15: face 1 has \"2.5\" in place of an integer of 4 bytes");
    bad("3 0 2 3", "3 0 2 2147483648",
        "m.ply:15: face 1 has \"2147483648\" in place of an integer of 4 bytes");
    bad("3 0 2 3", "2 0 4", "m.ply:15: face 1 uses vertex 4, but the vertices are 0 to 3");
    bad("3 0 2 3", "3 0 2 1.#INF", "m.ply:15: face 1 has \"1.#INF\" in place of an integer of 4 bytes");
    bad(FACE + "end_header\n" + POINTS + "3 0 1 2",
        replaced(FACE, "face", "tristrips") + "end_header\n" + POINTS + "3 0 1 -2",
        "m.ply:14: tristrips 0 uses vertex -2, but the vertices are 0 to 3");
    bad("3 0 2 3", "256 0 2", "m.ply:15: face 1 has \"256\" in place of an integer of 1 byte");
    bad("3 0 2 3", "-1 0 2", "m.ply:15: face 1 has \"-1\" in place of an integer of 1 byte");
    bad("\n3 0 2 3", "", "m.ply:14: face 1 is missing or incomplete; is the file cut off?");
    expect_error(replaced(replaced(good, "uchar int", "ushort int"), "3 0 2 3", "1025"),
                 "m.ply:15: face 1 has 1025 corners, but at most 1024 are read; cut it into triangles");
    expect_error(replaced(replaced(good, "uchar int", "char int"), "3 0 2 3", "-128"),
                 "m.ply:15: face 1 has a list of -128 numbers");
    expect_error(replaced(replaced(good, "vertex_indices\n", "vertex_indices\nproperty list char int a\n"),
                          "3 0 1 2", "3 0 1 2 -1"),
                 "m.ply:15: face 0 has a list of -1 numbers");
    const std::string binary = binary_square(false);
    expect_error(binary.substr(0, binary.size() - 4) + bytes_of(int32_t(9), false),
                 "m.ply: face 1 uses vertex 9, but the vertices are 0 to 3");
    expect_error(replaced(binary, bytes_of(1.0f, false), bytes_of(NAN, false)),
                 "m.ply: vertex 1, which a face uses, needs a finite x, found nan");
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

}  // namespace
}  // namespace candela
