// Ref: Khronos, "glTF 2.0 Specification", sections 3.7.2 and 3.7.3.
#include "load/gltf/primitive.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/text.h"
#include "load/gltf/accessor.h"
#include "load/gltf/primitive_triangles.h"
#include "load/gltf/vertex_data.h"
#include "scene/mesh.h"
#include "scene/texture.h"

namespace candela::gltf {
namespace {

// Reads one primitive, attribute by attribute, for the vertices that its triangles use.
class PrimitiveReader {
  public:
    PrimitiveReader(File& file, const Node& primitive, const Deformation& deformation)
        : file_(file),
          primitive_(primitive),
          attributes_(primitive.require("attributes")),
          deformation_(deformation) {
        const auto targets = primitive.find("targets");
        if (!targets || deformation.weights.empty()) return;
        const std::vector<Node> all = targets->elements();
        if (deformation.weights.size() != all.size()) {
            file.warn(*targets, concat("there are ", deformation.weights.size(), " weights for ", all.size(),
                                       " morph targets; missing ones are 0"));
        }
        for (size_t i = 0; i < std::min(all.size(), deformation.weights.size()); ++i) {
            if (deformation.weights[i] != 0.0) targets_.emplace_back(all[i], deformation.weights[i]);
        }
    }

    TriangleMesh read(std::vector<uvec3> triangles, uint32_t vertices) {
        vertices_ = vertices;
        rows_ = keep_used(triangles, vertices);
        TriangleMesh mesh;
        mesh.triangles = std::move(triangles);
        std::vector<glm::dvec3> positions = vectors("POSITION", {"VEC3"});
        check_finite("POSITION", positions);
        std::vector<glm::dvec3> normals = vectors("NORMAL", {"VEC3"});
        if (!normals.empty()) read_tangents(mesh);
        if (!deformation_.joints.empty()) skin(positions, normals, mesh.tangents);
        check_finite("POSITION", positions);
        for (const glm::dvec3 n : normals) {
            const double size = length(n);
            // Length zero means no normal, and the triangle's is used instead.
            mesh.normals.emplace_back(size > 0.0 && std::isfinite(size) ? vec3(n / size) : vec3(0.0f));
        }
        set_positions(mesh, std::move(positions));
        mesh.uv0 = read_uvs("TEXCOORD_0");
        mesh.uv1 = read_uvs("TEXCOORD_1");
        read_colors(mesh);
        return mesh;
    }

  private:
    // The floats of an attribute, with its morph targets; none if the primitive lacks it.
    std::vector<float> floats(const char* name, std::initializer_list<std::string_view> types,
                              uint32_t& width) {
        const auto reference = attributes_.find(name);
        if (!reference) return {};
        const Accessor accessor = vertex_accessor(file_, primitive_, *reference, types);
        check_count(*reference, accessor);
        width = accessor.width();
        std::vector<float> values = accessor.floats(rows_);
        for (const auto& [target, weight] : targets_) {
            const auto moved = target.find(name);
            if (!moved) continue;
            const Accessor offsets(file_, *moved, {"VEC2", "VEC3", "VEC4"});
            check_count(*moved, offsets);
            const std::vector<float> change = offsets.floats(rows_);
            // Those of tangents have no w.
            const uint32_t shared = std::min(width, offsets.width());
            for (size_t i = 0; i < rows_.size(); ++i) {
                for (uint32_t c = 0; c < shared; ++c)
                    values[i * width + c] += float(weight) * change[i * offsets.width() + c];
            }
        }
        return values;
    }

    void check_count(const Node& reference, const Accessor& accessor) const {
        if (accessor.count() == vertices_) return;
        reference.fail(concat("the attribute has ", accessor.count(), " elements for ", vertices_,
                              " vertices; is the file damaged?"));
    }

    std::vector<glm::dvec3> vectors(const char* name, std::initializer_list<std::string_view> types) {
        uint32_t width = 0;
        const std::vector<float> values = floats(name, types, width);
        std::vector<glm::dvec3> result;
        result.reserve(values.size() / 3);
        for (size_t i = 0; i + 3 <= values.size(); i += 3)
            result.emplace_back(values[i], values[i + 1], values[i + 2]);
        return result;
    }

    void check_finite(const char* name, const std::vector<glm::dvec3>& values) const {
        for (size_t i = 0; i < values.size(); ++i) {
            if (is_finite(vec3(values[i]))) continue;
            attributes_.require(name).fail(
                concat("the coordinates of vertex ", rows_[i], " are not finite; export the mesh again"));
        }
    }

    void read_tangents(TriangleMesh& mesh) {
        uint32_t width = 0;
        const std::vector<float> values = floats("TANGENT", {"VEC4"}, width);
        for (size_t i = 0; i + 4 <= values.size(); i += 4) {
            const vec3 direction(values[i], values[i + 1], values[i + 2]);
            const float size = length(direction);
            if (!(size > 0.0f) || !std::isfinite(size)) {
                file_.warn(attributes_.require("TANGENT"),
                           "some tangents have no direction; all are computed from the texture coordinates");
                mesh.tangents.clear();
                return;
            }
            mesh.tangents.emplace_back(direction / size, values[i + 3] < 0.0f ? -1.0f : 1.0f);
        }
    }

    std::vector<vec2> read_uvs(const char* name) {
        uint32_t width = 0;
        const std::vector<float> values = floats(name, {"VEC2"}, width);
        std::vector<vec2> uvs;
        uvs.reserve(values.size() / 2);
        const auto limited = [](float v) {
            return std::isfinite(v) ? std::clamp(v, -float(MAX_UV), float(MAX_UV)) : 0.0f;
        };
        for (size_t i = 0; i + 2 <= values.size(); i += 2)
            uvs.emplace_back(limited(values[i]), 1.0f - limited(values[i + 1]));
        return uvs;
    }

    void read_colors(TriangleMesh& mesh) {
        uint32_t width = 0;
        const std::vector<float> values = floats("COLOR_0", {"VEC3", "VEC4"}, width);
        bool in_range = true;
        const auto limited = [&](float v) {
            constexpr float ROUNDING = 1e-5f;
            in_range = in_range && v >= -ROUNDING && v <= 1.0f + ROUNDING;
            return v > 0.0f ? std::min(v, 1.0f) : 0.0f;
        };
        for (size_t i = 0; width > 0 && i + width <= values.size(); i += width) {
            mesh.colors.emplace_back(limited(values[i]), limited(values[i + 1]), limited(values[i + 2]),
                                     width == 4 ? limited(values[i + 3]) : 1.0f);
        }
        if (!in_range) {
            file_.warn(attributes_.require("COLOR_0"),
                       "some colours are not between 0 and 1; they are clamped");
        }
    }

    // For each vertex, the mean of its joints' matrices.
    std::vector<glm::dmat4> blended_joints() {
        std::vector<glm::dmat4> blended(rows_.size(), glm::dmat4(0.0));
        std::vector<double> sums(rows_.size(), 0.0);
        if (!attributes_.find("JOINTS_0") || !attributes_.find("WEIGHTS_0")) {
            file_.warn(
                attributes_,
                "the mesh has a skin, but the primitive has no joints; all of it follows the first joint");
        }
        for (int set = 0;; ++set) {
            const auto joints = attributes_.find("JOINTS_" + std::to_string(set));
            const auto weights = attributes_.find("WEIGHTS_" + std::to_string(set));
            if (set > 0 && joints.has_value() != weights.has_value()) {
                file_.warn(joints ? *joints : *weights,
                           concat("JOINTS_", set, " and WEIGHTS_", set, " are only used together"));
            }
            if (!joints || !weights) break;
            const Accessor joint_accessor = vertex_accessor(file_, primitive_, *joints, {"VEC4"});
            const Accessor weight_accessor = vertex_accessor(file_, primitive_, *weights, {"VEC4"});
            check_count(*joints, joint_accessor);
            check_count(*weights, weight_accessor);
            const std::vector<uint32_t> joint = joint_accessor.integers();
            const std::vector<float> weight = weight_accessor.floats();
            if (std::ranges::any_of(weight, [](float w) { return w < 0.0f; }))
                file_.warn(*weights, "some weights are below 0, and are read as 0");
            for (size_t i = 0; i < rows_.size(); ++i) {
                for (size_t k = 4 * size_t(rows_[i]); k < 4 * (size_t(rows_[i]) + 1); ++k) {
                    if (!(weight[k] > 0.0f) || !std::isfinite(weight[k])) continue;
                    if (joint[k] >= deformation_.joints.size()) {
                        joints->fail(concat("vertex ", rows_[i], " follows a joint beyond the skin's ",
                                            deformation_.joints.size()));
                    }
                    blended[i] += double(weight[k]) * deformation_.joints[joint[k]];
                    sums[i] += double(weight[k]);
                }
            }
        }
        for (size_t i = 0; i < rows_.size(); ++i)
            blended[i] = sums[i] > 0.0 ? blended[i] / sums[i] : deformation_.joints[0];
        return blended;
    }

    void skin(std::vector<glm::dvec3>& positions, std::vector<glm::dvec3>& normals,
              std::vector<vec4>& tangents) {
        const std::vector<glm::dmat4> matrices = blended_joints();
        for (size_t i = 0; i < positions.size(); ++i) {
            positions[i] = glm::dvec3(matrices[i] * glm::dvec4(positions[i], 1.0));
            const glm::dmat3 linear(matrices[i]);
            if (!normals.empty()) {
                // The inverse transpose, up to a factor.
                const glm::dmat3 cofactor(cross(linear[1], linear[2]), cross(linear[2], linear[0]),
                                          cross(linear[0], linear[1]));
                normals[i] = cofactor * normals[i] * (determinant(linear) < 0.0 ? -1.0 : 1.0);
            }
            if (!tangents.empty()) {
                const glm::dvec3 t = linear * glm::dvec3(tangents[i]);
                if (length(t) > 0.0) tangents[i] = vec4(vec3(normalize(t)), tangents[i].w);
                if (deformation_.mirrors) tangents[i].w = -tangents[i].w;
            }
        }
    }

    File& file_;
    Node primitive_;
    Node attributes_;
    Deformation deformation_;
    std::vector<std::pair<Node, double>> targets_;  // With weights other than 0.
    uint32_t vertices_ = 0;
    std::vector<uint32_t> rows_;  // The vertices that triangles use.
};

// Whether the accessor of that index states that it has no elements.
bool is_empty(const File& file, const Node& reference) {
    const auto count = file.resolve("accessors", reference).find("count");
    return count && count->is_number() && count->number() == 0.0;
}

// The mesh with all of its triangles, also those without area. `position` refers to the accessor.
TriangleMesh read_all(File& file, const Node& primitive, const Deformation& deformation,
                      const Node& position) {
    const uint32_t vertices = vertex_accessor(file, primitive, position, {"VEC3"}).count();
    std::vector<uvec3> triangles = read_triangles(file, primitive, mode_of(primitive), vertices);
    if (deformation.mirrors) {
        for (uvec3& t : triangles)
            std::swap(t.y, t.z);
    }
    return PrimitiveReader(file, primitive, deformation).read(std::move(triangles), vertices);
}

}  // namespace

std::optional<TriangleMesh> read_primitive(File& file, const Node& primitive,
                                           const Deformation& deformation) {
    const uint32_t mode = mode_of(primitive);
    if (mode < MODE_TRIANGLES) {
        file.warn(primitive, "left out points or lines, which have no surface");
        return std::nullopt;
    }
    const auto attributes = primitive.find("attributes");
    const auto position = attributes ? attributes->find("POSITION") : std::nullopt;
    if (!position) {
        file.warn(primitive, "left out a primitive without positions");
        return std::nullopt;
    }
    const auto indices = primitive.find("indices");
    if (is_empty(file, *position) || (indices && is_empty(file, *indices))) {
        file.warn(primitive, "left out a primitive without triangles");
        return std::nullopt;
    }
    TriangleMesh mesh = read_all(file, primitive, deformation, *position);
    drop_flat_triangles(mesh);
    if (mesh.triangles.empty()) {
        file.warn(primitive, "left out a primitive without area");
        return std::nullopt;
    }
    return mesh;
}

std::vector<dvec3> read_positions(File& file, const Node& primitive, const Deformation& deformation) {
    const TriangleMesh mesh =
        read_all(file, primitive, deformation, primitive.require("attributes").require("POSITION"));
    std::vector<dvec3> positions;
    positions.reserve(mesh.positions.size());
    for (const vec3 p : mesh.positions)
        positions.push_back(mesh.origin + dvec3(p));
    return positions;
}

}  // namespace candela::gltf
