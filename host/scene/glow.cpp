// Radiances are luminances here.
#include "scene/glow.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/color.h"
#include "scene/geometry.h"

namespace candela {
namespace {

using std::numbers::pi;

// Properties of an image of emission.
struct ImageGlow {
    vec3 mean{0};         // In linear light.
    double bright = 0.0;  // Fraction of texels that are not black.
};

ImageGlow glow_of(const TexelImage& image, TextureEncoding encoding) {
    constexpr float BLACK = 0.05f;            // Codes up to this may be noise of compression.
    constexpr size_t MAX = size_t{1} << 16u;  // Texels, spread over the image.
    const size_t count = size_t(image.size.x) * image.size.y, step = count / MAX + 1;
    dvec3 sum(0.0);
    size_t bright = 0, looks = 0;
    for (size_t i = 0; i < count; i += step, ++looks) {
        vec3 color(texel_codes(image, i));
        bright += any(greaterThan(color, vec3(BLACK)));
        if (encoding == TextureEncoding::srgb && image.type != TexelType::half)
            color = {srgb_decode(color.x), srgb_decode(color.y), srgb_decode(color.z)};
        sum += dvec3(color);
    }
    return {vec3(sum / double(looks)), double(bright) / double(looks)};
}

// The mean length of the path that light leaving p has within the sphere of that radius around the origin;
// its directions are those of a matt surface with the unit normal n.
double mean_way(dvec3 p, dvec3 n, double radius) {
    constexpr int DIRECTIONS = 16;
    constexpr double GOLDEN_ANGLE = 2.399963229728653;
    const dvec3 t = normalize(cross(std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), n));
    const dvec3 b = cross(n, t);
    const double beyond = dot(p, p) - radius * radius;
    double sum = 0.0;
    for (int i = 0; i < DIRECTIONS; ++i) {
        // Spread evenly over the unit disk below the hemisphere.
        const double square = (i + 0.5) / DIRECTIONS, r = std::sqrt(square);
        const dvec3 w = r * std::cos(i * GOLDEN_ANGLE) * t + r * std::sin(i * GOLDEN_ANGLE) * b +
                        std::sqrt(1.0 - square) * n;
        const double along = dot(w, p);
        sum += std::max(0.0, std::sqrt(std::max(0.0, along * along - beyond)) - along);
    }
    return sum / DIRECTIONS;
}

class GlowMeter {
  public:
    GlowMeter(const Scene& scene, double bright) : scene_(scene), bright_(bright) {
        constexpr uint64_t MAX = uint64_t{1} << 18u;  // Triangles.
        step_ = triangle_count(scene) / MAX + 1;
        const DoubleBox box = bounds(scene);
        center_ = box.centroid();
        radius_ = 0.5 * length(box.extent());
    }

    Glow measure() {
        for (const Shape& shape : scene_.shapes) {
            if (const auto* instance = std::get_if<MeshInstance>(&shape.geometry)) add(shape, *instance);
        }
        const double volume = 4.0 / 3.0 * pi * radius_ * radius_ * radius_;
        if (volume > 0.0) glow_.radiance = sent_ / (4.0 * pi * volume);
        if (area_ > 0.0) glow_.area = bright_area_ / area_;
        return glow_;
    }

  private:
    void add(const Shape& shape, const MeshInstance& instance) {
        const TriangleMesh& mesh = scene_.meshes[instance.mesh];
        ImageGlow image{vec3(1.0f), 1.0};
        vec3 factor(0.0f);
        if (shape.emission) {
            factor = shape.emission->radiance.factor;
            if (const auto& texture = shape.emission->radiance.texture) image = image_glow(*texture);
        }
        const double radiance = double(luminance(factor * image.mean));
        if (radiance > 0.0 && any(greaterThan(factor, vec3(1.0f)))) glow_.above_white = true;
        const double bright = double(luminance(factor)) >= bright_ ? image.bright : 0.0;
        for (; next_ < mesh.triangles.size(); next_ += step_) {
            const uvec3 t = mesh.triangles[next_];
            const auto corner = [&](glm::length_t i) {
                return instance.transform.point(mesh.origin + dvec3(mesh.positions[t[i]])) - center_;
            };
            const dvec3 a = corner(0), b = corner(1), c = corner(2);
            dvec3 n = cross(b - a, c - a);
            const double size = length(n);
            if (!(size > 0.0) || !std::isfinite(size)) continue;
            const double area = 0.5 * double(step_) * size;
            area_ += area;
            bright_area_ += bright * area;
            if (radiance == 0.0) continue;
            n *= (instance.transform.mirrors() ? -1.0 : 1.0) / size;
            double way = mean_way((a + b + c) / 3.0, n, radius_);
            if (shape.emission->two_sided) way += mean_way((a + b + c) / 3.0, -n, radius_);
            sent_ += pi * radiance * area * way;
        }
        next_ -= mesh.triangles.size();
    }

    const ImageGlow& image_glow(const Texture& texture) {
        const auto [known, is_new] = images_.try_emplace(texture.image);
        if (is_new) known->second = glow_of(*scene_.images[texture.image].image, texture.encoding);
        return known->second;
    }

    const Scene& scene_;
    double bright_;
    dvec3 center_{0};  // Centre of the sphere around the scene's bounds.
    double radius_ = 0.0;
    uint64_t step_ = 1;  // From one triangle that is looked at to the next, through all shapes.
    uint64_t next_ = 0;  // Index of the next one.
    std::map<uint32_t, ImageGlow> images_;
    double sent_ = 0.0;  // Sum of each ray's flux times its path within the sphere [W m].
    double area_ = 0.0, bright_area_ = 0.0;
    Glow glow_;
};

}  // namespace

Glow glow_of(const Scene& scene, double bright) {
    return GlowMeter(scene, bright).measure();
}

double mean_radiance(const Environment& environment) {
    double sum = 0.0, weights = 0.0;
    for (uint32_t y = 0; y < environment.size.y; ++y) {
        const double weight =
            std::cos(pi * y / environment.size.y) - std::cos(pi * (y + 1) / environment.size.y);
        for (uint32_t x = 0; x < environment.size.x; ++x)
            sum += weight * double(luminance(environment.radiance[size_t(y) * environment.size.x + x]));
        weights += weight * environment.size.x;
    }
    return sum / weights;
}

}  // namespace candela
