// Shapes: read, transformed and checked one by one.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/error.h"
#include "scene/loader_parts.h"
#include "scene/mesh.h"
#include "scene/obj.h"
#include "scene/transform.h"

namespace candela {
namespace {

using glm::dvec3;

constexpr std::array<std::string_view, 5> COMMON_KEYS{"type", "material", "emission", "two_sided",
                                                      "transform"};
constexpr std::array<std::pair<std::string_view, ObjNormals>, 3> OBJ_NORMALS_NAMES{
    {{"file", ObjNormals::file}, {"smooth", ObjNormals::smooth}, {"flat", ObjNormals::flat}}};

// A point in world space as floats; `node` is where it came from.
vec3 rounded(const Node& node, dvec3 p) {
    constexpr double FLOAT_MAX = std::numeric_limits<float>::max();
    if (!glm::all(glm::lessThanEqual(abs(p), dvec3(FLOAT_MAX)))) {
        node.fail("the transform moves a point out of the range of 32-bit floats");
    }
    return vec3(p);
}

// Throws Error unless the corners span a convex, planar quadrilateral.
void check_quad(const Node& node, const Quad& quad) {
    // Relative to the longer diagonal. The first leaves room for coordinates that were given to three digits.
    constexpr double PLANAR = 1e-3;
    constexpr double DEGENERATE = 1e-9;
    const auto corner = [&](size_t i) { return dvec3(quad.corners[i % 4]); };
    const dvec3 diagonal = corner(2) - corner(0);
    const dvec3 other_diagonal = corner(3) - corner(1);
    const double size = std::max(length(diagonal), length(other_diagonal));
    const dvec3 normal = cross(diagonal, other_diagonal);
    if (!(length(normal) > DEGENERATE * size * size)) {
        node.fail("the quad has no area, or its sides cross; list its corners counter-clockwise");
    }
    const dvec3 n = normalize(normal);
    if (std::abs(dot(n, corner(1) - corner(0))) > PLANAR * size) {
        node.fail("the corners of the quad do not lie in a plane; use a mesh of two triangles");
    }
    for (size_t i = 0; i < 4; ++i) {
        const dvec3 turn = cross(corner(i + 1) - corner(i), corner(i + 2) - corner(i + 1));
        if (!(dot(turn, n) > DEGENERATE * size * size)) {
            node.fail("the quad is not convex; use a mesh, or list its corners counter-clockwise");
        }
    }
}

class ShapeReader {
  public:
    ShapeReader(std::filesystem::path folder, Scene& scene) : folder_(std::move(folder)), scene_(scene) {
        for (const Material& material : scene.materials) {
            indices_.emplace(material.name, uint32_t(indices_.size()));
        }
    }

    void read(const Node& node) {
        constexpr std::array<std::pair<std::string_view, void (ShapeReader::*)(const Node&)>, 4> READERS{
            {{"quad", &ShapeReader::read_quad},
             {"box", &ShapeReader::read_box},
             {"mesh", &ShapeReader::read_mesh},
             {"obj", &ShapeReader::read_obj}}};
        (this->*node.require("type").choice(READERS))(node);
    }

  private:
    void read_quad(const Node& node) {
        node.allow_only({"vertices"}, COMMON_KEYS);
        const Transform transform = transform_of(node);
        const Node vertices = node.require("vertices");
        const std::vector<Node> points = vertices.elements();
        if (points.size() != 4) vertices.fail_expected("four points");
        Quad quad;
        for (size_t i = 0; i < 4; ++i) {
            const size_t corner = transform.mirrors() ? (4 - i) % 4 : i;
            quad.corners[corner] = rounded(points[i], transform.point(points[i].vector()));
        }
        check_quad(vertices, quad);
        add(node, quad);
    }

    void read_box(const Node& node) {
        // Bits 0, 1 and 2 of a corner choose between min and max along x, y and z.
        constexpr uint8_t SIDES[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
        node.allow_only({"min", "max"}, COMMON_KEYS);
        const Transform transform = transform_of(node);
        const dvec3 lo = node.require("min").vector();
        const dvec3 hi = node.require("max").vector();
        if (!glm::all(glm::lessThan(lo, hi))) {
            node.require("max").fail("each number of max must be above that of min");
        }
        for (const auto& side : SIDES) {
            Quad quad;
            for (size_t i = 0; i < 4; ++i) {
                const size_t corner = side[transform.mirrors() ? 3 - i : i];
                const dvec3 p(corner & 1u ? hi.x : lo.x, corner & 2u ? hi.y : lo.y,
                              corner & 4u ? hi.z : lo.z);
                quad.corners[i] = rounded(node, transform.point(p));
            }
            check_quad(node, quad);
            add(node, quad);
        }
    }

    void read_mesh(const Node& node) {
        node.allow_only({"positions", "triangles", "normals"}, COMMON_KEYS);
        const Transform transform = transform_of(node);
        TriangleMesh mesh;
        const Node positions = node.require("positions");
        for (const Node& p : positions.elements()) {
            mesh.positions.push_back(rounded(p, transform.point(p.vector())));
        }
        if (mesh.positions.empty()) positions.fail_expected("at least one point");
        const auto last = uint32_t(mesh.positions.size() - 1);
        for (const Node& triangle : node.require("triangles").elements()) {
            const std::vector<Node> corners = triangle.elements();
            if (corners.size() != 3) triangle.fail_expected("three indices of positions");
            mesh.triangles.emplace_back(corners[0].integer(0, last), corners[1].integer(0, last),
                                        corners[2].integer(0, last));
        }
        if (const auto normals = node.find("normals")) {
            for (const Node& n : normals->elements())
                mesh.normals.emplace_back(n.vector());
            if (mesh.normals.size() != mesh.positions.size()) {
                normals->fail_expected("as many normals as positions, " +
                                       std::to_string(mesh.positions.size()));
            }
        }
        add_mesh(node, transform, std::move(mesh));
    }

    void read_obj(const Node& node) {
        node.allow_only({"file", "normals"}, COMMON_KEYS);
        const Transform transform = transform_of(node);
        const Node file = node.require("file");
        const auto normals = node.find("normals");
        const ObjNormals kind = normals ? normals->choice(OBJ_NORMALS_NAMES) : ObjNormals::file;
        TriangleMesh mesh = load(file, kind);
        for (vec3& p : mesh.positions)
            p = rounded(file, transform.point(dvec3(p)));
        add_mesh(node, transform, std::move(mesh));
    }

    TriangleMesh load(const Node& file, ObjNormals normals) const {
        try {
            return load_obj(folder_ / file.string(), normals);
        } catch (const Error& error) {
            file.fail(error.what());
        }
    }

    static Transform transform_of(const Node& node) {
        const auto transform = node.find("transform");
        return transform ? read_transform(*transform) : Transform();
    }

    // Adds a mesh whose positions are in world space, but whose normals and winding are not.
    void add_mesh(const Node& node, const Transform& transform, TriangleMesh mesh) {
        for (vec3& n : mesh.normals)
            n = transform.normal(n);
        if (transform.mirrors()) {
            for (uvec3& t : mesh.triangles)
                std::swap(t.y, t.z);
        }
        const size_t dropped = drop_flat_triangles(mesh);
        if (mesh.triangles.empty()) node.fail("the mesh has no triangle with an area; check its positions");
        if (dropped > 0) {
            scene_.warnings.push_back(node.place() + ": left out " + std::to_string(dropped) +
                                      (dropped == 1 ? " triangle" : " triangles") + " without area");
        }
        complete_normals(mesh);
        add(node, std::move(mesh));
    }

    // Adds a finished geometry with the material and emission of `node`.
    template <class Geometry>
    void add(const Node& node, Geometry&& geometry) {
        Shape shape;
        const auto emission = node.find("emission");
        const auto two_sided = node.find("two_sided");
        const bool both_sides = two_sided && two_sided->boolean();
        if (two_sided && !emission)
            two_sided->fail("two_sided says where emission leaves; it needs \"emission\"");
        if (emission) {
            const vec3 radiance = emission->rgb();
            if (radiance != vec3(0.0f)) shape.emission = {radiance, both_sides};
        }
        const auto material = node.find("material");
        if (!material && !emission) node.fail("the shape has neither material nor emission; add one of them");
        shape.material = material ? index_of(*material) : black();
        shape.geometry = std::forward<Geometry>(geometry);
        scene_.shapes.push_back(std::move(shape));
    }

    uint32_t index_of(const Node& material) const {
        const auto found = indices_.find(material.string());
        if (found != indices_.end()) return found->second;
        std::vector<std::string> names;
        for (const Material& defined : scene_.materials)
            names.push_back(defined.name);
        material.fail_unknown("material", material.string(), names, "defined");
    }

    // The material of emitters that reflect nothing.
    uint32_t black() {
        if (!black_) {
            black_ = uint32_t(scene_.materials.size());
            scene_.materials.push_back({"(black)", DiffuseMaterial{vec3(0.0f)}});
        }
        return *black_;
    }

    std::filesystem::path folder_;
    Scene& scene_;
    std::map<std::string, uint32_t, std::less<>> indices_;  // Of the materials that the scene file defines.
    std::optional<uint32_t> black_;
};

}  // namespace

void read_shapes(const Node& node, const std::filesystem::path& folder, Scene& scene) {
    ShapeReader reader(folder, scene);
    for (const Node& shape : node.elements())
        reader.read(shape);
}

}  // namespace candela
