// The readers of the conventions of camera files, which all throw Error at the place of what is wrong.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "load/node.h"
#include "load/quote.h"
#include "scene/scene.h"

namespace candela {

// The value of a key: a camera's own, or that of all cameras.
inline std::optional<Node> find_shared(const Node& own, const Node& all, std::string_view key) {
    const auto found = own.find(key);
    return found ? found : all.find(key);
}

// NeRF's transforms.json. A picture whose size is not in the file has `size` pixels.
std::vector<Camera> read_transforms(const Node& root, uvec2 size);

// The K, R and t of OpenCV.
std::vector<Camera> read_opencv(const Node& root);

}  // namespace candela
