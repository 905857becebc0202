// See seen_from_behind.h. The grid is a depth buffer, into which all triangles are drawn.
#include "scene/seen_from_behind.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/camera_axes.h"
#include "scene/geometry.h"
#include "scene/materials.h"

namespace candela {
namespace {

constexpr uint64_t MAX_TRIANGLES = uint64_t{1} << 22;
constexpr uint32_t LONGEST_SIDE = 128;  // Of the grid.

// A corner in the grid, and its nearness: the inverse of the depth or, for parallel rays, minus the depth.
// Both are linear in the grid.
struct Corner {
    double x, y, nearness;
};

class Grid {
  public:
    Grid(const Camera& camera, uvec2 size) : camera_(camera), axes_(axes_of(camera)) {
        const uint32_t side = std::max(size.x, size.y);
        const auto cells = [&](uint32_t n) { return std::max(1u, n * std::min(side, LONGEST_SIDE) / side); };
        width_ = cells(size.x);
        height_ = cells(size.y);
        const double half_y =
            camera.ortho_height ? 0.5 * *camera.ortho_height : std::tan(0.5 * double(camera.vertical_fov));
        const glm::dvec2 per_height(width_ * double(size.y) / size.x,
                                    height_);  // Cells in a picture's height.
        scale_ = 0.5 / half_y * per_height * glm::dvec2(camera.focal_ratio, -1.0);
        middle_ = glm::dvec2(0.5 * width_, 0.5 * height_) + per_height * glm::dvec2(camera.principal_offset);
        nearest_.resize(size_t{width_} * height_, -double(INFINITE));
        behind_.resize(nearest_.size());
    }

    // Draws a triangle of world space. `mirrored`: its front is where its corners run clockwise.
    void draw(const std::array<dvec3, 3>& corners, bool culled, bool mirrored) {
        std::array<dvec3, 3> local;
        for (size_t i = 0; i < 3; ++i) {
            const dvec3 p = corners[i] - camera_.position;
            local[i] = {dot(p, axes_.right), dot(p, axes_.up), dot(p, axes_.forward)};
        }
        const std::vector<Corner> polygon = cut(local);
        for (size_t i = 2; i < polygon.size(); ++i)
            fill(polygon[0], polygon[i - 1], polygon[i], culled, mirrored);
    }
    double share_behind() const { return double(std::ranges::count(behind_, true)) / double(behind_.size()); }

  private:
    // The corners of what lies before the camera.
    std::vector<Corner> cut(const std::array<dvec3, 3>& local) const {
        std::vector<Corner> polygon;
        double farthest = 0.0;
        for (const dvec3& p : local)
            farthest = std::max(farthest, p.z);
        const double near = 1e-6 * farthest;
        for (size_t i = 0; i < 3 && farthest > 0.0; ++i) {
            const dvec3 &p = local[i], &next = local[(i + 1) % 3];
            if (p.z >= near) polygon.push_back(corner(p));
            if ((p.z >= near) != (next.z >= near))
                polygon.push_back(corner(mix(p, next, (near - p.z) / (next.z - p.z))));
        }
        return polygon;
    }
    Corner corner(dvec3 p) const {
        const double divisor = camera_.ortho_height ? 1.0 : p.z;
        return {middle_.x + scale_.x * p.x / divisor, middle_.y + scale_.y * p.y / divisor,
                camera_.ortho_height ? -p.z : 1.0 / p.z};
    }
    void fill(const Corner& a, const Corner& b, const Corner& c, bool culled, bool mirrored) {
        const auto cross_of = [](const Corner& p, const Corner& q, double x, double y) {
            return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
        };
        const double area =
            cross_of(a, b, c.x, c.y);  // Below 0: counter-clockwise, since y points downwards.
        if (!(std::abs(area) > 0.0)) return;
        const bool behind = culled && (area > 0.0) != mirrored;
        const auto first = [](double least) { return uint32_t(std::max(0.0, std::ceil(least - 0.5))); };
        const auto end = [](double greatest, uint32_t cells) {
            return uint32_t(std::clamp(std::floor(greatest - 0.5) + 1.0, 0.0, double(cells)));
        };
        const uint32_t x1 = end(std::max({a.x, b.x, c.x}), width_),
                       y1 = end(std::max({a.y, b.y, c.y}), height_);
        for (uint32_t y = first(std::min({a.y, b.y, c.y, double(height_)})); y < y1; ++y) {
            for (uint32_t x = first(std::min({a.x, b.x, c.x, double(width_)})); x < x1; ++x) {
                const double u = cross_of(b, c, x + 0.5, y + 0.5) / area,
                             v = cross_of(c, a, x + 0.5, y + 0.5) / area;
                const double w = 1.0 - u - v, nearness = u * a.nearness + v * b.nearness + w * c.nearness;
                double& nearest = nearest_[size_t{y} * width_ + x];
                if (u < 0.0 || v < 0.0 || w < 0.0 || !(nearness > nearest)) continue;
                nearest = nearness;
                behind_[size_t{y} * width_ + x] = behind;
            }
        }
    }

    const Camera& camera_;
    CameraAxes axes_;
    glm::dvec2 scale_{}, middle_{};
    uint32_t width_ = 0, height_ = 0;
    std::vector<double> nearest_;
    std::vector<bool> behind_;  // Whether what is nearest is seen from behind, and single-sided.
};

void draw(Grid& grid, const TriangleMesh& mesh, const Transform& transform, bool culled) {
    std::vector<dvec3> points;
    points.reserve(mesh.positions.size());
    for (const vec3& p : mesh.positions)
        points.push_back(transform.point(mesh.origin + dvec3(p)));
    for (const uvec3& t : mesh.triangles)
        grid.draw({points[t.x], points[t.y], points[t.z]}, culled, transform.mirrors());
}

}  // namespace

void make_double_sided(Scene& scene) {
    for (Material& material : scene.materials) {
        if (auto* m = std::get_if<PrincipledMaterial>(&material.model)) m->double_sided = true;
    }
    for (Shape& shape : scene.shapes) {
        const bool principled =
            std::holds_alternative<PrincipledMaterial>(scene.materials[shape.material].model);
        if (principled && shape.emission && !shape.states_emission) shape.emission->two_sided = true;
    }
}

std::optional<double> share_seen_from_behind(const Scene& scene, const Camera& camera, uvec2 size) {
    if (camera.panorama || !std::ranges::any_of(scene.materials, is_culled) ||
        triangle_count(scene) > MAX_TRIANGLES)
        return std::nullopt;
    Grid grid(camera, size);
    for (const Shape& shape : scene.shapes) {
        const bool culled = is_culled(scene.materials[shape.material]);
        if (const auto* instance = std::get_if<MeshInstance>(&shape.geometry))
            draw(grid, scene.meshes[instance->mesh], instance->transform, culled);
        if (const auto* quad = std::get_if<Quad>(&shape.geometry)) {
            const auto& c = quad->corners;
            grid.draw({c[0], c[1], c[2]}, culled, false);
            grid.draw({c[0], c[2], c[3]}, culled, false);
        }
    }
    return grid.share_behind();
}

}  // namespace candela
