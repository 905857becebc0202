// For selftest/bsdfs.h: one material, given by its record, or by two if it is principled. Samples it with u and
// evaluates it, both for the sampled direction and for a given wi.
#version 460
#extension GL_GOOGLE_include_directive : require

#define LAYERED 1
#define ITEM_WORDS 15u
#define RESULT_WORDS 17u
#include "base/hash.glsl"
#include "base/sampler.glsl"
#include "bsdf/bsdf.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    MaterialRecord material = material_unpack(item(0u), item(1u));
    bool front = item(4u).w == 0u;
    Bsdf bsdf = bsdf_at(material, front);
    vec3 wo = item_floats(2u).xyz;
    if (material.model == MATERIAL_PRINCIPLED) {
        uvec4 words[PRINCIPLED_WORDS];
        for (uint i = 0u; i < PRINCIPLED_WORDS; ++i)
            words[i] = item(5u + i);
        uvec4 bits = hash_pcg4d(uvec4(item(2u).w, 1u, 2u, 3u));
        PrincipledSurface surface = principled_surface(material, principled_unpack(words), front, bsdf.parameter,
                                                       vec3(1.0 / 3.0), vec4(unit_float(bits.xy), unit_float(bits.zw)));
        bsdf.principled = principled_lobes(surface, wo);
    }
    vec3 wi = item_floats(3u).xyz;
    BsdfSample s = bsdf_sample_f(bsdf, wo, item_floats(4u).z, item_floats(4u).xy);
    put(s.wi);
    put(s.weight);
    put(s.pdf);
    put(uint(s.delta));
    put(s.eta);
    BsdfValue of_sample = bsdf_evaluate(bsdf, wo, s.wi);
    put(of_sample.f);
    put(of_sample.pdf);
    BsdfValue value = bsdf_evaluate(bsdf, wo, wi);
    put(value.f);
    put(value.pdf);
}
