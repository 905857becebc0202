#ifndef BSDF_ALBEDO_GLSL
#define BSDF_ALBEDO_GLSL
#include "bsdf/fresnel.glsl"
float ggx_albedo(float alpha, float cos_o) { return 1.0 - 0.5 * alpha * alpha * (1.0 - 0.3 * cos_o); }
float ggx_effective_alpha(vec2 alpha, vec3 wo) { return sqrt(alpha.x * alpha.y); }
float ggx_albedo_edge(float alpha, float cos_o, float eta) { return schlick_weight(cos_o); }
float glass_albedo(float alpha, float cos_o, float eta) { return 1.0 - 0.2 * alpha * alpha; }
float glass_albedo_clear(float alpha, float cos_o, float eta) { return 1.0 - 0.1 * alpha * alpha; }
float sheen_albedo(float alpha, float cos_o) { return 0.2 + 0.6 * schlick_weight(cos_o); }
#endif
