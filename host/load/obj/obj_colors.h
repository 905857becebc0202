// The colours of an OBJ file's vertices, in the forms that programs write.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"

namespace candela {

class ObjColors {
  public:
    // Adds the three numbers after the position of index `position`; other positions may have none.
    void add(size_t position, vec3 numbers);

    // Adds the text after `#MRGB`, as ZBrush writes it: for each position, in their order, two hexadecimal
    // digits each of mask, red, green and blue.
    void add_mrgb(std::string_view digits);

    // Linear, one for each of `count` positions, white where a position has none; empty if the file has no
    // colours that can be read. Numbers are codes of sRGB, as Blender, MeshLab and ZBrush write them: from 0
    // to 1, or, if all are whole, from 0 to 255. `warning` gets what is odd but usable.
    std::vector<vec3> linear(size_t count, std::optional<std::string>& warning) const;

  private:
    std::vector<vec3> codes_;  // NaN: none.
    std::vector<vec3> mrgb_;
    float min_ = 0.0f, greatest_ = 0.0f;
    bool whole_ = true;  // All numbers are.
};

}  // namespace candela
