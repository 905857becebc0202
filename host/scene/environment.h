// Light from infinitely far away, from an image file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace candela {

// The unit direction of a place in the picture of an Environment without rotation: u to the right, v
// downwards, both in [0, 1].
dvec3 latitude_longitude_direction(glm::dvec2 uv);

// The radiance of white paper that lies in the light of a map's upper half.
dvec3 paper_radiance(const Environment& environment);

// Loads a latitude-longitude map from an OpenEXR or Radiance file (.exr, .hdr, .pic): the channels R, G and B
// as radiance [W/(m^2 sr)] in linear Rec.709, or Y for all three if they are missing; other channels are
// ignored. Rotation and visibility keep their defaults. A texel with a negative or non-finite channel becomes
// black. `warnings` gets texts, beginning with the file's name, about such texels, a shape other than 2:1,
// and an image without any light. Throws Error if the file cannot be read, lacks these channels, is a crop of
// a larger picture or has more than 2^26 texels.
Environment load_environment(const std::filesystem::path& file, const FileReach& reach,
                             std::vector<std::string>& warnings);

}  // namespace candela
