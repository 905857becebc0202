// A glTF file in which everything moves that can, beside a mesh that does not.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "unit/load/gltf/gltf_fixture.h"

namespace candela {

// From 0 s to 1 s: "spin" turns by 90 degrees about +z; "morph" grows; "strip" bends at a joint; "blink" is,
// with the node below it, hidden from 0.5 s on, and is moved there; "pop" grows from a point; "eye" is a
// camera that moves. "still", of SIDE x SIDE squares, does not move.
inline GltfFile moving_file() {
    constexpr uint32_t SIDE = 4;
    GltfFile file;
    const size_t corner = file.add_corner();
    const Json triangle = {{"attributes", {{"POSITION", corner}}}, {"material", 0}};
    file.push("materials", {{"doubleSided", true}});
    std::vector<float> places;
    std::vector<uint32_t> corners;
    for (uint32_t i = 0; i < (SIDE + 1) * (SIDE + 1); ++i)
        places.insert(places.end(), {float(i % (SIDE + 1)) - 2, -1.0f, float(i / (SIDE + 1)) - 2});
    for (uint32_t i = 0; i < SIDE * (SIDE + 1); ++i) {
        const uint32_t above = i + SIDE + 1;
        if (i % (SIDE + 1) < SIDE) corners.insert(corners.end(), {i, above, i + 1, i + 1, above, above + 1});
    }
    file.show({{"attributes", {{"POSITION", file.add("VEC3", places)}}},
               {"indices", file.add("SCALAR", corners)},
               {"material", 0}},
              {{"name", "still"}});
    const size_t spin = file.show(triangle, {{"name", "spin"}, {"translation", {-1, 0, 0}}});
    const size_t offsets = file.add<float>("VEC3", {0, 0, 0, 0, 0, 0, 0, 1, 0});
    Json morphing = triangle;
    morphing["targets"] = {{{"POSITION", offsets}}};
    const size_t morph = file.show(morphing, {{"name", "morph"}, {"weights", {0}}});
    const size_t tip = file.push("nodes", {{"name", "tip"}, {"translation", {0, 0.5, 0}}});
    const size_t base =
        file.push("nodes", {{"name", "base"}, {"translation", {1, 0, 0}}, {"children", {tip}}});
    file.push("skins", {{"joints", {base, tip}}});
    Json skinned = triangle;
    skinned["attributes"]["JOINTS_0"] = file.add<uint8_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
    skinned["attributes"]["WEIGHTS_0"] = file.add<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    const size_t strip = file.show(skinned, {{"name", "strip"}, {"skin", 0}});
    const size_t below = file.show(triangle);
    const size_t blink =
        file.push("nodes", {{"name", "blink"}, {"translation", {0, -1, 0}}, {"children", {below}}});
    const size_t pop = file.show(triangle, {{"name", "pop"}, {"translation", {0.5, -1, 0}}});
    file.push("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"aspectRatio", 1}}}});
    const size_t eye = file.push("nodes", {{"name", "eye"}, {"camera", 0}, {"translation", {0, 0, 5}}});
    file.push("scenes", {{"nodes", {0, spin, morph, base, strip, blink, pop, eye}}});

    const size_t whole = file.add<float>("SCALAR", {0, 1}), halves = file.add<float>("SCALAR", {0, 0.5f});
    Json samplers = Json::array(), channels = Json::array();
    const auto animate = [&](const Json& target, size_t times, size_t values, const char* kind = "LINEAR") {
        channels.push_back({{"sampler", samplers.size()}, {"target", target}});
        samplers.push_back({{"input", times}, {"output", values}, {"interpolation", kind}});
    };
    const size_t turn = file.add<float>("VEC4", {0, 0, 0, 1, 0, 0, float(ROOT), float(ROOT)});
    animate({{"node", spin}, {"path", "rotation"}}, whole, turn);
    animate({{"node", morph}, {"path", "weights"}}, whole, file.add<float>("SCALAR", {0, 1}));
    animate({{"node", tip}, {"path", "rotation"}}, whole, turn);
    animate({{"node", blink}, {"path", "translation"}}, halves, file.add<float>("VEC3", {0, -1, 0, 0, 50, 0}),
            "STEP");
    const std::string pointer = "/nodes/" + std::to_string(blink) + "/extensions/KHR_node_visibility/visible";
    animate({{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}},
            halves, file.add<uint8_t>("SCALAR", {1, 0}), "STEP");
    animate({{"node", pop}, {"path", "scale"}}, whole, file.add<float>("VEC3", {0, 0, 0, 1, 1, 1}));
    animate({{"node", eye}, {"path", "translation"}}, whole, file.add<float>("VEC3", {0, 0, 5, 1, 0, 5}));
    file.push("animations", {{"samplers", samplers}, {"channels", channels}});
    return file;
}

}  // namespace candela
