// Shapes with flat faces that the scene file itself describes: read, transformed and checked one by one.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "load/json/arrays.h"
#include "load/json/loader_parts.h"
#include "load/json/objects.h"
#include "scene/mesh.h"

namespace candela {
namespace {

// Throws Error unless the corners span a convex, planar quadrilateral.
void check_quad(const Node& node, const Quad& quad) {
    // Relative to the longer diagonal. PLANAR allows for coordinates that are given to three digits.
    constexpr double PLANAR = 1e-3;
    constexpr double DEGENERATE = 1e-9;
    const auto corner = [&](size_t i) { return quad.corners[i % 4]; };
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

void read_quad(const Node& node, ShapeList& shapes) {
    node.allow_only({"type"}, keys_of({"quad", "shape"}));
    const Appearance appearance = shapes.appearance_of(node);
    const Transform transform = ShapeList::transform_of(node);
    const Node vertices = node.require("vertices");
    const std::vector<Node> points = vertices.elements();
    if (points.size() != 4) vertices.fail_expected("four points");
    Quad own;
    for (size_t i = 0; i < 4; ++i) {
        own.corners[i] = points[i].vector();
        within_reach(points[i], transform.point(own.corners[i]));
    }
    check_quad(vertices, std::get<Quad>(shapes.add_placed_by(appearance, own, transform).geometry));
}

void read_box(const Node& node, ShapeList& shapes) {
    // Bits 0, 1 and 2 of a corner choose between min and max along x, y and z.
    constexpr uint8_t SIDES[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    // The corner of a side at the lower left of an upright image, seen from outside.
    constexpr uint8_t LOWER_LEFT[6] = {0, 3, 0, 1, 3, 0};
    node.allow_only({"type"}, keys_of({"box", "shape"}));
    const Appearance appearance = shapes.appearance_of(node);
    const Transform transform = ShapeList::transform_of(node);
    const dvec3 lo = node.require("min").vector();
    const dvec3 hi = node.require("max").vector();
    if (!glm::all(glm::lessThan(lo, hi))) {
        node.require("max").fail("each number of max must be above that of min");
    }
    for (size_t side = 0; side < 6; ++side) {
        Quad own;
        for (size_t i = 0; i < 4; ++i) {
            const size_t corner = SIDES[side][i];
            const dvec3 p(corner & 1u ? hi.x : lo.x, corner & 2u ? hi.y : lo.y, corner & 4u ? hi.z : lo.z);
            within_reach(node, transform.point(p));
            own.corners[i] = p;
            own.uvs[i] = Quad{}.uvs[(i + 4 - LOWER_LEFT[side]) % 4];
        }
        check_quad(node, std::get<Quad>(shapes.add_placed_by(appearance, own, transform).geometry));
    }
}

// The elements of an array that has one for each of `positions`.
std::vector<Node> one_per_position(const Node& node, size_t positions) {
    std::vector<Node> elements = node.elements();
    if (elements.size() != positions)
        node.fail_expected("as many elements as positions, " + std::to_string(positions));
    return elements;
}

std::vector<vec2> read_uvs(const Node& node, const Scene& scene, size_t positions) {
    std::vector<vec2> uvs;
    if (is_array_name(node)) {
        const ArrayRows rows(node, scene, {2}, positions);
        uvs.reserve(positions);
        rows.for_each([&](uint64_t i, const double* uv) {
            for (const size_t c : {0, 1})
                if (std::abs(uv[c]) > MAX_UV) rows.fail(i, "numbers from -1e30 to 1e30", uv[c]);
            uvs.emplace_back(float(uv[0]), float(uv[1]));
        });
        return uvs;
    }
    for (const Node& element : one_per_position(node, positions)) {
        const std::vector<Node> numbers = element.elements();
        if (numbers.size() != 2) element.fail_expected("two numbers [u, v]");
        const glm::dvec2 uv(numbers[0].number(), numbers[1].number());
        if (std::max(std::abs(uv.x), std::abs(uv.y)) > MAX_UV)
            element.fail_expected("numbers from -1e30 to 1e30");
        uvs.emplace_back(uv);
    }
    return uvs;
}

std::vector<vec4> read_colors(const Node& node, const Scene& scene, size_t positions) {
    std::vector<vec4> colors;
    if (is_array_name(node)) {
        const ArrayRows rows(node, scene, {3, 4}, positions);
        colors.reserve(positions);
        rows.for_each([&](uint64_t i, const double* numbers) {
            vec4 color(1.0f);
            for (size_t c = 0; c < rows.columns(); ++c) {
                if (!(numbers[c] >= 0.0 && numbers[c] <= 1.0))
                    rows.fail(i, "numbers from 0 to 1", numbers[c]);
                color[int(c)] = float(numbers[c]);
            }
            colors.push_back(color);
        });
        return colors;
    }
    for (const Node& element : one_per_position(node, positions)) {
        const std::vector<Node> numbers = element.elements();
        if (numbers.size() != 3 && numbers.size() != 4) element.fail_expected("three or four numbers");
        vec4 color(1.0f);
        for (size_t i = 0; i < numbers.size(); ++i)
            color[int(i)] = numbers[i].number(0.0f, 1.0f);
        colors.push_back(color);
    }
    return colors;
}

// Points or directions.
std::vector<dvec3> read_vectors(const Node& node, const Scene& scene,
                                std::optional<uint64_t> count = std::nullopt) {
    std::vector<dvec3> vectors;
    if (is_array_name(node)) {
        const ArrayRows rows(node, scene, {3}, count);
        vectors.reserve(rows.rows());
        rows.for_each([&](uint64_t, const double* v) { vectors.emplace_back(v[0], v[1], v[2]); });
        return vectors;
    }
    for (const Node& element : node.elements())
        vectors.push_back(element.vector());
    return vectors;
}

// Indices of positions, of which `last` is the last.
std::vector<uvec3> read_triangles(const Node& node, const Scene& scene, uint32_t last) {
    std::vector<uvec3> triangles;
    if (is_array_name(node)) {
        const ArrayRows rows(node, scene, {3});
        triangles.reserve(rows.rows());
        rows.for_each([&](uint64_t i, const double* corners) {
            for (const size_t c : {0, 1, 2}) {
                if (corners[c] != std::trunc(corners[c]) || corners[c] < 0.0 || corners[c] > double(last))
                    rows.fail(i, concat("indices of positions, from 0 to ", last), corners[c]);
            }
            triangles.emplace_back(uint32_t(corners[0]), uint32_t(corners[1]), uint32_t(corners[2]));
        });
        return triangles;
    }
    for (const Node& triangle : node.elements()) {
        const std::vector<Node> corners = triangle.elements();
        if (corners.size() != 3) triangle.fail_expected("three indices of positions");
        triangles.emplace_back(corners[0].integer(0, last), corners[1].integer(0, last),
                               corners[2].integer(0, last));
    }
    return triangles;
}

void read_mesh(const Node& node, ShapeList& shapes) {
    node.allow_only({"type"}, keys_of({"mesh", "shape"}));
    const Appearance appearance = shapes.appearance_of(node);
    const Transform transform = ShapeList::transform_of(node);
    shapes.add_mesh(node.place(), appearance, transform, read_triangle_mesh(node, shapes.scene()));
}

// The name of a shape: its own, that of the object or file that it shows, or its type and its place in the
// list.
std::string name_of(const Node& shape, size_t i) {
    if (const auto name = shape.find("name")) {
        if (name->string().empty()) name->fail_expected("a name that is not empty");
        return name->string();
    }
    if (const auto object = shape.find("object")) return object->string();
    if (const auto file = shape.find("file")) return std::filesystem::path(file->string()).stem().string();
    return shape.require("type").string() + ' ' + std::to_string(i);
}

// A reader of a shape that places no object.
template <void (*READ)(const Node&, ShapeList&)>
void alone(const Node& node, const ObjectMap&, ShapeList& shapes) {
    READ(node, shapes);
}

}  // namespace

TriangleMesh read_triangle_mesh(const Node& node, const Scene& scene) {
    TriangleMesh mesh;
    const Node positions = node.require("positions");
    std::vector<dvec3> points = read_vectors(positions, scene);
    if (points.empty()) positions.fail_expected("at least one point");
    const auto last = uint32_t(points.size() - 1);
    set_positions(mesh, std::move(points));
    mesh.triangles = read_triangles(node.require("triangles"), scene, last);
    if (const auto normals = node.find("normals")) {
        for (const dvec3 n : read_vectors(*normals, scene, mesh.positions.size()))
            mesh.normals.emplace_back(n);
        if (mesh.normals.size() != mesh.positions.size()) {
            normals->fail_expected("as many normals as positions, " + std::to_string(mesh.positions.size()));
        }
    }
    if (const auto uvs = node.find("uvs")) mesh.uv0 = read_uvs(*uvs, scene, mesh.positions.size());
    if (const auto uvs = node.find("uvs1")) mesh.uv1 = read_uvs(*uvs, scene, mesh.positions.size());
    if (const auto colors = node.find("colors"))
        mesh.colors = read_colors(*colors, scene, mesh.positions.size());
    return mesh;
}

void read_shapes(const Node& node, const std::optional<Node>& objects, const std::filesystem::path& folder,
                 Scene& scene, const LoadProgress& progress) {
    using Reader = void (*)(const Node&, const ObjectMap&, ShapeList&);
    constexpr std::array<std::pair<std::string_view, Reader>, 8> READERS{{{"quad", &alone<read_quad>},
                                                                          {"box", &alone<read_box>},
                                                                          {"mesh", &alone<read_mesh>},
                                                                          {"sphere", &alone<read_sphere>},
                                                                          {"disk", &alone<read_disk>},
                                                                          {"obj", &alone<read_obj>},
                                                                          {"ply", &alone<read_ply>},
                                                                          {"instance", &read_instance}}};
    ShapeList shapes(folder, scene);
    ObjectMap known;
    const std::vector<Node> members = objects ? objects->members() : std::vector<Node>();
    size_t done = 0, of = node.size();
    for (const Node& object : members)
        of += object.size();
    const auto read = [&](const Node& shape) {
        const size_t first = scene.shapes.size();
        shape.require("type").choice(READERS)(shape, known, shapes);
        shapes.read_seen(shape, first);
        progress("shapes", ++done, of);
    };
    for (const Node& object : members) {
        const auto before = std::ptrdiff_t(scene.shapes.size());
        for (const Node& shape : object.elements()) {
            if (const auto name = shape.find("name"))
                name->fail(
                    "a shape of an object has no name; name the object, or the instances that place it");
            read(shape);
        }
        const auto first = scene.shapes.begin() + before;
        known.emplace(object.key(), std::vector<Shape>(first, scene.shapes.end()));
        scene.shapes.erase(first, scene.shapes.end());
    }
    const std::vector<Node> shown = node.elements();
    for (size_t i = 0; i < shown.size(); ++i) {
        shapes.begin_object(name_of(shown[i], i));
        read(shown[i]);
    }
}

}  // namespace candela
