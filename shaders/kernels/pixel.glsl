// The accumulation image and the counters: the state of a pixel, and how a sample becomes part of it.
#ifndef KERNELS_PIXEL_GLSL
#define KERNELS_PIXEL_GLSL

#include "integrator/path.glsl"

layout(binding = BINDING_IMAGE, rgba32f) uniform image2DArray accumulation;
layout(std430, binding = BINDING_COUNTERS) buffer CountersBlock {
    uint counters[COUNTER_COUNT];
};
// The counts of a work group, if GROUP_COUNTERS: on a GPU, all invocations would otherwise contend for the same words
// of the buffer.
shared uint group_counters[COUNTER_COUNT];
shared uint group_finished;  // Invocations that have finished counting.

void count(uint counter, uint n) {
    if (GROUP_COUNTERS) {
        atomicAdd(group_counters[counter], n);
    } else {
        atomicAdd(counters[counter], n);
    }
}

void count_rays(uint rays) {
    uint before = GROUP_COUNTERS ? atomicAdd(group_counters[COUNTER_RAYS_LOW], rays)
                                 : atomicAdd(counters[COUNTER_RAYS_LOW], rays);
    if (before + rays < before) count(COUNTER_RAYS_HIGH, 1u);
}

// The last invocation of the group to arrive adds the group's counts to the counters. (With one invocation for each
// counter, each would need a register for its number while it traces.)
void flush_counters() {
    memoryBarrierShared();
    if (atomicAdd(group_finished, 1u) + 1u < WORKGROUP_SIZE * WORKGROUP_SIZE) return;
    memoryBarrierShared();
    uint rays = group_counters[COUNTER_RAYS_LOW];
    uint before = atomicAdd(counters[COUNTER_RAYS_LOW], rays);
    uint carry = before + rays < before ? 1u : 0u;
    for (uint i = COUNTER_RAYS_LOW + 1u; i < COUNTER_COUNT; ++i) {
        uint n = group_counters[i] + (i == COUNTER_RAYS_HIGH ? carry : 0u);
        if (n > 0u) atomicAdd(counters[i], n);
    }
}

// A compensated sum; its value is sum - compensation.
struct Sum {
    vec3 sum;
    vec3 compensation;
};

// The same of single numbers.
struct ScalarSum {
    float sum;
    float compensation;
};

// The state of a pixel.
struct Pixel {
    Sum L;
    Sum square;  // Sum of L^2.
    Sum albedo;  // Sum over the first hits; only if HAS_AOVS.
    Sum normal;  // Sum over the first hits; only if HAS_AOVS.
    Sum with;    // Sums over the first hits that are catchers; only if HAS_CATCHERS.
    Sum without;
    Sum guide_albedo;  // Sums of Guides; only if HAS_GUIDES.
    Sum guide_normal;
    ScalarSum guide_square;  // Sum of squared lengths of guide albedos.
    float caught;            // Samples whose camera ray hit a catcher,
    float reflecting;        // and one that reflects; only if HAS_CATCHERS.
    ScalarSum transmission;  // Only if BEFORE_BACKGROUND.
    float visible;           // Samples whose camera ray hit something visible.
    float rays;              // At most MAX_RAYS.
    float limit;             // 0: none; otherwise the most samples that it gets, plus one.
    uint samples;
};

vec4 layer_load(uvec2 at, uint layer) {
    return imageLoad(accumulation, ivec3(at, layer));
}

void layer_store(uvec2 at, uint layer, vec4 value) {
    imageStore(accumulation, ivec3(at, layer), value);
}

// Loads the pixel at that place of the accumulation image.
Pixel pixel_load(uvec2 at) {
    vec4 L = layer_load(at, LAYER_L);
    vec4 L_compensation = layer_load(at, LAYER_L_COMPENSATION);
    vec4 square = layer_load(at, LAYER_SQUARE);
    vec4 square_compensation = layer_load(at, LAYER_SQUARE_COMPENSATION);
    Pixel p;
    p.L = Sum(L.rgb, L_compensation.rgb);
    p.square = Sum(square.rgb, square_compensation.rgb);
    p.albedo = Sum(vec3(0.0), vec3(0.0));
    p.normal = Sum(vec3(0.0), vec3(0.0));
    p.transmission = ScalarSum(0.0, 0.0);
    if (HAS_AOVS) {
        vec4 albedo = layer_load(at, LAYER_ALBEDO);
        vec4 albedo_compensation = layer_load(at, LAYER_ALBEDO_COMPENSATION);
        p.albedo = Sum(albedo.rgb, albedo_compensation.rgb);
        if (BEFORE_BACKGROUND) p.transmission = ScalarSum(albedo.a, albedo_compensation.a);
        p.normal = Sum(layer_load(at, LAYER_NORMAL).rgb, layer_load(at, LAYER_NORMAL_COMPENSATION).rgb);
    }
    p.with = Sum(vec3(0.0), vec3(0.0));
    p.without = Sum(vec3(0.0), vec3(0.0));
    p.caught = 0.0;
    p.reflecting = 0.0;
    if (HAS_CATCHERS) {
        vec4 with = layer_load(at, LAYER_WITH);
        vec4 without = layer_load(at, LAYER_WITHOUT);
        p.with = Sum(with.rgb, layer_load(at, LAYER_WITH_COMPENSATION).rgb);
        p.without = Sum(without.rgb, layer_load(at, LAYER_WITHOUT_COMPENSATION).rgb);
        p.caught = with.a;
        p.reflecting = without.a;
    }
    p.guide_albedo = Sum(vec3(0.0), vec3(0.0));
    p.guide_normal = Sum(vec3(0.0), vec3(0.0));
    p.guide_square = ScalarSum(0.0, 0.0);
    if (HAS_GUIDES) {
        vec4 albedo = layer_load(at, DENOISING_LAYER + GUIDE_ALBEDO);
        vec4 albedo_compensation = layer_load(at, DENOISING_LAYER + GUIDE_ALBEDO_COMPENSATION);
        p.guide_albedo = Sum(albedo.rgb, albedo_compensation.rgb);
        p.guide_square = ScalarSum(albedo.a, albedo_compensation.a);
        p.guide_normal = Sum(layer_load(at, DENOISING_LAYER + GUIDE_NORMAL).rgb,
                             layer_load(at, DENOISING_LAYER + GUIDE_NORMAL_COMPENSATION).rgb);
    }
    p.visible = L.a;
    p.rays = square_compensation.a;
    p.limit = square.a;
    p.samples = uint(L_compensation.a);
    return p;
}

void pixel_store(uvec2 at, Pixel p) {
    layer_store(at, LAYER_L, vec4(p.L.sum, p.visible));
    layer_store(at, LAYER_L_COMPENSATION, vec4(p.L.compensation, float(p.samples)));
    layer_store(at, LAYER_SQUARE, vec4(p.square.sum, p.limit));
    layer_store(at, LAYER_SQUARE_COMPENSATION, vec4(p.square.compensation, p.rays));
    if (HAS_AOVS) {
        layer_store(at, LAYER_ALBEDO, vec4(p.albedo.sum, p.transmission.sum));
        layer_store(at, LAYER_ALBEDO_COMPENSATION, vec4(p.albedo.compensation, p.transmission.compensation));
        layer_store(at, LAYER_NORMAL, vec4(p.normal.sum, 0.0));
        layer_store(at, LAYER_NORMAL_COMPENSATION, vec4(p.normal.compensation, 0.0));
    }
    if (HAS_CATCHERS) {
        layer_store(at, LAYER_WITH, vec4(p.with.sum, p.caught));
        layer_store(at, LAYER_WITH_COMPENSATION, vec4(p.with.compensation, 0.0));
        layer_store(at, LAYER_WITHOUT, vec4(p.without.sum, p.reflecting));
        layer_store(at, LAYER_WITHOUT_COMPENSATION, vec4(p.without.compensation, 0.0));
    }
    if (HAS_GUIDES) {
        layer_store(at, DENOISING_LAYER + GUIDE_ALBEDO, vec4(p.guide_albedo.sum, p.guide_square.sum));
        layer_store(at, DENOISING_LAYER + GUIDE_ALBEDO_COMPENSATION,
                    vec4(p.guide_albedo.compensation, p.guide_square.compensation));
        layer_store(at, DENOISING_LAYER + GUIDE_NORMAL, vec4(p.guide_normal.sum, 0.0));
        layer_store(at, DENOISING_LAYER + GUIDE_NORMAL_COMPENSATION, vec4(p.guide_normal.compensation, 0.0));
    }
}

// The number of samples for the pixel when others have `target`.
uint pixel_target(Pixel p, uint target) {
    return p.limit > 0.0 ? min(target, uint(p.limit) - 1u) : target;
}

void add(inout Sum sum, vec3 x) {
    compensated_add(sum.sum, sum.compensation, x);
}

void add(inout ScalarSum sum, float x) {
    vec3 total = vec3(sum.sum), compensation = vec3(sum.compensation);
    compensated_add(total, compensation, vec3(x));
    sum = ScalarSum(total.x, compensation.x);
}

// Folds what a sample says of catchers into the pixel, and leaves in L what is added to the picture. The background is
// seen through a catcher. A sample that is not finite adds no light, but is counted as a hit of the catcher.
void pixel_fold_catcher(inout Pixel p, inout Estimate estimate) {
    bool caught = estimate.catcher != CATCHER_NONE;
    vec3 with = caught ? estimate.with : vec3(0.0), without = caught ? estimate.L : vec3(0.0);
    if (!is_finite(with) || !is_finite(without)) {
        count(COUNTER_NONFINITE, 1u);
        with = without = vec3(0.0);
    }
    add(p.with, with);
    add(p.without, without);
    p.caught += caught ? 1.0 : 0.0;
    p.reflecting += estimate.catcher == CATCHER_REFLECTIONS ? 1.0 : 0.0;
    if (!caught) return;
    estimate.visible = false;
    estimate.L = estimate.reflected;
    estimate.transmission = 1.0;
}

// Folds a sample into the pixel. One whose value or square is not finite adds zero and is counted.
void pixel_fold(inout Pixel p, Estimate estimate) {
    if (HAS_CATCHERS) pixel_fold_catcher(p, estimate);
    if (!is_finite(estimate.L * estimate.L) || (BEFORE_BACKGROUND && !is_finite(vec3(estimate.transmission)))) {
        count(COUNTER_NONFINITE, 1u);
        estimate.L = vec3(0.0);
        estimate.transmission = 0.0;
    }
    if (estimate.cut) count(COUNTER_DEPTH_LIMIT, 1u);
    add(p.L, estimate.L);
    add(p.square, estimate.L * estimate.L);
    p.visible += estimate.visible ? 1.0 : 0.0;
    if (HAS_AOVS) {
        add(p.albedo, estimate.albedo);
        add(p.normal, estimate.normal);
        if (BEFORE_BACKGROUND) add(p.transmission, estimate.transmission);
    }
    if (HAS_GUIDES) {
        Guides guides = estimate.guides;
        if (!is_finite(guides.albedo) || !is_finite(guides.normal)) guides.albedo = guides.normal = vec3(0.0);
        add(p.guide_albedo, guides.albedo);
        add(p.guide_normal, guides.normal);
        add(p.guide_square, dot(guides.albedo, guides.albedo));
    }
    ++p.samples;
}

#endif
