// Where the parts of an object are, if the object is placed by another transform.
#pragma once

#include <memory>

#include "scene/scene.h"

namespace candela {

// Places a geometry once more, by a transform from the space that it is in. Returns false, and leaves it
// useless, if that is not possible: if the transform flattens a mesh, or scales a sphere unevenly.
bool place(Geometry& geometry, const Transform& transform);

// The geometry of a shape before its object was placed, and the transform that places it.
Origin origin_of(const Shape& shape);

// Gives a shape the geometry that the transform makes of its object's. Returns false, and leaves it useless,
// if that is not possible.
bool place_object(Shape& shape, const Geometry& own, const Transform& transform);

// Whether a geometry lies within reach.
bool reaches_no_farther(const Scene& scene, const Geometry& geometry);

}  // namespace candela
