// See bodies.h.
#include "views/bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace candela {
namespace {

// Whether every ray passes the material as if it were not there.
bool is_invisible(const Material& material) {
    const Opacity& opacity = material.opacity;
    if (opacity.value.texture || material.vertex_colors) return false;
    return opacity.cutoff ? opacity.value.factor < *opacity.cutoff : opacity.value.factor == 0.0f;
}

// The vertices of a mesh that its triangles use.
std::vector<dvec3> vertices_of(const TriangleMesh& mesh) {
    std::vector<bool> used(mesh.positions.size(), false);
    for (const uvec3 t : mesh.triangles)
        used[t.x] = used[t.y] = used[t.z] = true;
    std::vector<dvec3> vertices;
    for (size_t i = 0; i < used.size(); ++i) {
        if (used[i]) vertices.push_back(mesh.origin + dvec3(mesh.positions[i]));
    }
    return vertices;
}

std::vector<dvec3> box_corners(std::span<const dvec3> points) {
    DoubleBox box;
    for (const dvec3 p : points)
        box.extend(p);
    std::vector<dvec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back(i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y,
                             i & 4 ? box.hi.z : box.lo.z);
    return corners;
}

class Collector {
  public:
    explicit Collector(const Scene& scene) : scene_(scene), vertices_(scene.meshes.size()) {}

    void add(const MeshInstance& instance) {
        constexpr size_t MANY_POINTS = 1u << 20u;  // Limit for all copies: some milliseconds a view.
        std::vector<dvec3>& vertices = vertices_[instance.mesh];
        if (vertices.empty()) {
            vertices = vertices_of(scene_.meshes[instance.mesh]);
        } else if (vertices.size() > 8 && (copied_ += vertices.size()) > MANY_POINTS) {
            vertices = box_corners(vertices);
        }
        for (const dvec3 p : vertices)
            add_point(instance.transform.point(p));
    }

    void add(const Quad& quad) {
        for (const dvec3 corner : quad.corners)
            add_point(corner);
    }

    void add(const Sphere& sphere) { bodies.push_back({.center = sphere.center, .radius = sphere.radius}); }

    void add(const Disk& disk) {
        constexpr int CORNERS = 256;
        const double angle = 2.0 * std::numbers::pi / CORNERS;
        const double outer = 1.0 / std::cos(0.5 * angle);
        for (int i = 0; i < CORNERS; ++i)
            add_point(disk.center + outer * (std::cos(i * angle) * disk.e1 + std::sin(i * angle) * disk.e2));
    }

    std::vector<Body> bodies;

  private:
    void add_point(dvec3 p) { bodies.push_back({.center = p}); }

    const Scene& scene_;
    std::vector<std::vector<dvec3>> vertices_;  // By mesh, in its space; empty before its first instance.
    size_t copied_ = 0;                         // Vertices of all instances but the first of their mesh.
};

}  // namespace

Reach reach(std::span<const Body> bodies, dvec3 n, dvec3 dn) {
    const double across = std::sqrt(n.x * n.x + n.z * n.z), size = length(n);
    const Body* farthest = nullptr;
    double value = -std::numeric_limits<double>::infinity();
    for (const Body& body : bodies) {
        const double reached = dot(n, body.center) + body.ring * across + body.radius * size;
        if (!(reached > value)) continue;
        value = reached;
        farthest = &body;
    }
    const double across_slope = across > 0.0 ? (n.x * dn.x + n.z * dn.z) / across : 0.0;
    return {value,
            dot(dn, farthest->center) + farthest->ring * across_slope + farthest->radius * dot(n, dn) / size};
}

ShownBodies shown_bodies(const Scene& scene) {
    Collector collector(scene);
    if (scene.motion) {
        for (const dvec3 p : scene.motion->ways)
            collector.bodies.push_back({.center = p});
    }
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
        const Shape& shape = scene.shapes[i];
        if (i == scene.ground || is_invisible(scene.materials[shape.material])) continue;
        if (scene.motion && scene.motion->moves_shape(i)) continue;
        std::visit([&](const auto& geometry) { collector.add(geometry); }, shape.geometry);
    }
    ShownBodies shown{.bodies = std::move(collector.bodies)};
    DoubleBox box;
    for (const Body& body : shown.bodies) {
        box.extend(body.center - body.radius);
        box.extend(body.center + body.radius);
    }
    if (!box.is_empty()) shown.origin = box.centroid();
    if (box.is_empty() || box.extent() == dvec3(0.0)) {
        shown.bodies = {{.radius = 1.0}};
        return shown;
    }
    for (Body& body : shown.bodies)
        body.center -= shown.origin;
    return shown;
}

std::vector<Body> turned_about_axis(std::span<const Body> bodies) {
    std::vector<Body> turned(bodies.begin(), bodies.end());
    for (Body& body : turned) {
        body.ring += std::hypot(body.center.x, body.center.z);
        body.center.x = body.center.z = 0.0;
    }
    return turned;
}

Body ball_around(std::span<const Body> bodies) {
    Body ball;
    for (const Body& body : bodies)
        ball.radius = std::max(ball.radius, length(body.center) + body.ring + body.radius);
    return ball;
}

}  // namespace candela
