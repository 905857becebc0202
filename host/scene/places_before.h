// Where what moves of a scene was at another time of its animation.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace candela {

struct PlaceBefore {
    uint32_t shape = 0;              // Index into Scene::shapes; it shows a mesh.
    glm::dmat4 transform{1.0};       // From the mesh's space to the world's; it may be singular.
    std::vector<dvec3> positions{};  // Of the mesh's vertices, in its space; empty: those that it has.
};

struct PlacesBefore {
    std::vector<Camera> cameras{};  // As Scene::cameras.
    // Of those that move, deform or are hidden at some time, if they show anything.
    std::vector<PlaceBefore> shapes{};
};

}  // namespace candela
