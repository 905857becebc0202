// Ref: EXT_lights_image_based; OpenGL 4.6 Specification, section 8.13, for the faces of a cube.
#include "load/gltf/image_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "base/color.h"
#include "base/error.h"
#include "base/text.h"
#include "image/texel_io.h"
#include "load/gltf/uri.h"
#include "load/gltf/values.h"
#include "scene/environment.h"

namespace candela::gltf {
namespace {

constexpr size_t FACES = 6;
constexpr uint32_t MAX_LINES = 2048;  // The most rows of the environment.

// Radiance of one face, row-major from the top.
struct Face {
    uint32_t size = 0;
    std::vector<vec3> radiance;

    vec3 at(int x, int y) const {
        const int last = int(size) - 1;
        return radiance[size_t(std::clamp(y, 0, last)) * size + size_t(std::clamp(x, 0, last))];
    }
    // Interpolated linearly between texels; u to the right and v downwards, in [0, 1].
    vec3 look_up(double u, double v) const {
        const double x = u * size - 0.5, y = v * size - 0.5;
        const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
        const auto fx = float(x - x0), fy = float(y - y0);
        return mix(mix(at(x0, y0), at(x0 + 1, y0), fx), mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), fx), fy);
    }
};

// The bytes of an element of the file's images.
std::string image_bytes(File& file, const Node& reference) {
    const Node image = file.resolve("images", reference);
    if (const auto view = image.find("bufferView")) {
        const std::span<const std::byte> bytes = file.view_bytes(file.resolve("bufferViews", *view));
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    const Node uri = image.require("uri");
    if (auto data = inline_data(uri)) return std::move(*data);
    return file.read_named(uri);
}

// If there is an alpha, RGBD: the colour divided by alpha.
Face read_face(File& file, const Node& reference) {
    std::vector<std::string> warnings;
    const TexelImage image =
        decode_texels(image_bytes(file, reference), reference.place(), warnings, {.formats = "PNG or JPEG"});
    if (image.size.x != image.size.y)
        reference.fail(concat("the face of a cube must be square, not ", image.size.x, " by ", image.size.y));
    // No more texels than the environment shows; each is the mean of the original texels that it replaces.
    const uint32_t size = std::min(image.size.x, MAX_LINES / 2);
    Face face{.size = size, .radiance = std::vector<vec3>(size_t{size} * size)};
    std::vector<uint32_t> counts(face.radiance.size());
    const auto place = [&](size_t i) { return i * size / image.size.x; };
    for (size_t i = 0; i < size_t{image.size.x} * image.size.y; ++i) {
        constexpr float MIN = 1.0f / 255.0f;
        const vec4 codes = texel_codes(image, i);
        const vec3 color(srgb_decode(codes.x), srgb_decode(codes.y), srgb_decode(codes.z));
        const size_t texel = place(i / image.size.x) * size + place(i % image.size.x);
        face.radiance[texel] += color / std::max(codes.w, MIN);
        ++counts[texel];
    }
    for (size_t i = 0; i < counts.size(); ++i)
        face.radiance[i] /= float(counts[i]);
    return face;
}

// The radiance towards the viewer from direction w of the cube. Seen from its middle, the images are upright
// and not mirrored.
vec3 cube_radiance(const std::array<Face, FACES>& faces, dvec3 w) {
    const dvec3 size = abs(w);
    const glm::length_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const bool negative = w[axis] < 0.0;
    const double sign = negative ? -1.0 : 1.0;
    // To the right of the image and downwards.
    const glm::dvec2 across = axis == 0   ? glm::dvec2(sign * w.z, -w.y)
                              : axis == 1 ? glm::dvec2(-w.x, sign * w.z)
                                          : glm::dvec2(-sign * w.x, -w.y);
    const glm::dvec2 uv = 0.5 * across / size[axis] + 0.5;
    return faces[2 * size_t(axis) + (negative ? 1 : 0)].look_up(uv.x, uv.y);
}

// The environment that a light's cube map makes.
Environment sky_of(File& file, const Node& light, float intensity) {
    const Node level = light.require("specularImages")[0];
    std::array<Face, FACES> faces;
    for (size_t i = 0; i < FACES; ++i)
        faces[i] = read_face(file, level[i]);

    glm::dquat rotation(1, 0, 0, 0);
    if (const auto node = light.find("rotation")) {
        const std::vector<double> q = node->numbers(4);
        const glm::dquat given(q[3], q[0], q[1], q[2]);
        if (length(given) > 0.0) rotation = normalize(given);
    }
    Environment environment;
    const uint32_t lines = std::min(2 * faces[0].size, MAX_LINES);
    environment.size = {2 * lines, lines};
    environment.radiance.clear();
    environment.radiance.reserve(2 * size_t(lines) * lines);
    for (uint32_t y = 0; y < lines; ++y) {
        for (uint32_t x = 0; x < 2 * lines; ++x) {
            const dvec3 w = latitude_longitude_direction({(x + 0.5) / (2.0 * lines), (y + 0.5) / lines});
            environment.radiance.push_back(intensity * cube_radiance(faces, inverse(rotation) * w));
        }
    }
    return environment;
}

// Notes that this reading needs the buffer of an image, although its faces may be known already.
void use_buffer(File& file, const Node& reference) {
    const Node image = file.resolve("images", reference);
    if (const auto view = image.find("bufferView")) file.view_bytes(file.resolve("bufferViews", *view));
}

}  // namespace

std::optional<Environment> read_image_light(File& file, const Node& scene) {
    const auto use = extension_of(scene, "EXT_lights_image_based");
    const auto reference = use ? use->find("light") : std::nullopt;
    if (!reference) return std::nullopt;
    const auto extension = extension_of(file.root(), "EXT_lights_image_based");
    const Node lights = extension ? extension->require("lights") : scene;
    const uint32_t index = reference->integer(0, UINT32_MAX);
    if (!extension || index >= lights.size()) reference->fail(concat("there is no light ", index));
    const Node light = lights[index];

    const Node levels = light.require("specularImages");
    if (levels.size() == 0 || levels[0].size() != FACES) levels.fail("a cube needs six images");
    for (const Node& face : levels[0].elements())
        use_buffer(file, face);
    const float intensity = number_of(file, light, "intensity", 0.0f, MAX_LIGHT, 1.0f);
    return file.contents().keep("sky of " + light.place(), [&] { return sky_of(file, light, intensity); });
}

}  // namespace candela::gltf
