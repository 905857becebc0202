// For bsdf_test.cpp: one material, given by its record. Samples it with u and evaluates it, both for the sampled
// direction and for a given wi.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 4u
#define RESULT_WORDS 15u
#include "bsdf/bsdf.glsl"
#include "items.glsl"

void main() {
    if (past_end()) return;
    MaterialRecord material = material_unpack(item(0u));
    vec3 wo = item_floats(1u).xyz;
    vec3 wi = item_floats(2u).xyz;
    BsdfSample s = bsdf_sample_f(material, wo, item(3u).z, item_floats(3u).xy);
    put(s.wi);
    put(s.weight);
    put(s.pdf);
    put(bsdf_f(material, wo, s.wi));
    put(bsdf_pdf(material, wo, s.wi));
    put(bsdf_f(material, wo, wi));
    put(bsdf_pdf(material, wo, wi));
}
