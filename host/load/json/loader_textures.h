// Values of materials that may come from images.
#pragma once

#include <filesystem>

#include "load/node.h"
#include "scene/scene.h"

namespace candela {

// The file called `name` in `folder`. Throws Error at its place if it is out of reach.
std::filesystem::path find_file(const Node& name, const std::filesystem::path& folder,
                                const FileReach& reach);

// The location of a scene file's images.
struct ImageFolder {
    std::filesystem::path path;  // To which the names of images are relative.
    Scene& scene;                // Gets the images.
};

// Reads a texture; `more_keys` are allowed in addition to its own. Its encoding is `encoding` unless the file
// states another.
Texture read_texture(const Node& node, const ImageFolder& folder, TextureEncoding encoding,
                     std::string_view more_keys = {});

// A colour, each channel in [0, 1], or a texture with such a factor (1 if it has none).
Textured<dvec3> read_reflectance(const Node& node, const ImageFolder& folder);

Textured<vec3> as_floats(const Textured<dvec3>& color);

// A reflectance as floats.
Textured<vec3> read_color(const Node& node, const ImageFolder& folder);

// A number in `range`, or a texture with such a factor (1 if it has none).
Textured<float> read_number(const Node& node, const ImageFolder& folder, Range range);

// A colour, no channel below 0, or a texture with such a factor.
Textured<vec3> read_radiance(const Node& node, const ImageFolder& folder);

NormalMap read_normal_map(const Node& node, const ImageFolder& folder);

BumpMap read_bump_map(const Node& node, const ImageFolder& folder);

// A number in [0, 1], or a texture with such a factor and perhaps a cutoff.
Opacity read_opacity(const Node& node, const ImageFolder& folder);

}  // namespace candela
