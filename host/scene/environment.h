// Light from infinitely far away, from an image file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace candela {

// The unit direction that a place in the picture of an Environment without rotation stands for: u to the
// right, v downwards, both in [0, 1].
dvec3 latitude_longitude_direction(glm::dvec2 uv);

// Loads a latitude-longitude map from an OpenEXR or Radiance file (.exr, .hdr, .pic): the channels R, G and B
// as radiance [W/(m^2 sr)] in linear Rec.709, or Y for all three where they are missing; other channels are
// ignored. Rotation and visibility stay at their defaults. A texel with a channel that is negative or not
// finite becomes black. For such texels, a shape other than 2:1 and an image without any light, appends a
// text to `warnings` that begins with the file's name. Throws Error if the file cannot be read, lacks these
// channels, is a crop of a larger picture or has more than 2^26 texels.
Environment load_environment(const std::filesystem::path& file, const FileReach& reach,
                             std::vector<std::string>& warnings);

}  // namespace candela
