// From the statements of an MTL file to a material.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace candela {

// A material as the file states it; what is absent is empty.
struct MtlStatements {
    std::string name;
    uint64_t line = 0;             // Of newmtl.
    std::optional<glm::dvec3> kd;  // Finite and >= 0, as are ks and ke.
    std::optional<glm::dvec3> ks;
    vec3 ke{0};       // [W/(m^2 sr)].
    double ns = 1.0;  // >= 0.
    std::optional<double> ni;
    uint64_t ni_line = 0;
    uint32_t illum = 2;  // 0 .. 10.
    std::optional<double> d;
    std::optional<double> tr;
    bool has_texture = false;  // Whether there is a map_Kd.
};

// What one `newmtl` describes.
struct MtlMaterial {
    Material material;                  // Under its name in the file.
    vec3 emission{0};                   // Ke [W/(m^2 sr)].
    std::vector<std::string> warnings;  // `file:line: ...`, of interest if the material is used.
};

// The material by its `illum`:
//   0, 1      diffuse: Kd;
//   2         Phong: Kd, Ks, and Ns as the exponent; diffuse if Ks is 0 or absent;
//   3, 5      a mirror: Ks (1 if absent);
//   4, 6, 7   a dielectric: Ni (1.5 if absent);
//   8, 9, 10  as 2, with a warning.
// Where Kd + Ks exceeds 1 in a channel, one factor scales both to a sum of at most 1, with a warning.
// `file` is the file's name in messages. Throws Error `file:line: cause` for an Ni that is not above 0.
// Ref: Alias|Wavefront, "MTL material format" (1995).
MtlMaterial mtl_material(const MtlStatements& statements, const std::string& file);

}  // namespace candela
