// The tracer's materials: Lambert, GGX metal by visible normals, smooth glass. Local frame, z along the
// shading normal on the viewer's side.
#pragma once

#include <algorithm>
#include <cmath>

#include "tracer_scene.h"

namespace candela::bench {

inline constexpr float INV_PI = 1.0f / PI;

// Columns of a rotation from the local frame to the world.
// Ref: Duff et al. 2017, Building an Orthonormal Basis, Revisited.
struct Frame {
    explicit Frame(vec3 n) : z(n) {
        const float sign = std::copysign(1.0f, n.z), a = -1.0f / (sign + n.z), b = n.x * n.y * a;
        x = vec3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
        y = vec3(b, sign + n.y * n.y * a, -n.y);
    }
    vec3 to_local(vec3 w) const { return vec3(dot(w, x), dot(w, y), dot(w, z)); }
    vec3 to_world(vec3 w) const { return w.x * x + w.y * y + w.z * z; }

    vec3 x, y, z;
};

struct BsdfValue {
    vec3 f{0};         // Without the cosine [1/sr].
    float pdf = 0.0f;  // [1/sr]
};

struct BsdfSample {
    vec3 wi{0};
    vec3 weight{0};    // f cos / pdf; 0 ends the path.
    float pdf = 0.0f;  // [1/sr]; 0 for glass, which has no density.
    float eta = 1.0f;  // Index of refraction behind the surface over that in front, if wi goes through.
};

// Smith's Lambda of the GGX distribution.
// Ref: Heitz 2014, Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs, equation 72.
inline float smith_lambda(float alpha, float cosine) {
    const float tan2 = (1.0f - cosine * cosine) / (cosine * cosine);
    return 0.5f * (std::sqrt(1.0f + alpha * alpha * tan2) - 1.0f);
}

// Ref: Heitz 2014, equations 71 and 99; Schlick 1994, An Inexpensive BRDF Model for Physically-based
// Rendering.
inline BsdfValue metal_value(const Surface& metal, vec3 wo, vec3 wi) {
    if (wo.z <= 0.0f || wi.z <= 0.0f) return {};
    const vec3 h = normalize(wo + wi);
    const float alpha2 = metal.parameter * metal.parameter, k = h.z * h.z * (alpha2 - 1.0f) + 1.0f;
    const float d = alpha2 / (PI * k * k);
    const float lambda_o = smith_lambda(metal.parameter, wo.z),
                lambda_i = smith_lambda(metal.parameter, wi.z);
    const float x = 1.0f - dot(wo, h), x2 = x * x;
    const vec3 fresnel = metal.colour + (1.0f - metal.colour) * (x2 * x2 * x);
    return {fresnel * (d / ((1.0f + lambda_o + lambda_i) * 4.0f * wo.z * wi.z)),
            d / ((1.0f + lambda_o) * 4.0f * wo.z)};
}

// Ref: Heitz 2018, Sampling the GGX Distribution of Visible Normals.
inline BsdfSample metal_sample(const Surface& metal, vec3 wo, Random& random) {
    if (wo.z <= 0.0f) return {};
    const float alpha = metal.parameter;
    const vec3 stretched = normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
    const float across = stretched.x * stretched.x + stretched.y * stretched.y;
    const vec3 t1 = across > 0.0f ? vec3(-stretched.y, stretched.x, 0.0f) / std::sqrt(across) : vec3(1, 0, 0);
    const vec3 t2 = cross(stretched, t1);
    const float r = std::sqrt(random.number()), phi = 2.0f * PI * random.number();
    const float a = r * std::cos(phi), s = 0.5f * (1.0f + stretched.z);
    const float b = (1.0f - s) * std::sqrt(1.0f - a * a) + s * r * std::sin(phi);
    const vec3 n = a * t1 + b * t2 + std::sqrt(std::max(0.0f, 1.0f - a * a - b * b)) * stretched;
    const vec3 h = normalize(vec3(alpha * n.x, alpha * n.y, std::max(1e-6f, n.z)));
    const vec3 wi = 2.0f * dot(wo, h) * h - wo;
    const BsdfValue value = metal_value(metal, wo, wi);
    if (value.pdf <= 0.0f) return {};
    return {wi, value.f * (wi.z / value.pdf), value.pdf};
}

inline BsdfSample diffuse_sample(const Surface& diffuse, Random& random) {
    const float u = random.number(), phi = 2.0f * PI * random.number();
    const float r = std::sqrt(u), z = std::sqrt(1.0f - u);
    return {vec3(r * std::cos(phi), r * std::sin(phi), z), diffuse.colour, z * INV_PI};
}

// Reflection or refraction, by Fresnel's equations; `eta` is the index of refraction on the other side over
// that on the viewer's. Radiance towards the viewer is divided by eta^2.
inline BsdfSample glass_sample(float eta, vec3 wo, Random& random) {
    if (wo.z <= 0.0f) return {};
    const float sin2 = (1.0f - wo.z * wo.z) / (eta * eta);
    const float cos_t = std::sqrt(std::max(0.0f, 1.0f - sin2));
    const float parallel = (eta * wo.z - cos_t) / (eta * wo.z + cos_t);
    const float perpendicular = (wo.z - eta * cos_t) / (wo.z + eta * cos_t);
    const float reflected = sin2 < 1.0f ? 0.5f * (parallel * parallel + perpendicular * perpendicular) : 1.0f;
    if (random.number() < reflected) return {vec3(-wo.x, -wo.y, wo.z), vec3(1), 0.0f};
    return {vec3(-wo.x / eta, -wo.y / eta, -cos_t), vec3(1.0f / (eta * eta)), 0.0f, eta};
}

inline BsdfValue bsdf_value(const Surface& surface, vec3 wo, vec3 wi) {
    if (surface.model == Model::metal) return metal_value(surface, wo, wi);
    return {surface.colour * INV_PI, wi.z * INV_PI};
}

}  // namespace candela::bench
