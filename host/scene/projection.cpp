// See projection.h. The inverse of shaders/scene/camera.glsl.
#include "scene/projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace candela {
namespace {

constexpr double PI_D = std::numbers::pi;

glm::dvec2 half_view(const Camera& camera, glm::dvec2 size) {
    if (camera.panorama) {
        const bool has_circle = camera.panorama->mapping != Mapping::equirectangular;
        return has_circle ? size / std::min(size.x, size.y) : glm::dvec2(1.0);
    }
    const double half_y =
        camera.ortho_height ? 0.5 * *camera.ortho_height : std::tan(0.5 * double(camera.vertical_fov));
    return {half_y * size.x / size.y / double(camera.focal_ratio), half_y};
}

bool is_finite(glm::dvec2 v) {
    return std::isfinite(v.x) && std::isfinite(v.y);
}

}  // namespace

Projection::Projection(const Camera& camera, uvec2 size)
    : camera_(camera),
      axes_(axes_of(camera)),
      size_(size),
      principal_point_(1.0 + 2.0 * glm::dvec2(camera.principal_offset) * glm::dvec2(size_.y / size_.x, 1.0)),
      half_(half_view(camera, size_)) {}

// `halves`: from the principal point to the right and downwards, in halves of the picture's sides.
glm::dvec2 Projection::place_of_halves(glm::dvec2 halves) const {
    return 0.5 * size_ * (halves + principal_point_);
}

std::optional<glm::dvec2> Projection::place_of(dvec3 point) const {
    const dvec3 d = point - camera_.position;
    if (!is_parallel()) return place_of_direction(d);
    const glm::dvec2 place = place_of_halves(glm::dvec2(dot(d, axes_.right), -dot(d, axes_.up)) / half_);
    return is_finite(place) ? std::optional(place) : std::nullopt;
}

std::optional<glm::dvec2> Projection::place_of_direction(dvec3 direction) const {
    const double x = dot(direction, axes_.right), y = dot(direction, axes_.up),
                 z = dot(direction, axes_.forward);
    const double across = std::hypot(x, y);
    if (is_parallel() || !(across > 0.0 || z != 0.0)) return std::nullopt;
    glm::dvec2 halves(0.0);
    if (!camera_.panorama) {
        if (!(z > 0.0)) return std::nullopt;
        halves = glm::dvec2(x, -y) / (z * half_);
    } else if (is(Mapping::equirectangular)) {
        halves = {std::atan2(x, z) / PI_D, -2.0 / PI_D * std::atan2(y, std::hypot(x, z))};
    } else {
        const double angle = std::atan2(across, z), widest = 0.5 * double(camera_.panorama->fisheye_fov);
        const double radius =
            is(Mapping::fisheye) ? angle / widest : std::sin(0.5 * angle) / std::sin(0.5 * widest);
        if (across > 0.0) halves = glm::dvec2(x, -y) * (radius / across) / half_;
    }
    const glm::dvec2 place = place_of_halves(halves);
    return is_finite(place) ? std::optional(place) : std::nullopt;
}

std::optional<dvec3> Projection::direction_at(glm::dvec2 place) const {
    const glm::dvec2 halves = 2.0 * place / size_ - principal_point_;
    const dvec3 across = halves.x * half_.x * axes_.right - halves.y * half_.y * axes_.up;
    if (is_parallel()) return axes_.forward;
    if (!camera_.panorama) return axes_.forward + across;
    if (is(Mapping::equirectangular)) {
        const double longitude = PI_D * halves.x, latitude = -0.5 * PI_D * halves.y;
        return std::cos(latitude) *
                   (std::cos(longitude) * axes_.forward + std::sin(longitude) * axes_.right) +
               std::sin(latitude) * axes_.up;
    }
    const double radius = length(across), widest = 0.5 * double(camera_.panorama->fisheye_fov);
    if (!(radius <= 1.0)) return std::nullopt;
    if (radius == 0.0) return axes_.forward;
    const double angle =
        is(Mapping::fisheye) ? radius * widest : 2.0 * std::asin(radius * std::sin(0.5 * widest));
    return std::cos(angle) * axes_.forward + std::sin(angle) / radius * across;
}

glm::dvec2 Projection::way(glm::dvec2 from, glm::dvec2 to) const {
    glm::dvec2 way = to - from;
    if (is(Mapping::equirectangular)) way.x = std::remainder(way.x, size_.x);
    return way;
}

}  // namespace candela
