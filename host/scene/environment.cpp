// Checks an image before it lights a scene.
#include "scene/environment.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/printable.h"
#include "image/image_io.h"

namespace candela {
namespace {

constexpr uint64_t MAX_TEXELS = uint64_t(1) << 26;

// "40x20", for messages.
std::string format_size(uint32_t width, uint32_t height) {
    return std::to_string(width) + 'x' + std::to_string(height);
}

void check_complete(const Image& image, const std::string& file) {
    if (image.data == PixelRect{0, 0, image.full.x, image.full.y}) return;
    throw Error(file + ": the environment must be complete, but the file holds only " +
                format_size(image.data.width(), image.data.height()) + " of its picture's " +
                format_size(image.full.x, image.full.y) + " pixels; write all of it");
}

RgbPlanes find_colours(const Image& image, const std::string& file) {
    if (const std::optional<RgbPlanes> rgb = image.find_rgb()) return *rgb;
    if (const Channel* grey = image.find("Y")) return {grey->values, grey->values, grey->values};
    std::vector<std::string> names;
    for (const Channel& channel : image.channels)
        names.push_back(channel.name);
    throw Error(file + ": an environment needs the channels R, G and B, or Y, but the file has " +
                joined(names) + "; write it with one of these");
}

// Whether any channel is negative or not finite; the others cannot be trusted then.
bool is_unusable(vec3 radiance) {
    for (int c = 0; c < 3; ++c) {
        if (!std::isfinite(radiance[c]) || radiance[c] < 0.0f) return true;
    }
    return false;
}

// "3 of 2048 texels are negative or not finite, and are treated as black"
std::string describe_unusable(size_t count, size_t texels) {
    return std::to_string(count) + " of " + std::to_string(texels) +
           (count == 1 ? " texels is negative or not finite, and is treated as black"
                       : " texels are negative or not finite, and are treated as black");
}

}  // namespace

dvec3 latitude_longitude_direction(glm::dvec2 uv) {
    const double theta = uv.y * double(PI);              // From +Y.
    const double phi = (uv.x - 0.5) * 2.0 * double(PI);  // From -Z to +X.
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

dvec3 paper_radiance(const Environment& environment) {
    const uvec2 size = environment.size;
    dvec3 sum(0.0);
    for (uint32_t y = 0; y < size.y / 2; ++y) {
        // Integral of cos(theta) / pi over a texel.
        const double s0 = std::sin(double(PI) * y / size.y), s1 = std::sin(double(PI) * (y + 1) / size.y);
        for (uint32_t x = 0; x < size.x; ++x)
            sum += (s1 * s1 - s0 * s0) / size.x * dvec3(environment.radiance[size_t{y} * size.x + x]);
    }
    return sum;
}

Environment load_environment(const std::filesystem::path& file, const FileReach& reach,
                             std::vector<std::string>& warnings) {
    const std::string name = file.string();
    const Image image =
        decode_image(reach.read(file), file, {.max_pixels = MAX_TEXELS, .channels = {"R", "G", "B", "Y"}});
    check_complete(image, name);
    const RgbPlanes colours = find_colours(image, name);

    Environment environment;
    environment.size = image.full;
    environment.radiance.assign(image.pixel_count(), vec3(0.0f));
    size_t unusable = 0;
    for (size_t i = 0; i < environment.radiance.size(); ++i) {
        const vec3 radiance(colours[0][i], colours[1][i], colours[2][i]);
        if (is_unusable(radiance)) {
            ++unusable;
        } else {
            environment.radiance[i] = radiance;
        }
    }
    if (unusable > 0) {
        warnings.push_back(name + ": " + describe_unusable(unusable, environment.radiance.size()));
    }
    if (image.full.x != 2 * image.full.y) {
        warnings.push_back(name + ": the environment has " + format_size(image.full.x, image.full.y) +
                           " texels, not twice as many across as down; it is stretched over the sphere");
    }
    if (std::ranges::all_of(environment.radiance, [](vec3 radiance) { return radiance == vec3(0.0f); })) {
        warnings.push_back(name + ": the environment is black everywhere: it gives no light");
    }
    return environment;
}

}  // namespace candela
