// The keys of scene files and the limits of their numbers: scene_keys.inc as a table.
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "base/limits.h"
#include "load/node.h"
#include "scene/scene.h"
#include "scene/sky.h"

namespace candela {

struct SceneKey {
    std::string_view object;
    std::string_view name;
    std::string_view initial;
    double min = 0.0;  // Of a number.
    double max = 0.0;

    Range range() const { return {float(min), float(max)}; }
};

inline constexpr auto SCENE_KEYS = std::to_array<SceneKey>({
#define NUMBER(object, name, min, max, initial, text) {#object, #name, initial, double(min), double(max)},
#define INTEGER(object, name, min, max, initial, text) {#object, #name, initial, double(min), double(max)},
#define CHOICE(object, name, names, initial, text) {#object, #name, initial},
#define KEY(object, name, initial, text) {#object, #name, initial},
#include "load/json/scene_keys.inc"
#undef NUMBER
#undef INTEGER
#undef CHOICE
#undef KEY
});

// The line of a key. A key without one does not compile.
consteval SceneKey scene_key(std::string_view object, std::string_view name) {
    return *std::ranges::find_if(
        SCENE_KEYS, [&](const SceneKey& key) { return key.object == object && key.name == name; });
}

// The names of the keys of these objects, for Node::allow_only.
inline std::vector<std::string_view> keys_of(std::initializer_list<std::string_view> objects) {
    std::vector<std::string_view> names;
    for (const std::string_view object : objects) {
        for (const SceneKey& key : SCENE_KEYS)
            if (key.object == object) names.push_back(key.name);
    }
    return names;
}

// The whole number of a key, within its limits.
inline uint32_t read_integer(const Node& node, const SceneKey& key) {
    return node.integer(uint32_t(key.min), uint32_t(key.max));
}

// The same for any number.
inline float read_number(const Node& node, const SceneKey& key) {
    return node.number(float(key.min), float(key.max));
}

}  // namespace candela
