// Charts of directions: coordinates (a, b) in [0, 1]^2 that spread out a lobe, however narrow, so that cells
// of equal size resolve it. All in double precision, from the formulas of the models.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "base/math.h"

namespace candela {

struct ChartPoint {
    glm::dvec3 w;
    double solid_angle;  // Per area of the chart [sr].
};

// The axes x, y of an orthonormal frame around z.
inline std::pair<glm::dvec3, glm::dvec3> axes_around(glm::dvec3 z) {
    const glm::dvec3 other = std::abs(z.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = normalize(cross(other, z));
    return {x, cross(z, x)};
}

inline double turn_of(double y, double x) {
    return std::atan2(y, x) / (2.0 * M_PI) + 0.5;
}

// The whole sphere, by height and azimuth: equal areas have equal solid angles.
class SphereChart {
  public:
    ChartPoint at(double a, double b) const {
        const double z = 2.0 * a - 1.0, phi = 2.0 * M_PI * (b - 0.5), r = std::sqrt(1.0 - z * z);
        return {{r * std::cos(phi), r * std::sin(phi), z}, 4.0 * M_PI};
    }
    std::optional<glm::dvec2> find(glm::dvec3 w) const {
        return glm::dvec2((w.z + 1.0) / 2.0, turn_of(w.y, w.x));
    }
};

// The cone around an axis that holds SHARE of the density (n + 1) / (2 pi) cos^n, by the distribution
// function and the azimuth.
class LobeChart {
  public:
    LobeChart(glm::dvec3 axis, double n) : z_(axis), n_(n) { std::tie(x_, y_) = axes_around(axis); }
    ChartPoint at(double a, double b) const {
        const double log_cosine = std::log1p(-FRACTION * a) / (n_ + 1.0), h = -std::expm1(log_cosine);
        const double r = std::sqrt(h * (2.0 - h)), phi = 2.0 * M_PI * (b - 0.5);
        return {r * std::cos(phi) * x_ + r * std::sin(phi) * y_ + (1.0 - h) * z_,
                FRACTION * 2.0 * M_PI / (n_ + 1.0) * std::exp(-n_ * log_cosine)};
    }
    // Nothing outside the cone.
    std::optional<glm::dvec2> find(glm::dvec3 w) const {
        const glm::dvec3 chord = w - z_;
        const double h = std::min(0.5 * dot(chord, chord), 1.0);
        const double a = -std::expm1((n_ + 1.0) * std::log1p(-h)) / FRACTION;
        if (a >= 1.0) return std::nullopt;
        return glm::dvec2(a, turn_of(dot(w, y_), dot(w, x_)));
    }

  private:
    static constexpr double FRACTION = 15.0 / 16.0;

    glm::dvec3 x_, y_, z_;
    double n_;
};

// The whole sphere, by azimuth and the angle theta from -z or, if g < 0, from +z: evenly in the logarithm of
// (1 - |g|)^2 + 1 - cos(theta), since the phase function of Henyey and Greenstein changes as that does.
class ForwardChart {
  public:
    explicit ForwardChart(double g)
        : side_(g < 0.0 ? 1.0 : -1.0), least_(square(1.0 - std::abs(g))), range_(std::log1p(2.0 / least_)) {}
    ChartPoint at(double a, double b) const {
        const double h = least_ * std::expm1(a * range_), phi = 2.0 * M_PI * (b - 0.5);
        const double r = std::sqrt(std::max(0.0, h * (2.0 - h)));
        return {{r * std::cos(phi), r * std::sin(phi), side_ * (1.0 - h)},
                2.0 * M_PI * range_ * (least_ + h)};
    }
    std::optional<glm::dvec2> find(glm::dvec3 w) const {
        const glm::dvec3 chord = w - glm::dvec3(0, 0, side_);
        const double h = std::min(0.5 * dot(chord, chord), 2.0);
        return glm::dvec2(std::log1p(h / least_) / range_, turn_of(w.y, w.x));
    }

  private:
    static double square(double x) { return x * x; }

    double side_, least_, range_;
};

// The reflections of wo by microfacets, by the slopes of these. With a = 1 - t^2, slopes of the GGX
// distribution are uniform in a if seen from above; if seen at grazing angles, their density grows at most
// like 1 / t.
class FacetChart {
  public:
    FacetChart(glm::dvec3 wo, double alpha) : wo_(wo), alpha_(alpha) {}
    ChartPoint at(double s, double b) const {
        const auto [h, facets] = facet_at(s, b, alpha_);
        // d(wi) = 4 |wo.h| d(h).
        return {2.0 * dot(wo_, h) * h - wo_, 4.0 * std::abs(dot(wo_, h)) * facets};
    }
    std::optional<glm::dvec2> find(glm::dvec3 w) const { return place_of(normalize(wo_ + w), alpha_); }

    // A facet's normal, and the solid angle of normals per area of the chart.
    static ChartPoint facet_at(double s, double b, double alpha) {
        const double t = 1.0 - s, a = 1.0 - t * t;
        const double r = alpha * std::sqrt(a) / t, phi = 2.0 * M_PI * (b - 0.5);
        const glm::dvec3 h = normalize(glm::dvec3(r * std::cos(phi), r * std::sin(phi), 1.0));
        // d(slopes) = pi alpha^2 / (1 - a)^2 da db; d(h) = h.z^3 d(slopes).
        return {h, M_PI * alpha * alpha / (t * t * t * t) * 2.0 * t * h.z * h.z * h.z};
    }
    static glm::dvec2 place_of(glm::dvec3 h, double alpha) {
        const double r = std::hypot(h.x, h.y) / (alpha * h.z);
        return {1.0 - 1.0 / std::sqrt(1.0 + r * r), turn_of(h.y, h.x)};
    }

  private:
    glm::dvec3 wo_;
    double alpha_;
};

// The same for refraction by facets; eta is the index on the other side over the index on wo's side.
class RefractionChart {
  public:
    RefractionChart(glm::dvec3 wo, double alpha, double eta) : wo_(wo), alpha_(alpha), eta_(eta) {}
    ChartPoint at(double s, double b) const {
        const auto [h, facets] = FacetChart::facet_at(s, b, alpha_);
        const double cos_o = dot(wo_, h);
        const double cos2 = 1.0 - (1.0 - cos_o * cos_o) / (eta_ * eta_);
        // Seen from behind, or total reflection: no light goes in this direction.
        const ChartPoint none{{1.0, 0.0, 0.0}, 0.0};
        if (cos_o <= 0.0 || cos2 <= 0.0) return none;
        const double cos_i = std::sqrt(cos2), sum = cos_o - eta_ * cos_i;
        // Ref: Walter et al. 2007, Microfacet Models for Refraction through Rough Surfaces, equation 17.
        const glm::dvec3 w = (cos_o / eta_ - cos_i) * h - wo_ / eta_;
        return w.z < 0.0 ? ChartPoint{w, facets * sum * sum / (eta_ * eta_ * cos_i)} : none;
    }
    // Nothing for directions into which no facet refracts.
    std::optional<glm::dvec2> find(glm::dvec3 w) const {
        const glm::dvec3 sum = wo_ + eta_ * w;
        const glm::dvec3 h = normalize(sum.z < 0.0 ? -sum : sum);
        if (w.z >= 0.0 || dot(wo_, h) <= 0.0 || dot(w, h) >= 0.0) return std::nullopt;
        return FacetChart::place_of(h, alpha_);
    }

  private:
    glm::dvec3 wo_;
    double alpha_;
    double eta_;
};

}  // namespace candela
