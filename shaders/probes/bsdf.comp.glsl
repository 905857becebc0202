// For selftest/bsdfs.h: one material, given by its record. Samples it with u and evaluates it, both for the sampled
// direction and for a given wi.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 5u
#define RESULT_WORDS 17u
#include "bsdf/bsdf.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    Bsdf bsdf = bsdf_at(material_unpack(item(0u), item(1u)), item(4u).w == 0u);
    vec3 wo = item_floats(2u).xyz;
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
