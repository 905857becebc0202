// OBJ files as tinyobjloader reads them.
#include <sstream>

#include <gtest/gtest.h>
#include <tiny_obj_loader.h>

#include "base/color.h"
#include "load/obj/obj_file.h"
#include "probe/random.h"

namespace candela {
namespace {

struct Oracle {
    std::vector<vec3> positions;
    std::vector<vec2> uvs;
    std::vector<vec3> normals;
    std::vector<ObjCorner> corners;
    std::vector<uint32_t> corner_uvs;
    std::vector<uint32_t> sizes;
};

Oracle read(const std::string& text) {
    Oracle oracle;
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* out, float x, float y, float z, float) {
        static_cast<Oracle*>(out)->positions.emplace_back(x, y, z);
    };
    callbacks.texcoord_cb = [](void* out, float u, float v, float) {
        static_cast<Oracle*>(out)->uvs.emplace_back(u, v);
    };
    callbacks.normal_cb = [](void* out, float x, float y, float z) {
        static_cast<Oracle*>(out)->normals.emplace_back(x, y, z);
    };
    callbacks.index_cb = [](void* out, tinyobj::index_t* indices, int count) {
        auto& [positions, uvs, normals, corners, corner_uvs, sizes] = *static_cast<Oracle*>(out);
        const auto absolute = [](int index, size_t size) {
            return index == 0 ? ObjCorner::NONE : uint32_t(index > 0 ? index - 1 : int(size) + index);
        };
        for (int i = 0; i < count; ++i) {
            corners.push_back({absolute(indices[i].vertex_index, positions.size()),
                               absolute(indices[i].normal_index, normals.size())});
            corner_uvs.push_back(absolute(indices[i].texcoord_index, uvs.size()));
        }
        sizes.push_back(uint32_t(count));
    };
    std::istringstream stream(text);
    EXPECT_TRUE(tinyobj::LoadObjWithCallback(stream, callbacks, &oracle));
    return oracle;
}

// The colours of all positions; the function above does not pass them on.
std::vector<vec3> read_colors(const std::string& text) {
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warnings, errors;
    std::istringstream stream(text);
    EXPECT_TRUE(tinyobj::LoadObj(&attributes, &shapes, &materials, &warnings, &errors, &stream, nullptr,
                                 /*triangulate=*/false))
        << errors;
    std::vector<vec3> colors;
    for (size_t i = 0; i + 2 < attributes.colors.size(); i += 3)
        colors.emplace_back(attributes.colors[i], attributes.colors[i + 1], attributes.colors[i + 2]);
    return colors;
}

// Numbers of all sizes and spellings, faces of all forms, in any order.
std::string random_obj(uint32_t seed) {
    Random random(seed);
    const auto number = [&] {
        const double size = std::pow(10.0, 12.0 * double(random.unit()) - 6.0);
        const double value = random.bits() & 1 ? size : -size;
        const char* formats[] = {"%.3f", "%.9g", "%+.17g", "%.4e", "%.0f"};
        char text[64];
        std::snprintf(text, sizeof text, formats[random.bits() % 5], value);
        return std::string(text);
    };
    const auto color = [&] {
        char text[64];
        const dvec3 c = 0.5 * dvec3(random.cube()) + 0.5;
        std::snprintf(text, sizeof text, " %.6f %.9g\t%.3e", c.x, c.y, c.z);
        return std::string(text);
    };
    std::string text;
    int vertices = 0, uvs = 0, normals = 0;
    for (int line = 0; line < 400; ++line) {
        const uint32_t kind = random.bits() % 8;
        if (kind < 3 || vertices == 0) {
            text += "v " + number() + "  " + number() + '\t' + number() +
                    (kind == 0   ? " 1.0"
                     : kind == 1 ? color()
                                 : "") +
                    '\n';
            ++vertices;
        } else if (kind == 3) {
            text += "vt " + number() + (random.bits() % 4 == 0 ? "" : ' ' + number()) + '\n';
            ++uvs;
        } else if (kind == 4) {
            text += "vn " + number() + ' ' + number() + ' ' + number() + '\n';
            ++normals;
        } else {
            const auto index = [&](int count) {
                const int forward = 1 + int(random.bits() % uint32_t(count));
                return std::to_string(random.bits() & 1 ? forward : -forward);
            };
            const uint32_t form = random.bits() % 4;
            text += "f";
            for (uint32_t corner = 0; corner < 3 + random.bits() % 6; ++corner) {
                text += ' ' + index(vertices);
                if (form == 1 && uvs > 0) text += '/' + index(uvs);
                if (form == 2 && normals > 0) text += "//" + index(normals);
                if (form == 3 && uvs > 0 && normals > 0) text += '/' + index(uvs) + '/' + index(normals);
            }
            text += kind == 5 ? " \n" : "\r\n";
        }
    }
    return text + "f 1 1 1\n";
}

TEST(ObjOracle, ReadsWhatTinyobjloaderReads) {
    for (uint32_t seed = 0; seed < 50; ++seed) {
        SCOPED_TRACE(seed);
        const std::string text = random_obj(seed);
        const ObjFile ours = parse_obj(text, "random.obj");
        const Oracle theirs = read(text);
        ASSERT_EQ(ours.positions.size(), theirs.positions.size());
        ASSERT_EQ(ours.normals.size(), theirs.normals.size());
        ASSERT_EQ(ours.sizes, theirs.sizes);
        ASSERT_EQ(ours.corners.size(), theirs.corners.size());
        // Theirs are floats, and not always those nearest to the text.
        const auto near = [](glm::dvec3 a, vec3 b) {
            return all(lessThanEqual(abs(a - glm::dvec3(b)), 0x1p-23 * abs(a)));
        };
        for (size_t i = 0; i < ours.positions.size(); ++i)
            ASSERT_TRUE(near(ours.positions[i], theirs.positions[i])) << i;
        for (size_t i = 0; i < ours.normals.size(); ++i)
            ASSERT_TRUE(near(glm::dvec3(ours.normals[i]), theirs.normals[i])) << i;
        for (size_t i = 0; i < ours.corners.size(); ++i) {
            ASSERT_EQ(ours.corners[i].position, theirs.corners[i].position) << i;
            ASSERT_EQ(ours.corners[i].normal, theirs.corners[i].normal) << i;
        }
        ASSERT_EQ(ours.uvs.size(), theirs.uvs.size());
        for (size_t i = 0; i < ours.uvs.size(); ++i)
            ASSERT_TRUE(near(glm::dvec3(ours.uvs[i], 0.0), vec3(theirs.uvs[i], 0.0f))) << i;
        ASSERT_EQ(ours.corner_uvs, theirs.corner_uvs);
        const std::vector<vec3> colors = read_colors(text);
        ASSERT_EQ(ours.colors.size(), colors.size());
        for (size_t i = 0; i < colors.size(); ++i) {
            // Theirs are codes of sRGB. Powers of floats that differ in their last bit differ in two or
            // three.
            const vec3 light(srgb_decode(colors[i].x), srgb_decode(colors[i].y), srgb_decode(colors[i].z));
            ASSERT_TRUE(all(lessThanEqual(abs(ours.colors[i] - light), 0x1p-21f * light))) << i;
        }
    }
}

}  // namespace
}  // namespace candela
