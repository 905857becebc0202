// A rough diffuse reflector that loses no energy: EON, OpenPBR's diffuse base. Local frame, z on the viewer's side.
// Ref: Portsmouth, Kutz and Hill 2025, EON: A Practical Energy-Preserving Rough Diffuse BRDF.
#ifndef BSDF_ROUGH_DIFFUSE_GLSL
#define BSDF_ROUGH_DIFFUSE_GLSL

#include "base/math.glsl"

const float FON_A = 0.5 - 2.0 / (3.0 * PI);
const float FON_B = 2.0 / 3.0 - 28.0 / (15.0 * PI);

// Albedo of a white surface of that roughness in [0, 1] without interreflection, at a cosine in [0, 1]; a fit of the
// paper's.
float fon_albedo(float roughness, float cosine) {
    float x = 1.0 - cosine;
    float g = x * (0.0571085289 + x * (0.491881867 + x * (-0.332181442 + x * 0.0714429953)));
    return (1.0 + roughness * g) / (1.0 + FON_A * roughness);
}

// The value [1/sr]; both directions above the surface. A roughness of 0 is Lambert's reflector.
vec3 rough_diffuse_f(vec3 reflectance, float roughness, vec3 wo, vec3 wi) {
    float s = dot(wo, wi) - wo.z * wi.z;
    float facets = s > 0.0 ? s / max(wo.z, wi.z) : s;
    float scale = 1.0 / (1.0 + FON_A * roughness);
    float mean = scale * (1.0 + FON_B * roughness);
    vec3 multiscatter = reflectance * reflectance * (mean / (vec3(1.0) - reflectance * (1.0 - mean)));
    float lost_o = max(0.0, 1.0 - fon_albedo(roughness, wo.z));
    float lost_i = max(0.0, 1.0 - fon_albedo(roughness, wi.z));
    vec3 f = reflectance * (scale * max(1.0 + roughness * facets, 0.0));
    if (mean < 1.0) f += multiscatter * (lost_o * lost_i / (1.0 - mean));
    return f * INV_PI;
}

#endif
