// What pictures of ids call the things of a scene: whole numbers from 1, and names.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace candela {

// The greatest number: floats represent every whole number up to this.
inline constexpr uint32_t MAX_LABEL = 1u << 24;

// An object as it is shown once.
struct LabelledInstance {
    uint32_t object = 0;  // The number of the object.
    uint32_t copy = 0;    // The number of the instance among those of the object, from 0.
};

// The numbers of a shape; of group g of its mesh, those of object and instance are greater by g.
struct ShapeLabels {
    uint32_t object = 0, instance = 0, material = 0;
};

// Number n is element n - 1.
struct Labels {
    std::vector<std::string> objects;  // Names, all different.
    std::vector<LabelledInstance> instances;
    std::vector<std::string> materials;  // Names, all different.
    std::vector<ShapeLabels> shapes;     // By index of the shape in the scene.
};

}  // namespace candela
