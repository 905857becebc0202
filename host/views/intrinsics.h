// The inner parameters of a camera in pixels, and the frame in which it looks.
#pragma once

#include "load/node.h"
#include "scene/camera_axes.h"

namespace candela {

// In pixels; the principal point is measured from the picture's upper left corner, right and down.
struct Intrinsics {
    uvec2 size{0};
    glm::dvec2 focal_length{0};
    glm::dvec2 principal_point{0};
};

// Those of a perspective camera with a picture of that size.
Intrinsics intrinsics_of(const Camera& camera, uvec2 size);

// Sets them. Throws Error, at the place of the camera, if they are beyond what a camera can have.
void set_intrinsics(const Node& node, const Intrinsics& intrinsics, Camera& camera);

// Three unit vectors of a file at right angles to each other, x, y and z of a right-handed frame. Throws
// Error, at the matrix's place, if the vectors are not such, within 0.1 %.
struct Rotation {
    dvec3 x, y, z;
};
Rotation checked_rotation(const Node& matrix, const Rotation& axes);

// Places a camera, which looks along `forward`.
void set_place(dvec3 position, dvec3 forward, dvec3 up, Camera& camera);

// A matrix as rows of numbers. Throws Error if it has not that many rows and columns.
std::vector<std::vector<double>> read_matrix(const Node& node, size_t rows, size_t columns);

// Throws Error if the distortion, a coefficient of a lens or an array of them, is not zero.
void check_no_distortion(const Node& distortion);

}  // namespace candela
