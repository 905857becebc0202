// Affine transforms from a shape's own space to world space.
#pragma once

#include <optional>

#include "base/math.h"

namespace candela {

// A chain of steps, initially the identity; not singular.
class Transform {
  public:
    // Appends a step (affine, its last row 0 0 0 1). Returns false, and leaves the transform useless, if the
    // result is singular: if it turns a cube into a parallelepiped of at most 1e-12 the volume of a box with
    // such edges, or overflows.
    bool append(const glm::dmat4& step);

    // A point in world space; it need not fit into a float.
    glm::dvec3 point(glm::dvec3 p) const { return glm::dvec3(matrix_ * glm::dvec4(p, 1.0)); }
    // The same for a difference of two points.
    glm::dvec3 vector(glm::dvec3 v) const { return glm::dmat3(matrix_) * v; }
    // The unit normal in world space for a normal of any length; zero stays zero.
    vec3 normal(vec3 n) const;
    // The matrices of point() and of vector().
    const glm::dmat4& matrix() const { return matrix_; }
    glm::dmat3 linear() const { return glm::dmat3(matrix_); }
    // True if the transform turns clockwise into counter-clockwise.
    bool mirrors() const { return mirrors_; }

    // The factor of a transform that only moves, turns, mirrors and scales evenly, so that spheres stay
    // spheres within 2e-5 of their radius; nothing for any other.
    std::optional<double> uniform_scale() const;
    // The same, or of an uneven transform the edge of a cube with the volume that it gives a cube of edge 1.
    double mean_scale() const;

    bool operator==(const Transform&) const = default;

  private:
    glm::dmat4 matrix_{1.0};
    glm::dmat3 cofactor_{1.0};  // The inverse transpose of the linear part, up to a factor.
    bool mirrors_ = false;
};

}  // namespace candela
