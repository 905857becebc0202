// glTF files as tinygltf reads them.
#include <cstring>
#include <functional>

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include "probe/random.h"
#include "unit/load/gltf/gltf_fixture.h"

namespace candela {
namespace {

// The numbers of a component in memory, and their normalisation by the specification's equations.
double component(int type, const uint8_t* bytes, bool normalized) {
    const auto as = [&](auto zero, double max) {
        std::memcpy(&zero, bytes, sizeof zero);
        return normalized ? std::max(double(zero) / max, -1.0) : double(zero);
    };
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return as(int8_t(), 127.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return as(uint8_t(), 255.0);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return as(int16_t(), 32767.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return as(uint16_t(), 65535.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return as(uint32_t(), 1.0);
        default:
            return as(float(), 1.0);
    }
}

// An accessor's elements, from the places that tinygltf has found.
std::vector<double> elements(const tinygltf::Model& model, int index) {
    const tinygltf::Accessor& accessor = model.accessors.at(size_t(index));
    const auto width = size_t(tinygltf::GetNumComponentsInType(uint32_t(accessor.type)));
    const auto size = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType)));
    const auto data = [&](int view, size_t offset) {
        const tinygltf::BufferView& v = model.bufferViews.at(size_t(view));
        return model.buffers.at(size_t(v.buffer)).data.data() + v.byteOffset + offset;
    };
    std::vector<double> result(accessor.count * width, 0.0);
    const auto read = [&](size_t element, const uint8_t* bytes) {
        for (size_t c = 0; c < width; ++c)
            result.at(element * width + c) =
                component(accessor.componentType, bytes + c * size, accessor.normalized);
    };
    if (accessor.bufferView >= 0) {
        const int stride = accessor.ByteStride(model.bufferViews.at(size_t(accessor.bufferView)));
        for (size_t i = 0; i < accessor.count; ++i)
            read(i, data(accessor.bufferView, accessor.byteOffset + i * size_t(stride)));
    }
    const auto& sparse = accessor.sparse;
    const auto& indices = sparse.indices;
    const auto& values = sparse.values;
    for (size_t i = 0; sparse.isSparse && i < size_t(sparse.count); ++i) {
        const auto index_size = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(indices.componentType)));
        const uint8_t* at = data(indices.bufferView, size_t(indices.byteOffset) + i * index_size);
        read(size_t(component(indices.componentType, at, false)),
             data(values.bufferView, size_t(values.byteOffset) + i * width * size));
    }
    return result;
}

// A node's own matrix.
glm::dmat4 matrix_of(const tinygltf::Node& node) {
    glm::dmat4 m(1.0);
    if (!node.matrix.empty()) {
        for (int i = 0; i < 16; ++i)
            m[i / 4][i % 4] = node.matrix[size_t(i)];
        return m;
    }
    const auto or_else = [](const std::vector<double>& v, std::vector<double> otherwise) {
        return v.empty() ? otherwise : v;
    };
    const auto t = or_else(node.translation, {0, 0, 0}), s = or_else(node.scale, {1, 1, 1});
    const auto q = or_else(node.rotation, {0, 0, 0, 1});
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                               {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                               {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            m[column][row] = rows[row][column] * s[size_t(column)];
        m[3][row] = t[size_t(row)];
    }
    return m;
}

class Maker {
  public:
    explicit Maker(uint32_t seed) : random_(seed) {}

    GltfFile make() {
        file_.root["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
        file_.root["textures"] = {{{"source", 0}}};
        file_.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        file_.root["extensionsUsed"] = file_.root["extensionsRequired"] =
            Json::array({"KHR_mesh_quantization"});
        for (int i = 0; i < 6; ++i) {
            add_mesh();
            Json node = placement();
            node["mesh"] = i;
            if (i > 1) node["children"] = {i - 2};  // Two chains.
            file_.push("nodes", node);
        }
        return file_;
    }

  private:
    uint32_t below(uint32_t n) { return random_.bits() % n; }
    double number(double max) { return max * (2.0 * double(random_.unit()) - 1.0); }

    Json placement() {
        if (below(3) == 0) {
            Json matrix = Json::array();
            for (int i = 0; i < 16; ++i)
                matrix.push_back(i % 4 == 3 ? (i == 15 ? 1.0 : 0.0) : number(3));
            return {{"matrix", matrix}};
        }
        Json node = Json::object();
        if (below(3) > 0) node["translation"] = {number(10), number(10), number(10)};
        if (below(3) > 0) node["scale"] = {number(2), number(2), number(2)};
        if (below(3) > 0) {
            const dvec3 v = 0.3 * normalize(dvec3(random_.direction()));
            node["rotation"] = {v.x, v.y, v.z, std::sqrt(1.0 - dot(v, v))};
        }
        return node;
    }

    static size_t size_of(int type) {
        return type == 5126 || type == 5125 ? 4 : type == 5122 || type == 5123 ? 2 : 1;
    }

    std::string random_element(int type, size_t width) {
        std::string bytes;
        for (size_t i = 0; i < width; ++i) {
            const auto f = float(number(100));
            const uint32_t bits = random_.bits();
            bytes.append(
                type == 5126 ? reinterpret_cast<const char*>(&f) : reinterpret_cast<const char*>(&bits),
                size_of(type));
        }
        return bytes;
    }

    struct Attribute {
        const char* name;
        const char* type;
        std::vector<int> components;
    };

    // Attributes in views of their own, or all in one; of any type and, now and then, sparse.
    void add_mesh() {
        const Attribute attributes[] = {{"POSITION", "VEC3", {5120, 5121, 5122, 5123, 5126}},
                                        {"NORMAL", "VEC3", {5120, 5122, 5126}},
                                        {"TEXCOORD_0", "VEC2", {5120, 5121, 5122, 5123, 5126}}};
        const uint32_t vertices = 20 + below(100);
        const bool interleaved = below(2) == 0;
        const size_t gap = 4 * below(3);
        std::string together(gap, '?');
        size_t vertex_size = 0;
        Json all = Json::object();
        std::vector<std::pair<size_t, std::string>> placed;
        for (const auto& [name, type, components] : attributes) {
            const int component = components[below(uint32_t(components.size()))];
            const size_t width = width_of(type), size = width * size_of(component);
            const size_t padded = (size + 3) / 4 * 4;
            std::string bytes;
            for (uint32_t i = 0; i < vertices; ++i)
                bytes += random_element(component, width) + std::string(padded - size, '?');
            const bool is_normal = std::string(name) == "NORMAL";
            Json accessor = {{"componentType", component},
                             {"count", vertices},
                             {"type", type},
                             {"normalized", component != 5126 && (is_normal || below(2) == 0)}};
            if (interleaved) {
                accessor["byteOffset"] = gap + vertex_size;
                placed.emplace_back(padded, bytes);
                vertex_size += padded;
            } else {
                accessor["bufferView"] = file_.add_view(std::vector<char>(bytes.begin(), bytes.end()));
                if (padded != size || below(2) == 0)
                    file_.root["bufferViews"][accessor["bufferView"].get<size_t>()]["byteStride"] = padded;
            }
            if (below(3) == 0) accessor["sparse"] = sparse(component, width, vertices);
            all[name] = file_.push("accessors", accessor);
        }
        if (interleaved) {
            for (uint32_t i = 0; i < vertices; ++i) {
                for (const auto& [size, bytes] : placed)
                    together += bytes.substr(i * size, size);
            }
            const size_t view = file_.add_view(std::vector<char>(together.begin(), together.end()));
            file_.root["bufferViews"][view]["byteStride"] = vertex_size;
            for (const auto& [name, index] : all.items())
                file_.root["accessors"][index.get<size_t>()]["bufferView"] = view;
        }
        Json primitive = {{"attributes", all}, {"material", 0}};
        if (below(4) > 0) primitive["indices"] = indices(vertices);
        file_.push("meshes", {{"primitives", Json::array({primitive})}});
    }

    Json sparse(int component, size_t width, uint32_t vertices) {
        std::vector<uint16_t> rows;
        std::string values;
        for (uint32_t i = below(5); i < vertices; i += 1 + below(9)) {
            rows.push_back(uint16_t(i));
            values += random_element(component, width);
        }
        return {
            {"count", rows.size()},
            {"indices", {{"bufferView", file_.add_view(rows)}, {"componentType", 5123}}},
            {"values", {{"bufferView", file_.add_view(std::vector<char>(values.begin(), values.end()))}}}};
    }

    size_t indices(uint32_t vertices) {
        std::vector<uint32_t> corners;
        for (int i = 0; i < 50; ++i) {
            const uint32_t first = below(vertices);
            for (uint32_t k = 0; k < 3; ++k)
                corners.push_back((first + k * (1 + below(5))) % vertices);
        }
        const uint32_t type = below(3);
        if (type == 0) return file_.add("SCALAR", std::vector<uint8_t>(corners.begin(), corners.end()));
        if (type == 1) return file_.add("SCALAR", std::vector<uint16_t>(corners.begin(), corners.end()));
        return file_.add("SCALAR", corners);
    }

    Random random_;
    GltfFile file_;
};

void expect_same_mesh(const TriangleMesh& ours, const tinygltf::Model& model,
                      const tinygltf::Primitive& primitive) {
    const auto exact = elements(model, primitive.attributes.at("POSITION"));
    const std::vector<float> positions(exact.begin(), exact.end());
    const auto normals = elements(model, primitive.attributes.at("NORMAL"));
    const auto uvs = elements(model, primitive.attributes.at("TEXCOORD_0"));
    std::vector<double> corners;
    if (primitive.indices >= 0) {
        corners = elements(model, primitive.indices);
    } else {
        for (size_t i = 0; i < positions.size() / 3; ++i)
            corners.push_back(double(i));
    }
    const auto at = [](const auto& v, size_t i) { return dvec3(v[3 * i], v[3 * i + 1], v[3 * i + 2]); };
    size_t triangle = 0;
    for (size_t i = 0; i + 3 <= corners.size(); i += 3) {
        const size_t c[] = {size_t(corners[i]), size_t(corners[i + 1]), size_t(corners[i + 2])};
        const auto corner = [&](size_t k) { return at(positions, c[k]); };
        if (cross(corner(1) - corner(0), corner(2) - corner(0)) == dvec3(0)) continue;  // Without area.
        ASSERT_LT(triangle, ours.triangles.size());
        const uvec3 t = ours.triangles[triangle++];
        for (int k = 0; k < 3; ++k) {
            ASSERT_EQ(ours.origin + dvec3(ours.positions.at(t[k])), corner(size_t(k))) << i;
            ASSERT_LE(distance(dvec3(ours.normals.at(t[k])), normalize(at(normals, c[k]))), 3e-7) << i;
            // 1 - v is rounded twice.
            const vec2 uv = ours.uv0.at(t[k]);
            ASSERT_EQ(uv.x, float(uvs[2 * c[k]])) << i;
            ASSERT_NEAR(uv.y, 1.0 - uvs[2 * c[k] + 1], 0x1p-23 * (1.0 + std::abs(uvs[2 * c[k] + 1]))) << i;
        }
    }
    EXPECT_EQ(triangle, ours.triangles.size());
}

using GltfOracle = Gltf;

TEST_F(GltfOracle, ReadsWhatTinygltfReads) {
    for (uint32_t seed = 0; seed < 30; ++seed) {
        SCOPED_TRACE(seed);
        const GltfFile file = Maker(seed).make();
        const bool binary = seed % 2 == 0;
        const std::string bytes = binary ? file.glb() : file.gltf();
        const Scene scene = load_text(bytes);
        tinygltf::TinyGLTF reader;
        reader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int,
                                 const unsigned char*, int, void*) { return true; },
                              nullptr);
        tinygltf::Model model;
        std::string error, warning;
        const bool is_read =
            binary ? reader.LoadBinaryFromMemory(&model, &error, &warning,
                                                 reinterpret_cast<const unsigned char*>(bytes.data()),
                                                 uint32_t(bytes.size()))
                   : reader.LoadASCIIFromString(&model, &error, &warning, bytes.data(),
                                                uint32_t(bytes.size()), "");
        ASSERT_TRUE(is_read) << error;
        // Both read nodes from their roots, parents first.
        size_t shape = 0;
        const std::function<void(int, const glm::dmat4&)> visit = [&](int index, const glm::dmat4& parent) {
            const tinygltf::Node& node = model.nodes.at(size_t(index));
            const glm::dmat4 world = parent * matrix_of(node);
            ASSERT_LT(shape, scene.shapes.size());
            const auto& [mesh, transform] = std::get<MeshInstance>(scene.shapes[shape++].geometry);
            for (const dvec3 p : {dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)}) {
                const dvec3 expected(world * glm::dvec4(p, 1.0));
                EXPECT_LE(distance(transform.point(p), expected), 1e-12 * (1.0 + length(expected)));
            }
            expect_same_mesh(scene.meshes.at(mesh), model,
                             model.meshes.at(size_t(node.mesh)).primitives.at(0));
            for (const int child : node.children)
                visit(child, world);
        };
        for (const int root : {4, 5})
            visit(root, glm::dmat4(1.0));
        EXPECT_EQ(shape, scene.shapes.size());
    }
}

}  // namespace
}  // namespace candela
