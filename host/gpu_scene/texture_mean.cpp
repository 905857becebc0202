// See texture_mean.h.
#include "gpu_scene/texture_mean.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/color.h"

namespace candela {
namespace {

// Texel i along an axis of n, wherever that is.
uint32_t wrapped(double i, uint32_t n, Wrap wrap) {
    if (wrap == Wrap::clamp) return uint32_t(std::clamp(i, 0.0, n - 1.0));
    const double period = wrap == Wrap::repeat ? n : 2.0 * n;
    const auto within = uint32_t(std::min(i - period * std::floor(i / period), period - 1.0));
    return within < n ? within : 2 * n - 1 - within;
}

using glm::dvec2;

// Convex; in texels.
using Polygon = std::vector<dvec2>;

double extent(const Polygon& polygon, int axis) {
    const auto [min, max] = std::ranges::minmax(polygon, {}, [axis](const dvec2& p) { return p[axis]; });
    return max[axis] - min[axis];
}

double area_of(const Polygon& polygon) {
    double twice = 0.0;
    for (size_t i = 2; i < polygon.size(); ++i) {
        const dvec2 a = polygon[i - 1] - polygon[0], b = polygon[i] - polygon[0];
        twice += a.x * b.y - a.y * b.x;
    }
    return 0.5 * std::abs(twice);
}

// The part of a polygon between two places along an axis.
// Ref: Sutherland and Hodgman 1974, Reentrant Polygon Clipping.
Polygon between(const Polygon& polygon, int axis, double min, double max) {
    Polygon result = polygon;
    for (const double side : {1.0, -1.0}) {
        const double bound = side > 0.0 ? min : -max;
        const Polygon whole = std::exchange(result, {});
        for (size_t i = 0; i < whole.size(); ++i) {
            const dvec2 a = whole[i], b = whole[(i + 1) % whole.size()];
            const double in_a = side * a[axis] - bound, in_b = side * b[axis] - bound;
            if (in_a >= 0.0) result.push_back(a);
            if ((in_a < 0.0) != (in_b < 0.0)) result.push_back(mix(a, b, in_a / (in_a - in_b)));
        }
    }
    return result;
}

// Integrals over a polygon of 1, x, y and x y.
struct Moments {
    double area = 0.0, x = 0.0, y = 0.0, xy = 0.0;
};

// In coordinates of the cell. The mean of a quadratic polynomial over a triangle is the mean of its values
// at the middles of the sides.
Moments moments_of(const Polygon& polygon, const dvec2& cell) {
    Moments m;
    for (size_t i = 2; i < polygon.size(); ++i) {
        const Polygon triangle{polygon[0], polygon[i - 1], polygon[i]};
        const double area = area_of(triangle);
        m.area += area;
        for (size_t k = 0; k < 3; ++k) {
            const dvec2 p = 0.5 * (triangle[k] + triangle[(k + 1) % 3]) - cell;
            m.x += area / 3.0 * p.x;
            m.y += area / 3.0 * p.y;
            m.xy += area / 3.0 * p.x * p.y;
        }
    }
    return m;
}

// Calls add(cell, moments) for each unit square between whole numbers that the polygon meets.
template <class Add>
void for_cells(const Polygon& polygon, const Add& add) {
    const auto cells = [](const Polygon& part, int axis, const auto& visit) {
        if (part.empty()) return;
        const auto [min, max] = std::ranges::minmax(part, {}, [axis](const dvec2& p) { return p[axis]; });
        const double first = std::floor(min[axis]), count = std::floor(max[axis]) - first + 1.0;
        for (double i = 0.0; i < count; ++i)
            visit(first + i);
    };
    cells(polygon, 1, [&](double y) {
        const Polygon row = between(polygon, 1, y, y + 1.0);
        cells(row, 0,
              [&](double x) { add(dvec2(x, y), moments_of(between(row, 0, x, x + 1.0), dvec2(x, y))); });
    });
}

}  // namespace

vec3 texel_color(const TexelImage& image, TextureEncoding encoding, size_t i) {
    const vec4 codes = texel_codes(image, i);
    const vec3 color(codes.x, codes.y, codes.z);
    if (encoding != TextureEncoding::srgb || image.type == TexelType::half) return color;
    return {srgb_decode(color.x), srgb_decode(color.y), srgb_decode(color.z)};
}

ImagePyramid::ImagePyramid(const TexelImage& image, TextureEncoding encoding) {
    Level base{image.size, std::vector<vec3>(size_t(image.size.x) * image.size.y)};
    for (size_t i = 0; i < base.texels.size(); ++i)
        base.texels[i] = texel_color(image, encoding, i);
    levels_.push_back(std::move(base));
    while (levels_.back().texels.size() > 1) {
        const Level& fine = levels_.back();
        Level half{(fine.size + 1u) / 2u, {}};
        for (uint32_t y = 0; y < half.size.y; ++y) {
            for (uint32_t x = 0; x < half.size.x; ++x) {
                vec3 sum(0.0f);
                for (const uvec2 corner : {uvec2(0, 0), uvec2(1, 0), uvec2(0, 1), uvec2(1, 1)}) {
                    const uvec2 at = min(2u * uvec2(x, y) + corner, fine.size - 1u);
                    sum += fine.texels[size_t(at.y) * fine.size.x + at.x];
                }
                half.texels.push_back(0.25f * sum);
            }
        }
        levels_.push_back(std::move(half));
    }
}

vec3 ImagePyramid::texel(const Level& level, const Texture& texture, double x, double y) const {
    return level.texels[size_t(wrapped(y, level.size.y, texture.wrap_v)) * level.size.x +
                        wrapped(x, level.size.x, texture.wrap_u)];
}

vec3 ImagePyramid::mean(const Texture& texture, std::span<const vec2> corners) const {
    constexpr double WIDEST = 16.0;  // In texels of the level that is read.
    Polygon polygon;
    for (const vec2 corner : corners) {
        const dvec3 uv1(corner.x, corner.y, 1.0);
        polygon.emplace_back(dot(dvec3(texture.rows[0]), uv1) * levels_[0].size.x,
                             (1.0 - dot(dvec3(texture.rows[1]), uv1)) * levels_[0].size.y);
    }
    const double width = std::max(extent(polygon, 0), extent(polygon, 1));
    const double number = std::ceil(std::log2(std::max(width / WIDEST, 1.0)));
    if (!(number < double(levels_.size() - 1))) return levels_.back().texels[0];
    const Level& level = levels_[size_t(number)];
    // Between the centres of texels, which are whole numbers here, the texture mixes four. Smaller copies are
    // always mixed, also where the texture takes the nearest texel.
    const bool mixes = number > 0.0 || texture.filter == TextureFilter::bilinear;
    for (dvec2& corner : polygon)
        corner = corner / std::exp2(number) - (mixes ? 0.5 : 0.0);

    dvec3 sum(0.0);
    double area = 0.0;
    const auto add = [&](const dvec2& cell, const Moments& m) {
        const auto add_texel = [&](double x, double y, double weight) {
            sum += std::max(weight, 0.0) * dvec3(texel(level, texture, cell.x + x, cell.y + y));
        };
        area += m.area;
        if (!mixes) return add_texel(0, 0, m.area);
        add_texel(0, 0, m.area - m.x - m.y + m.xy);
        add_texel(1, 0, m.x - m.xy);
        add_texel(0, 1, m.y - m.xy);
        add_texel(1, 1, m.xy);
    };
    if (area_of(polygon) > 1e-6 * width * width) for_cells(polygon, add);
    if (area > 0.0) return vec3(sum / area);
    const double steps = 2.0 * WIDEST;
    for (size_t i = 0; i < polygon.size(); ++i) {
        for (double k = 0.0; k < steps; ++k) {
            const dvec2 p = mix(polygon[i], polygon[(i + 1) % polygon.size()], k / steps), cell = floor(p);
            const dvec2 within = p - cell;
            add(cell, {1.0, within.x, within.y, within.x * within.y});
        }
    }
    return vec3(sum / area);
}

}  // namespace candela
