// The probes as SPIR-V, compiled from shaders/probes at build time, and the inputs and results of the larger
// ones.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "base/math.h"
#include "shared/constants.h"
#include "shared/material.h"
#include "shared/principled.h"

namespace candela::kernels {

extern const std::span<const uint32_t> any_hit, bsdf, closest_hit, distance, environment, escape, exponential,
    frame, hash, interaction, light_choice, light_sample, light_tree, math, octahedral, records, sampler,
    spawn, texture, traversal, warp;

}  // namespace candela::kernels

namespace candela {

// bsdf: samples a material with u and uc, and evaluates it both for the sampled direction and for wi.
struct BsdfItem {
    std::array<uvec4, MATERIAL_WORDS> material;  // Its record, packed.
    vec3 wo{0, 0, 1};
    uint32_t random = 0;  // Chooses the facets that a principled material measures.
    vec3 wi{0, 0, 1};
    float unused = 0.0f;
    vec2 u{0};
    float uc = 0.0f;
    uint32_t back = 0;                                 // 1: wo is on the back side of the surface.
    std::array<uvec4, PRINCIPLED_WORDS> principled{};  // The packed PrincipledRecord of MATERIAL_PRINCIPLED.
};
static_assert(sizeof(BsdfItem) == 80 + 16 * PRINCIPLED_WORDS);

// `f` and `pdf_of_wi` are for BsdfItem::wi, the rest is for the sample that u and uc choose.
struct BsdfResult {
    vec3 wi, weight;
    float pdf;
    uint32_t delta;
    float eta;
    vec3 f_of_sample;
    float pdf_of_sample;
    vec3 f;
    float pdf_of_wi;
};

// light_choice: random bits for the choice of a light at a lit point, and a second light.
struct LightChoiceItem {
    vec3 p{0};
    uint32_t choice = 0;
    vec3 n{0};  // 0: none.
    uint32_t light = 0;
    uint32_t more = 0;         // Further random bits.
    uint32_t both_sides = 0;   // 1: light from either side of n is scattered.
    uint32_t lamp = NO_LIGHT;  // The lamp that has the light, if one does.
    uint32_t unused = 0;
};

struct LightChoice {
    uint32_t chosen;
    uint32_t lamp;  // The lamp that has it, or NO_LIGHT.
    float pmf;
    float pmf_of_light;  // Probability of LightChoiceItem::light.
};

// light_tree: a lit point, and a light of which the tree tells the way.
struct LightTreeItem {
    vec3 p{0};
    uint32_t light = 0;
    vec3 n{0};  // 0: none.
    uint32_t both_sides = 0;
};

struct LightTreeWay {
    float by_importance;  // Probability, if each child is chosen by its importance,
    float by_strength;    // and if by its strength.
    uint32_t arrives;     // 1: it ends at the light.
};

// light_sample: random bits for a light sample from a reference point.
struct LightItem {
    vec3 from{0};
    uint32_t choice = 0;  // Chooses the light.
    uvec2 u{0};           // Chooses the point on it.
    uvec2 unused{0};
};

struct LightSample {
    vec3 wi, Li;
    float pdf;
    uint32_t delta;  // Whether pdf is the probability of the light.
    vec3 shadow;
    float t_max;
    uint32_t occluded;  // Whether the shadow ray is.
    // What a ray in the direction wi hits: a light, or NO_LIGHT for other surfaces and for the sky; the
    // density of light samples there; and its radiance.
    uint32_t light_met;
    float pdf_met;
    vec3 Li_met;
};

// sampler: the arguments that determine three random words. The result is a uvec3.
struct SampleOfPair {
    uint32_t pixel;  // x | y << 16
    uint32_t n;
    uint32_t seed;
    uint32_t pair;
};

// warp: a point u of the unit square, and its image under every warp.
struct WarpItem {
    vec2 u{0};
    float exponent = 1.0f;  // Exponent of power_cosine.
    float h_max = 1.0f;     // Height of the cone.
    vec3 w{0, 0, 1};        // View direction for the visible normal.
    float alpha = 0.5f;     // Roughness for the visible normal.
    uint32_t corners = 3;   // Corners of the polygon.
    uvec3 unused{0};
};
static_assert(sizeof(WarpItem) == 48);

struct WarpResult {
    vec2 disk;
    vec3 direction;
    float pdf;
    vec2 triangle;
    vec3 power_cosine, sphere, cone, normal;
    vec2 polygon;
    vec2 tent, gaussian, blackman_harris;  // Of the filters of pixels.
};

// interaction: a ray, and a direction in which another leaves from where it hits.
struct InteractionItem {
    vec3 o;
    float unused0 = 0.0f;
    vec3 d;
    float unused1 = 0.0f;
    vec3 wi;            // Reversed if it does not point to that side:
    uint32_t side = 0;  // 0: the viewer's, 1: the other.
};

// Everything but t is 0 if the ray misses.
struct InteractionResult {
    float t;
    vec3 p;
    float p_error;
    vec3 n;  // On the viewer's side.
    uint32_t front;
    vec3 next_o, next_d;
    float next_t;
    uint32_t id;
};

// traversal: a ray, and its nearest hit by the BVH and by brute force.
struct RayItem {
    vec3 o;
    float unused0;
    vec3 d;
    float unused1;
};

struct TraversalResult {
    float t;
    uint32_t id;
    vec2 b;
    float brute_t;
    uint32_t brute_id;
    uint32_t occluded_before;  // By anything nearer than the hit.
    uint32_t occluded_at;      // Up to the float above the hit's t.
    uint32_t occluded;         // At any distance.
};

}  // namespace candela
