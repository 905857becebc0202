// Spheres and disks: read, transformed and checked.
#include <algorithm>
#include <cmath>

#include "load/json/loader_parts.h"

namespace candela {
namespace {

dvec3 center_of(const Node& node) {
    const auto center = node.find("center");
    return center ? center->vector() : dvec3(0.0);
}

double radius_of(const Node& node) {
    const auto radius = node.find("radius");
    return radius ? radius->positive() : 1.0;
}

// The greatest magnitude of a component; dividing by it keeps squares from over- and underflowing.
double greatest(dvec3 v) {
    const dvec3 size = abs(v);
    return std::max({size.x, size.y, size.z});
}

// Throws Error if the box center +- reach goes too far. A comparison with NaN is false, which throws, too.
void check_reach(const Node& node, dvec3 center, dvec3 reach) {
    if (!glm::all(glm::lessThan(abs(center) + reach, dvec3(double(MAX_COORDINATE))))) {
        node.fail(TOO_FAR);
    }
}

// Throws Error if a disk is too small for floats, or so narrow that their rounding would turn its normal.
void check_breadth(const Node& node, const Disk& disk) {
    constexpr double NARROW = 1e-6;  // Relative to the length; a float is off by 6e-8.
    const double size = std::max(greatest(disk.e1), greatest(disk.e2));
    if (!(size >= FLOAT_MIN && length(cross(disk.e1 / size, disk.e2 / size)) > NARROW)) {
        node.fail(
            "the transform makes the disk too small or too narrow for 32-bit floats; use greater factors");
    }
}

}  // namespace

void read_sphere(const Node& node, ShapeList& shapes) {
    node.allow_only({"type"}, keys_of({"sphere", "shape"}));
    Appearance appearance = shapes.appearance_of(node);
    Sphere own{center_of(node), radius_of(node)};
    if (const auto cone = node.find("cone")) {
        cone->allow_only({}, keys_of({"cone"}));
        own.axis = direction_of(cone->require("direction"));
        appearance.beam.cone = read_cone(*cone);
    }
    const Transform transform = ShapeList::transform_of(node);
    const std::optional<double> scale = transform.uniform_scale();
    if (!scale) {
        node.require("transform")
            .fail("a sphere may only be moved, turned, mirrored and scaled evenly; use a mesh instead");
    }
    const dvec3 center = transform.point(own.center);
    const double radius = *scale * own.radius;
    if (radius < FLOAT_MIN) {
        node.fail("the transform makes the sphere too small for 32-bit floats; use greater factors");
    }
    check_reach(node, center, dvec3(radius));
    shapes.add_placed_by(appearance, own, transform);
}

void read_disk(const Node& node, ShapeList& shapes) {
    node.allow_only({"type"}, keys_of({"disk", "shape"}));
    const Appearance appearance = shapes.appearance_of(node);
    const Transform transform = ShapeList::transform_of(node);
    const dvec3 center = transform.point(center_of(node));
    const double radius = radius_of(node);
    const Node normal = node.require("normal");
    const dvec3 direction = normal.vector();
    if (direction == dvec3(0.0)) normal.fail_expected("a direction, not zero");
    const dvec3 n = normalize(direction / greatest(direction));

    // Any two radii at right angles will do; these are exact along the axes.
    const dvec3 across = std::abs(n.x) < std::abs(n.y) ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 u = normalize(cross(across, n));
    const dvec3 v = cross(n, u);
    const dvec3 e1 = transform.vector(radius * u);
    const dvec3 e2 = transform.vector(radius * v);
    check_reach(node, center, abs(e1) + abs(e2));
    check_breadth(node, Disk{center, e1, e2});
    shapes.add_placed_by(appearance, Disk{center_of(node), radius * u, radius * v}, transform);
}

}  // namespace candela
