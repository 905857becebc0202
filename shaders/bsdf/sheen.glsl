// Sheen: cylindrical fibres that stand about the normal. Local frame, z on the viewer's side of the surface.
// Ref: Conty Estevez and Kulla 2017, Production Friendly Microfacet Sheen BRDF; KHR_materials_sheen, which has these
// numbers.
#ifndef BSDF_SHEEN_GLSL
#define BSDF_SHEEN_GLSL

#include "base/exponential.glsl"
#include "base/math.glsl"

// Below this roughness, floats cannot hold the distribution's peak.
const float MIN_SHEEN_ROUGHNESS = 0.07;

float sheen_alpha(float roughness) {
    return square(max(roughness, MIN_SHEEN_ROUGHNESS));
}

// log(1 + Lambda), nearly, for a cosine x of at most 1/2.
float sheen_log_lambda(float x, float alpha) {
    float rest = square(1.0 - alpha);
    float power = exp_nonpositive(mix(0.19823, 0.16801, rest) * log1p_nonpositive(x - 1.0));
    return mix(21.5473, 25.3245, rest) / (1.0 + mix(3.82987, 3.32435, rest) * power) +
           mix(-1.97760, -1.27393, rest) * x + mix(-4.32054, -4.85967, rest);
}

// Lambda of the masking by other fibres, at a cosine in (0, 1], which rounding may have raised above 1.
float sheen_lambda(float x, float alpha) {
    float exponent = x < 0.5 ? sheen_log_lambda(x, alpha)
                             : 2.0 * sheen_log_lambda(0.5, alpha) - sheen_log_lambda(max(1.0 - x, 0.0), alpha);
    float power = exp_nonpositive(-abs(exponent));
    return exponent > 0.0 ? 1.0 / power : power;
}

// The value for a white sheen [1/sr]; both directions above the surface.
float sheen_f(float alpha, vec3 wo, vec3 wi) {
    vec3 h = normalize(wo + wi);
    float inverse = 1.0 / alpha;
    float cos2 = min(square(h.z), 1.0);
    float d = (2.0 + inverse) * (0.5 * INV_PI) * exp_nonpositive(0.5 * inverse * log1p_nonpositive(-cos2));
    return d / ((1.0 + sheen_lambda(wo.z, alpha) + sheen_lambda(wi.z, alpha)) * (4.0 * wo.z * wi.z));
}

#endif
