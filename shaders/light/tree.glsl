// The tree over lights: a way down from the root, at each node to a child chosen by its importance for the lit point,
// ends at a light. The importance bounds what the lights below a child may send there, as if all were at the centre of
// their sphere. A fixed fraction of all ways goes by strength alone, wherever the point is.
// Ref: Conty Estevez and Kulla 2018, Importance Sampling of Many Lights with Adaptive Tree Splitting; Pharr, Jakob and
// Humphreys 2023, Physically Based Rendering, section 12.6.3.
#ifndef LIGHT_TREE_GLSL
#define LIGHT_TREE_GLSL

#include "base/math.glsl"
#include "base/random_range.glsl"
#include "light/lit_point.glsl"
#include "scene/scene_data.glsl"

// One way in so many goes by strength. So a light's probability is at least its strength / (2 * LIGHT_TREE_WAYS), for
// any importance: rounding takes at most 4 % of a small part at each of up to 16 nodes. (Of a lamp's lights, half as
// much is certain, after twice as many nodes.)
const uint LIGHT_TREE_WAYS = 16u;

// Minimum probability of a child that may light the point.
const float LIGHT_TREE_MIN_PART = 1.0 / 1024.0;

// Bounds the rounding of a cosine: axes have 10 bits, and a sine computed from a cosine near 1 has half of its digits.
const float LIGHT_TREE_SLACK = 3e-3;

// The sine of an angle in [0, pi].
float sine_of(float cosine) {
    return sqrt(max(0.0, (1.0 - cosine) * (1.0 + cosine)));
}

// Cosine of max(0, a - b), for angles in [0, pi] with these cosines and sines.
float cosine_of_rest(vec2 a, vec2 b) {
    return a.x > b.x ? 1.0 : a.x * b.x + a.y * b.y;
}

// The cosine and sine of an angle, from the sine of half of it in a record.
vec2 unpack_half_sine(uint bits) {
    float s = float(bits & LIGHT_TREE_SINE) * (1.0 / float(LIGHT_TREE_SINE));
    return vec2(1.0 - 2.0 * s * s, 2.0 * s * sqrt((1.0 - s) * (1.0 + s)));
}

// An axis, of about unit length.
vec3 unpack_axis(uint bits) {
    return vec3(ivec3(bits << 22u, bits << 12u, bits << 2u) >> 22) * (1.0 / LIGHT_TREE_AXIS);
}

// Upper bound on the cosine at a light of the child between its normal and the direction to the point; 0 if none of its
// lights emits there. w is the direction from the centre; the sphere subtends the angle with cosine and sine b.
float light_tree_emission(LightTreeChild c, vec3 w, vec2 b) {
    float cos_w = clamp(dot(w, unpack_axis(c.axis)), -1.0, 1.0);
    if ((c.cone & LIGHT_TREE_BOTH_SIDES) != 0u) cos_w = abs(cos_w);
    vec2 angle = vec2(cos_w, sine_of(cos_w)), normals = unpack_half_sine(c.cone);
    vec2 rest = vec2(cosine_of_rest(angle, normals), 0.0);
    if (angle.x <= normals.x) rest.y = angle.y * normals.x - angle.x * normals.y;
    float cosine = cosine_of_rest(rest, b) + LIGHT_TREE_SLACK;
    return cosine > unpack_half_sine(c.cone >> LIGHT_TREE_EMISSION_SHIFT).x ? max(cosine, 0.0) : 0.0;
}

// Upper bound on the cosine at the lit point between its normal and a direction to the sphere; 0 if the sphere is below
// the horizon.
float light_tree_reception(LitPoint lit, vec3 w, vec2 b) {
    if (lit.any_normal) return 1.0;
    float cos_i = clamp(-dot(w, lit.n), -1.0, 1.0);
    if (lit.both_sides) cos_i = abs(cos_i);
    return max(cosine_of_rest(vec2(cos_i, sine_of(cos_i)), b) + LIGHT_TREE_SLACK, 0.0);
}

// The importance of a child for a lit point: finite, and 0 only if none of its lights sends anything there.
float light_tree_importance(LightTreeChild c, LitPoint lit) {
    const float MIN_DISTANCE2 = 1e-30;  // So that quotients are finite.
    vec3 w = lit.p - c.centre;
    float d2 = dot(w, w), r2 = square(c.radius);
    float inv_d = inversesqrt(max(d2, MIN_DISTANCE2));
    w *= inv_d;
    vec2 b = vec2(-1.0, 0.0);  // From inside, the sphere is in all directions.
    if (d2 > r2) {
        b.y = min(c.radius * inv_d, 1.0);
        b.x = sine_of(b.y);
    }
    // This order keeps few values alive.
    precise float importance = c.strength / max(max(d2, r2), MIN_DISTANCE2);
    importance *= light_tree_reception(lit, w, b);
    importance *= light_tree_emission(c, w, b);
    return importance;
}

// Where the parts of children with these weights end, in units of 1 / RANGE_PARTS; the last one ends at 1. The weights
// and their sum are finite, and the sum is above 0. Only a child of weight 0 has no part.
uvec4 light_tree_ends(vec4 weight) {
    precise float sum = weight.x + weight.y + weight.z + weight.w;
    vec4 w = mix(vec4(0.0), max(weight, vec4(sum * LIGHT_TREE_MIN_PART)), greaterThan(weight, vec4(0.0)));
    precise vec4 ends = vec4(w.x, w.x + w.y, w.x + w.y + w.z, w.x + w.y + w.z + w.w);
    precise vec4 parts = ends * (float(RANGE_PARTS) / ends.w) + 0.5;
    return uvec4(uvec3(min(parts.xyz, vec3(float(RANGE_PARTS)))), RANGE_PARTS);
}

// A way down the tree.
struct LightTreeWay {
    uint at;              // The node reached, or the light, with LIGHT_TREE_LEAF_BIT.
    float by_importance;  // Probability of this way if each child is chosen by its importance.
    float by_strength;    // The same if each child is chosen by its strength.
};

// The importance of each child of a node.
vec4 light_tree_importances(uint node, LitPoint lit) {
    vec4 importance = vec4(0.0);
    for (uint i = 0u; i < LIGHT_TREE_WIDTH; ++i) {
        importance = vec4(importance.yzw, light_tree_importance(scene_light_tree(node, i), lit));
    }
    return importance;
}

// Where the parts of a node's children end, as from light_tree_ends.
struct LightTreeStep {
    uvec4 by_importance;
    uvec4 by_strength;
};

LightTreeStep light_tree_step(uint node, LitPoint lit) {
    const float MIN_IMPORTANCE = 1e-36;  // A lower one may be denormal.
    vec4 importance = light_tree_importances(node, lit);
    vec2 larger = max(importance.xy, importance.zw);
    bool important = max(larger.x, larger.y) > MIN_IMPORTANCE;
    uvec4 by_importance = light_tree_ends(important ? importance : vec4(1.0));
    // Strengths are read a second time, so that they need no registers until here.
    uvec4 by_strength = light_tree_ends(scene_light_tree_strengths(node));
    return LightTreeStep(important ? by_importance : by_strength, by_strength);
}

void light_tree_go(inout LightTreeWay way, LightTreeStep step, uint c) {
    way.by_importance *= range_part(step.by_importance, c);
    way.by_strength *= range_part(step.by_strength, c);
    way.at = scene_light_tree(way.at, c).at;
}

// Probability of a way; the first two parts of `groups` go by strength and by importance.
float light_tree_pmf(LightTreeWay way, uvec4 groups) {
    return range_part(groups, 0u) * way.by_strength + range_part(groups, 1u) * way.by_importance;
}

// A way that begins at the node, or goes nowhere.
LightTreeWay light_tree_begin(uint at) {
    return LightTreeWay(at, 1.0, 1.0);
}

// Goes on to a light that random bits choose, by strength or by importance.
void light_tree_choose(inout LightTreeWay way, LitPoint lit, inout RandomRange random, bool by_strength) {
    while ((way.at & LIGHT_TREE_LEAF_BIT) == 0u) {
        LightTreeStep step = light_tree_step(way.at, lit);
        light_tree_go(way, step, range_choose(random, by_strength ? step.by_strength : step.by_importance));
    }
}

// Goes on along a light's trail.
void light_tree_follow(inout LightTreeWay way, LitPoint lit, uint trail) {
    while ((way.at & LIGHT_TREE_LEAF_BIT) == 0u) {
        light_tree_go(way, light_tree_step(way.at, lit), trail & 3u);
        trail >>= 2u;
    }
}

#endif
