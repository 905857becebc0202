// A scene as plain structs, in the units that the renderer uses: metres, radians, linear Rec.709 radiance.
// World space is right-handed with +Y up. Nothing here knows of GPUs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/file_reach.h"
#include "base/math.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/medium.h"
#include "scene/named_arrays.h"
#include "scene/shape.h"
#include "scene/texture.h"

namespace candela {

enum class Estimator { bsdf, light, mis };
enum class SamplerKind { independent, stratified, sobol };
// Where the light on a mesh with smooth normals ends: where its normals turn away from the light, or where
// its triangles do.
enum class Terminator { smooth, flat };
// How a light is chosen for a lit point: each as often as the others, by power, by what it may send there, or
// by the one of the last two that has less noise in equal time.
enum class LightSampler { automatic, uniform, power, tree };

// The scene file's proposals; the command line overrides them.
struct IntegratorSettings {
    uint32_t spp = 64;
    std::optional<uint32_t> max_depth;  // Scattering vertices at most; none: unlimited.
    uint32_t rr_depth = 3;              // The first rr_depth bounces always survive.
    Estimator estimator = Estimator::mis;
    SamplerKind sampler = SamplerKind::sobol;
    LightSampler light_sampler = LightSampler::automatic;
    Terminator terminator = Terminator::smooth;
    uint32_t seed = 0;
    std::optional<float> clamp_indirect{};  // See RenderSettings.
};

// What of a scene changes with time, if it shows a frame of an animation: of its shapes, those from
// first_shape on, as many as `moves` has. Everything fitted to what the scene shows (the frame, a studio,
// views) is fitted to all times.
struct Motion {
    uint32_t first_shape = 0;
    std::vector<bool> moves{};  // Whether the shape moves, deforms, or is hidden at some time.
    DoubleBox still{};          // Around those that do not.
    // Corners of a body that holds the others at all times, but for about 2 % of their extent.
    std::vector<dvec3> ways{};

    bool covers(size_t shape) const { return shape - first_shape < moves.size(); }
    bool moves_shape(size_t shape) const { return covers(shape) && moves[shape - first_shape]; }
};

struct Scene {
    std::vector<Camera> cameras;  // At least one; the first is the default.
    Film film;
    IntegratorSettings integrator;
    std::vector<ImageFile> images;                            // Looked up by textures.
    std::unordered_map<std::string, uint32_t> image_indices;  // By real_path, for images that files name.
    std::vector<Material> materials;
    std::vector<TriangleMesh> meshes;
    std::vector<Shape> shapes;
    std::vector<std::string> objects;          // Names, all different, of what shapes are parts of.
    std::vector<Light> lights;                 // Besides shapes that emit and the environment.
    std::optional<Environment> environment;    // None: black.
    Medium medium{};                           // Where no solid is.
    std::optional<uint32_t> ground{};          // A shape that was added below the others; views ignore it.
    std::optional<Motion> motion;              // Only of a scene that shows a frame of an animation.
    FileReach reach;                           // The files that may be read for it.
    const NamedArrays* arrays = nullptr;       // Those that its text may name, while it is loaded.
    std::vector<std::filesystem::path> files;  // Files read in addition to a JSON scene file: meshes,
                                               // materials, images.
    std::vector<std::string> warnings;         // Oddities that the loader could use, each with its place.
    std::vector<std::pair<std::string, std::string>>
        attributes;  // The file's description of itself: name and text.
};

}  // namespace candela
