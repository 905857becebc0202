// From the statements of an MTL file to a material.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "load/obj/mtl_ignored.h"
#include "load/obj/mtl_texture.h"
#include "scene/scene.h"

namespace candela {

// A material as the file states it; what is absent is empty.
struct MtlStatements {
    std::string name;
    uint64_t line = 0;             // Of newmtl.
    std::optional<glm::dvec3> kd;  // Finite and >= 0, as are ks and ke.
    std::optional<glm::dvec3> ks;
    std::optional<glm::dvec3> ke;  // [W/(m^2 sr)].
    double ns = 1.0;               // >= 0.
    std::optional<double> ni;
    uint64_t ni_line = 0;
    uint32_t illum = 2;  // 0 .. 10.
    std::optional<double> d;
    std::optional<double> tr;
    std::optional<double> pr;  // Roughness, in [0, 1].
    std::optional<double> pm;  // How much of a metal it is, in [0, 1].
    // map_Kd, map_Ks, map_Ke, map_Ns, map_d, map_Pr, map_Pm, norm and bump.
    std::map<std::string, MtlTexture, std::less<>> textures;
};

// An image that a statement names.
struct MtlImage {
    std::filesystem::path file;
    std::string place;  // Of the statement, as `file:line`.
};

// What one `newmtl` describes.
struct MtlMaterial {
    Material material;                    // Under its name in the file.
    Textured<vec3> emission{vec3(0)};     // Ke [W/(m^2 sr)].
    std::vector<MtlImage> images{};       // What Texture::image means, up to add_images().
    std::vector<std::string> warnings{};  // `file:line: ...`, of interest if the material is used.
};

// The material by its `illum`:
//   0, 1      diffuse: Kd;
//   2         Phong: Kd, Ks, and Ns as the exponent; diffuse if Ks is 0 or absent;
//   3, 5      a mirror: Ks (1 if absent);
//   4, 6, 7   a dielectric: Ni (1.5 if absent);
//   8, 9, 10  as 2, with a warning.
// A metal (Pm from 0.5, or map_Pm without Pm) that is no dielectric is a conductor instead, of the
// reflectance Kd and the roughness Pr. Textures are multiplied by the statement of the same name, 1 if it is
// absent. Opacity is d, or 1 - Tr, times map_d, whose channel is alpha if the image has one, or else red; of
// a dielectric, map_d alone.
// Where Kd + Ks exceeds 1 in a channel, one factor scales both to a sum of at most 1, with a warning.
// `file` is the file's name in messages; `ignored` gets what the material has no use for. Throws Error
// `file:line: cause` for an Ni that is not above 0.
// Ref: Alias|Wavefront, "MTL material format" (1995); Exocortex, "PBR extension to MTL" (2014).
MtlMaterial mtl_material(const MtlStatements& statements, const std::string& file, MtlIgnored& ignored);

// Adds the images of a material to the scene, so that its textures look them up there. Throws Error
// for one that is out of reach.
void add_images(MtlMaterial& material, Scene& scene);

}  // namespace candela
