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
    uint64_t line = 0;             // Line of newmtl.
    bool by_blender = false;       // The file says that Blender wrote it.
    std::optional<glm::dvec3> ka;  // Finite and >= 0, as are all colours.
    std::optional<glm::dvec3> kd;
    std::optional<glm::dvec3> ks;
    std::optional<glm::dvec3> ke;  // [W/(m^2 sr)].
    std::optional<glm::dvec3> tf;
    std::optional<double> ns;  // >= 0.
    std::optional<double> ni;
    uint32_t illum = 2;  // 0 .. 10.
    std::optional<double> d;
    std::optional<double> tr;
    std::optional<double> pr;  // Roughness, in [0, 1], as are the following.
    std::optional<double> pm;  // Metalness.
    std::optional<double> ps;  // Sheen.
    std::optional<double> pc;  // Coat, and its roughness.
    std::optional<double> pcr;
    // map_Kd, map_Ks, map_Ke, map_Ns, map_d, map_Pr, map_Pm, norm and bump.
    std::map<std::string, MtlTexture, std::less<>> textures;
};

// An image that a statement names.
struct MtlImage {
    std::filesystem::path folder;  // Folder of the library.
    std::string file;              // As the library names it, with slashes.
    std::string place;             // Place of the statement, as `file:line`.
};

// A warning, shown only if the material is used.
struct MtlWarning {
    std::string kind;  // Warnings of the same kind are counted together.
    std::string text;  // `file:line: ...`.
};

// What one `newmtl` describes.
struct MtlMaterial {
    Material material;                 // It has its name in the file.
    Textured<vec3> emission{vec3(0)};  // Ke [W/(m^2 sr)].
    std::vector<MtlImage> images{};    // Texture::image is an index into these until add_images().
    std::vector<MtlWarning> warnings{};
};

// The material that statements describe; docs/mtl.md says which, and why. `file` is the file's name in
// messages; `ignored` gets the statements that the material does not use.
// Ref: Alias|Wavefront, "MTL material format" (1995); Exocortex, "PBR extension to MTL" (2014).
MtlMaterial mtl_material(const MtlStatements& statements, const std::string& file, MtlIgnored& ignored);

// Adds the images of a material to the scene, so that its textures look them up there. One that is missing or
// out of reach is white unless the user wants an error.
void add_images(MtlMaterial& material, Scene& scene);

}  // namespace candela
