// How far light comes in a medium.
#ifndef MEDIUM_DISTANCE_GLSL
#define MEDIUM_DISTANCE_GLSL

#include "base/exponential.glsl"
#include "base/math.glsl"
#include "base/sampler.glsl"
#include "shared/medium.h"

// An infinite distance is replaced by this one, since infinity times 0 is NaN. (A compiler that assumes finite numbers
// may drop a min with FLOAT_MAX.)
const float FAR = 1e30;

// What light loses in the medium, by absorption or out of its direction.
vec3 medium_extinction(MediumRecord m) {
    return VOLUMETRIC ? m.absorption + m.scattering : m.absorption;
}

// A light near a segment of a path, around which scattering counts most.
struct Focus {
    float along;     // Where on the segment it is nearest, in lengths of the ray; may be beyond either end.
    float distance;  // How near it is there, or its size if that is more; above 0.
    float share;     // Of the paths in a dense medium that scatter for it; 0: there is no such light.
    vec2 lit;        // From where to where it shines on the segment.
};

Focus focus_none() {
    return Focus(0.0, 1.0, 0.0, vec2(0.0));
}

// Distances t from the start of a segment with a density that falls with the square of the distance from the focus, as
// its light does: that of r = s / (d + |s|), s = t - along, is even. It is within a factor of 2 of that of equal angles
// around the light, and needs no inverse tangent.
// Ref: Kulla and Fajardo 2012, Importance Sampling Techniques for Path Tracing in Participating Media, section 4.
float focus_place(Focus f, float t) {
    float s = t - f.along;
    return s / (f.distance + abs(s));
}

// The distance for u in [0, 1), between the places of both ends.
float focus_sample(Focus f, vec2 ends, float u) {
    float r = mix(ends.x, ends.y, u);
    return f.along + f.distance * r / max(1.0 - abs(r), 1e-7);
}

// Its density [1 / length].
float focus_pdf(Focus f, vec2 ends, float t) {
    float d = f.distance + abs(t - f.along);
    return f.distance / (d * d * (ends.y - ends.x));
}

// What a path meets on a segment.
struct MediumSample {
    bool scattered;  // The medium scatters it at the distance t; otherwise it reaches the segment's end.
    float t;
    vec3 weight;  // Of the throughput: transmittance over probability or, if scattered, times scattering.
};

// Samples how far a path with the throughput beta comes on a segment of the length t_max, from random words: one for
// the distance, one for the channel whose extinction the distance follows, and two for the focus. Each channel is
// chosen as often as its share of beta, and the weights account for all three: no channel's throughput then exceeds the
// sum of beta. A share of the paths scatter where the focus says instead, which the weights account for, too: in thin
// media less, by the square root of the share that would scatter anyway. Where nothing scatters, the path reaches the
// end, and the weight is the transmittance.
// Ref: Wilkie et al. 2014, Hero Wavelength Spectral Sampling; Chiang et al. 2016, Practical and Controllable Subsurface
// Scattering for Production Path Tracing.
MediumSample medium_sample(MediumRecord m, vec3 beta, float t_max, Focus focus, uvec4 random) {
    vec3 extinction = medium_extinction(m);
    t_max = min(t_max, FAR);
    MediumSample s = MediumSample(false, t_max, exp(-t_max * extinction));
    if (max_component(m.scattering) == 0.0) return s;
    vec3 share = beta / (beta.x + beta.y + beta.z);
    float uc = unit_float(random.y);
    float hero = uc < share.x ? extinction.x : uc < share.x + share.y ? extinction.y : extinction.z;
    float depth = exponential_sample(random.x);
    s.scattered = depth < hero * t_max;
    if (s.scattered) s.t = depth / hero;
    focus.lit = clamp(focus.lit, 0.0, t_max);
    vec2 ends = vec2(focus_place(focus, focus.lit.x), focus_place(focus, focus.lit.y));
    if (ends.y - ends.x < 1.0 / 1024.0) focus.share = 0.0;  // Rounding would count.
    focus.share *= sqrt(max(1.0 - dot(share, s.weight), 0.0));
    if (unit_float(random.z) < focus.share) {
        s.scattered = true;
        s.t = clamp(focus_sample(focus, ends, unit_float(random.w)), focus.lit.x, focus.lit.y);
    }
    s.weight = exp(-s.t * extinction);
    float pdf = (1.0 - focus.share) * dot(share, s.scattered ? extinction * s.weight : s.weight);
    if (s.scattered) {
        bool lit = s.t >= focus.lit.x && s.t <= focus.lit.y;
        if (focus.share > 0.0 && lit) pdf += focus.share * focus_pdf(focus, ends, s.t);
        s.weight *= m.scattering;
    }
    s.weight = pdf > 0.0 ? s.weight / pdf : vec3(0.0);
    return s;
}

#endif
