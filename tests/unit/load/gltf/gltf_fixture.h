// What the tests of glTF files share: files that are built part by part, and what becomes of them.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "load/gltf/gltf.h"
#include "unit/load/scene_fixture.h"

namespace candela {

using Json = nlohmann::json;

inline constexpr double ROOT = 0.70710678118654752;  // The root of 1/2.

// The number of a component type.
template <class T>
constexpr int component_type() {
    if constexpr (std::is_same_v<T, int8_t>) return 5120;
    if constexpr (std::is_same_v<T, uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, int16_t>) return 5122;
    if constexpr (std::is_same_v<T, uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, uint32_t>) return 5125;
    if constexpr (std::is_same_v<T, float>) return 5126;
    return 0;
}

inline size_t width_of(const std::string& type) {
    if (type == "SCALAR") return 1;
    return type == "MAT4" ? 16 : size_t(type.back() - '0');
}

inline std::string base64(const std::string& bytes) {
    constexpr const char* DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : DIGITS[bits >> (18 - 6 * k) & 63u];
    }
    return text;
}

inline std::string little_endian(uint32_t word) {
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &word, 4);
    return bytes;
}

inline std::string glb_chunk(const char* type, const std::string& bytes) {
    return little_endian(uint32_t(bytes.size())) + std::string(type, 4) + bytes;
}

inline std::string glb_of(const std::string& chunks, uint32_t version = 2) {
    return "glTF" + little_endian(version) + little_endian(uint32_t(12 + chunks.size())) + chunks;
}

// A file in the making: its JSON document, and the bytes of its first buffer.
struct GltfFile {
    Json root = {{"asset", {{"version", "2.0"}}}};
    std::string bytes{};

    // Appends to a top-level array; returns the index.
    size_t push(const char* array, const Json& element) {
        root[array].push_back(element);
        return root[array].size() - 1;
    }

    // Adds numbers as a bufferView.
    template <class T>
    size_t add_view(const std::vector<T>& numbers) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        const size_t offset = bytes.size(), size = numbers.size() * sizeof(T);
        bytes.append(reinterpret_cast<const char*>(numbers.data()), size);
        return push("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    }

    // Adds numbers as a bufferView and an accessor of it, with these further keys.
    template <class T>
    size_t add(const std::string& type, const std::vector<T>& numbers, const Json& more = Json::object()) {
        Json accessor = {{"bufferView", add_view(numbers)},
                         {"componentType", component_type<T>()},
                         {"count", numbers.size() / width_of(type)},
                         {"type", type}};
        accessor.update(more);
        return push("accessors", accessor);
    }
    size_t add_normalized(const std::string& type, const auto& numbers) {
        return add(type, numbers, {{"normalized", true}});
    }

    // Adds a mesh of one primitive, and a node with it and these further keys; returns the node's index.
    size_t show(const Json& primitive, const Json& node = Json::object()) {
        Json all = {{"mesh", push("meshes", {{"primitives", Json::array({primitive})}})}};
        all.update(node);
        return push("nodes", all);
    }

    // Adds the positions of a triangle in the plane z = 0 with a right angle at the origin.
    size_t add_corner() { return add<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}); }
    // Shows that triangle in a node with these keys; returns the node's index.
    size_t show_corner(const Json& node = Json::object()) {
        return show({{"attributes", {{"POSITION", add_corner()}}}}, node);
    }

    // The document with this key of its buffer, unless it states buffers itself or has no bytes.
    std::string document(const Json& uri = nullptr) const {
        Json all = root;
        if (!bytes.empty() && !all.contains("buffers")) {
            all["buffers"] = Json::array({{{"byteLength", bytes.size()}}});
            if (!uri.is_null()) all["buffers"][0]["uri"] = uri;
        }
        return all.dump();
    }
    std::string gltf() const { return document("data:application/octet-stream;base64," + base64(bytes)); }
    std::string glb() const {
        std::string text = document(), binary = bytes;
        text.resize((text.size() + 3) / 4 * 4, ' ');
        binary.resize((binary.size() + 3) / 4 * 4);
        return glb_of(glb_chunk("JSON", text) + (bytes.empty() ? "" : glb_chunk("BIN\0", binary)));
    }
};

// A file that shows the triangle of add_corner().
inline GltfFile corner_file(const Json& node = Json::object()) {
    GltfFile file;
    file.show_corner(node);
    return file;
}

class Gltf : public testing::Test {
  protected:
    // The scene of a file that is written to m.gltf, without the camera and the light that it may lack.
    Scene load_text(const std::string& text, const GltfOptions& options = {},
                    const std::string& name = "m.gltf") {
        folder_.write(name, text);
        Scene scene;
        scene.reach = FileReach(folder_.path() / name);
        GltfFiles files;
        add_gltf_scene(folder_.path() / name, options, scene, no_progress, files);
        return scene;
    }
    Scene load(const GltfFile& file, const GltfOptions& options = {}) {
        return load_text(file.gltf(), options);
    }

    void expect_text_error(const std::string& text, const std::string& message,
                           const std::string& name = "m.gltf", const GltfOptions& options = {}) {
        SCOPED_TRACE(text);
        EXPECT_EQ(folder_.without_folder(error_of([&] { load_text(text, options, name); })), message);
    }
    // The message after the name of the file.
    void expect_error(const GltfFile& file, const std::string& message, const GltfOptions& options = {}) {
        expect_text_error(file.gltf(), "m.gltf" + message, "m.gltf", options);
    }

    // Loads a file about which there is one warning, which this is after the name of the file.
    Scene expect_warning(const GltfFile& file, const std::string& message, const GltfOptions& options = {}) {
        SCOPED_TRACE(file.root.dump());
        const Scene scene = load(file, options);
        EXPECT_EQ(scene.warnings.size(), 1u);
        if (!scene.warnings.empty()) {
            EXPECT_EQ(folder_.without_folder(scene.warnings[0]), "m.gltf" + message);
        }
        return scene;
    }

    SceneFolder folder_;
};

}  // namespace candela
