// The data of a principled material at the place where it is hit. Kernels without such materials (LAYERED is 0) do not
// contain this.
#ifndef INTEGRATOR_LAYERS_GLSL
#define INTEGRATOR_LAYERS_GLSL

#include "base/hash.glsl"
#include "base/sampler.glsl"
#include "bsdf/bsdf.glsl"
#include "integrator/bent_normal.glsl"
#include "light/light_sampler.glsl"
#include "scene/interaction.glsl"
#include "scene/material.glsl"

const bool HAS_COATED_EMISSION = (PRINCIPLED & PRINCIPLED_HAS_COATED_EMISSION) != 0u;

#if LAYERED

const bool HAS_ANISOTROPY = (PRINCIPLED & PRINCIPLED_HAS_ANISOTROPY) != 0u;
const bool HAS_COAT_NORMALS = (PRINCIPLED & PRINCIPLED_HAS_COAT_NORMAL) != 0u;

bool is_principled(MaterialRecord m) {
    if ((MATERIALS & 1u << MATERIAL_PRINCIPLED) == 0u) return false;
    return (MATERIALS & ~(1u << MATERIAL_PRINCIPLED)) == 0u || m.model == MATERIAL_PRINCIPLED;
}

// Resolves the principled material m at s, which the path's ray hit, and writes its base colour back. With dispersion,
// a direction is drawn for one colour, in proportion to the throughput that is left in each.
PrincipledSurface layers_at(inout MaterialRecord m, Interaction s, float eta, Ray ray, vec3 beta) {
    PrincipledRecord record = principled_at(m, s.attributes);
    uvec4 bits = hash_pcg4d(hit_random(ray));
    vec3 hue = LUMINANCE;
    if ((PRINCIPLED & PRINCIPLED_HAS_DISPERSION) != 0u) {
        float sum = beta.x + beta.y + beta.z;
        if (sum > 1e-30) hue = beta / sum;  // Below this, light is invisible, and may be too small to divide by.
    }
    return principled_surface(m, record, s.front, eta, hue, vec4(unit_float(bits.xy), unit_float(bits.zw)));
}

// The frame around the shading normal whose x is the direction of the greatest roughness.
Frame principled_frame(PrincipledRecord p, Interaction s) {
    vec3 t = s.attributes.tangent.xyz;
    vec3 b = s.attributes.tangent.w * cross(s.front ? s.ns : -s.ns, t);
    vec3 x = p.rotation.x * t + p.rotation.y * b;
    x -= dot(x, s.ns) * s.ns;
    float length_squared = dot(x, x);
    if (length_squared == 0.0) return frame_from_z(s.ns);
    x *= inversesqrt(length_squared);
    return Frame(x, cross(s.ns, x), s.ns);
}

// Fraction of material i's emission that passes its fuzz, coat and sheen at that cosine to its normal; unbiased over
// `random`, uniform in [0, 1)^2.
float emitted_fraction(uint i, Attributes at, float cosine, vec2 random) {
    MaterialRecord m = scene_material(i);
    if (!is_principled(m)) return 1.0;
    PrincipledRecord record = principled_at(m, at);
    PrincipledSurface s = principled_surface(m, record, true, m.parameter, LUMINANCE, random.xyxy);
    return principled_layers(s, vec3(sqrt(max(1.0 - square(cosine), 0.0)), 0.0, cosine));
}

// The same for a sample of a light.
float emitted_fraction(LightSample light, LitPoint lit) {
    if (!light_has_surface(light_at(light.light))) return 1.0;
    uvec4 bits = hash_pcg4d(uvec4(floatBitsToUint(light.wi), floatBitsToUint(lit.p.x)));
    return emitted_fraction(scene_light_textures(light.light).material, light_sample_attributes(light, lit),
                            light_sample_cosine(light, lit), unit_float(bits.xy));
}

// Whether the material's coat has its own normal map.
bool has_coat_map(MaterialRecord m) {
    if (!HAS_COAT_NORMALS || !is_principled(m)) return false;
    return scene_principled(principled_first(m.specular.x)).coat_normal != TEXTURE_NONE;
}

// The coat's normal in `frame`; `unbent` is the shading normal of the shape.
vec3 coat_normal(PrincipledRecord p, Interaction s, vec3 unbent, vec3 horizon, Frame frame) {
    s.ns = unbent;
    if (p.coat_normal != TEXTURE_NONE) {
        vec3 n = mapped_normal(p.coat_normal, p.coat_normal_scale, s);
        s.ns = s.front ? n : -n;
    }
    return frame_to_local(frame, consistent_normal(s.wo, horizon, s.ns));
}

// Adds the lobes of the material m, if it is principled, at s, which the path's ray hit. Sets m's base colour there,
// and turns x of the frame to the direction of the greatest roughness. `unbent` is the shading normal of the shape.
void add_layers(inout Bsdf bsdf, inout MaterialRecord m, inout Frame frame, Interaction s, vec3 unbent, vec3 horizon,
                Ray ray, vec3 beta) {
    if (!is_principled(m)) return;
    PrincipledSurface surface = layers_at(m, s, bsdf.parameter, ray, beta);
    if (HAS_ANISOTROPY) frame = principled_frame(surface.record, s);
    if (HAS_COAT_NORMALS) surface.coat_n = coat_normal(surface.record, s, unbent, horizon, frame);
    bsdf.base = m.base;
    bsdf.principled = principled_lobes(surface, frame_to_local(frame, s.wo));
}

#else

bool is_principled(MaterialRecord m) {
    return false;
}

bool has_coat_map(MaterialRecord m) {
    return false;
}

float emitted_fraction(uint i, Attributes at, float cosine, vec2 random) {
    return 1.0;
}

float emitted_fraction(LightSample light, LitPoint lit) {
    return 1.0;
}

void add_layers(inout Bsdf bsdf, inout MaterialRecord m, inout Frame frame, Interaction s, vec3 unbent, vec3 horizon,
                Ray ray, vec3 beta) {}

#endif

#endif
