// What the tests of cameras share: where a camera shows a point, by the pinhole's formula.
#pragma once

#include <cmath>

#include <gtest/gtest.h>

#include "scene/scene.h"

namespace candela {

// In pixels from the upper left corner of a picture of that size, to the right and down.
inline glm::dvec2 pixel_of(const Camera& camera, uvec2 size, dvec3 point) {
    const dvec3 forward = normalize(camera.look_at - camera.position);
    const dvec3 right = normalize(cross(forward, dvec3(camera.up)));
    const dvec3 p = point - camera.position;
    const double depth = dot(p, forward);
    EXPECT_GT(depth, 0.0);
    const double focal_length = 0.5 * size.y / std::tan(0.5 * double(camera.vertical_fov));
    const glm::dvec2 principal_point =
        0.5 * glm::dvec2(size) + double(size.y) * glm::dvec2(camera.principal_offset);
    return principal_point +
           focal_length / depth *
               glm::dvec2(double(camera.focal_ratio) * dot(p, right), -dot(p, cross(right, forward)));
}

inline void expect_close(dvec3 a, dvec3 b, double tolerance) {
    EXPECT_LE(length(a - b), tolerance)
        << a.x << ' ' << a.y << ' ' << a.z << ", not " << b.x << ' ' << b.y << ' ' << b.z;
}

}  // namespace candela
