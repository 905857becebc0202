// Brings every pixel of a tile to a number of samples, or to the pixel's limit if that is less: each invocation traces
// one path after the other for its pixel and folds it into the accumulation image. A pixel's own count determines which
// samples it still needs, so that any division of the work into tiles and dispatches gives the same bits.
//
// One iteration of a lane's loop, for a path on its way to vertex k:
//     trace the shadow ray of vertex k - 1, then the path's ray to vertex k
//     add the direct light of vertex k - 1; if the path ended there, fold the sample
//     shade vertex k, which yields its shadow ray and the path's next ray
// For a new sample, "vertex k - 1" is the last one of the sample before. A sample that hits a catcher first is begun
// twice: with everything there, and then with catchers, sky and lights alone.
#ifndef KERNELS_RENDER_GLSL
#define KERNELS_RENDER_GLSL

#include "integrator/path.glsl"
#include "scene/camera.glsl"

layout(local_size_x = WORKGROUP_SIZE, local_size_y = WORKGROUP_SIZE) in;

layout(binding = BINDING_IMAGE, rgba32f) uniform image2DArray accumulation;
layout(std430, binding = BINDING_COUNTERS) buffer CountersBlock {
    uint counters[COUNTER_COUNT];
};
layout(push_constant) uniform TileBlock {
    Tile tile;
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
    ++p.samples;
}

// The state of the sample that a lane traces.
struct Sample {
    Sampler random;
    Path path;
    Estimate estimate;
    ShadowRay shadow;   // From the previous vertex.
    bool alive;         // The path continues.
    bool ended;         // The path has ended; its last shadow ray may still have to be traced.
    uint rays;          // Traced so far.
    bool shadow_alone;  // As Path::alone, of the shadow ray.
};

// No sample yet.
Sample sample_none() {
    Sample s;
    s.shadow = shadow_none();
    s.alive = false;
    s.ended = false;
    s.rays = 0u;
    s.shadow_alone = false;
    return s;
}

// Begins the sample of that index with its camera ray; the second path of a sample is alone. The shadow ray and the
// estimate of the previous path remain.
void sample_begin(inout Sample s, Parameters parameters, uvec2 pixel, uint index, bool alone) {
    s.random = sampler_make(pixel, index, parameters.seed);
    CameraSample view = camera_sample(parameters, pixel, s.random);
    s.path = path_begin(view.ray, parameters.camera_media);
    s.path.alone = alone;
    if (HAS_CATCHERS && alone) {
        s.path.media = MEDIA_NONE;
        s.path.clear = false;
    }
    if (IS_FISHEYE && !view.sees) s.path.beta = vec3(0.0);
    s.alive = true;
}

// The hits of a sample's rays.
struct TraceResult {
    bool complete;  // False if the driver ended the loop early.
    bool lit;       // There is a shadow ray, and it is not blocked.
    Hit hit;        // The hit of the path's ray, if the path continues.
};

// Advances the traversal; once that of a shadow ray has ended, begins that of the path's next ray, if there is one.
void sample_advance(Sample s, inout Traversal traversal, inout bool lit) {
    bvh_advance(traversal);
    if (traversal.any_hit && bvh_ended(traversal)) {
        lit = !is_hit(traversal.hit);
        if (HAS_PASSABLE) traversal.any_hit = false;
        if (s.alive) traversal = bvh_begin(s.path.ray, FLOAT_MAX, false);
        if (HAS_CATCHERS) traversal.alone = s.path.alone;
    }
}

// Traces the shadow ray of a vertex and the path's next ray, one after the other, without waiting for neighbouring
// lanes in between.
TraceResult sample_trace(Sample s) {
    bool shadowed = s.shadow.t_max > 0.0;
    Ray first = s.path.ray;
    if (shadowed) first = s.shadow.ray;
    Traversal traversal = bvh_begin(first, shadowed ? s.shadow.t_max : FLOAT_MAX, shadowed);
    if (HAS_CATCHERS) traversal.alone = shadowed ? s.shadow_alone : s.path.alone;
    if (!shadowed && !s.alive) bvh_end(traversal);
    bool lit = false;
    if (HAS_PASSABLE) {
        // On software Vulkan, code in a branch takes its time even if no lane takes the branch. So the decision about
        // opacity is in an outer loop, at whose end lanes wait for each other once more.
        bool more;
        do {
            while (!bvh_waits(traversal) && (traversal.any_hit || !bvh_ended(traversal))) {
                sample_advance(s, traversal, lit);
            }
            bvh_decide(traversal);
            more = traversal.any_hit || !bvh_ended(traversal);
        } while (more);
    } else {
        while (!bvh_ended(traversal))
            sample_advance(s, traversal, lit);
    }
    bool turned = !(HAS_PASSABLE && traversal.any_hit);  // To the path's ray, if there is one.
    return TraceResult(turned && bvh_ended(traversal), lit, traversal.hit);
}

// Advances the path past the hit of its ray, or past its miss.
void sample_step(inout Sample s, Hit hit, Parameters parameters) {
    if (s.path.depth == 0u && !(HAS_CATCHERS && s.path.alone)) s.estimate = estimate_begin();
    s.shadow_alone = s.path.alone;
    s.alive = path_step(s.path, s.estimate, s.shadow, hit, s.random, parameters);
    s.rays += s.shadow.t_max > 0.0 ? 2u : 1u;
    s.ended = !s.alive;
}

void render_pixel() {
    uvec2 group = gl_WorkGroupID.xy * tile.stride % gl_NumWorkGroups.xy;
    uvec2 at = group * WORKGROUP_SIZE + gl_LocalInvocationID.xy;
    if (any(greaterThanEqual(at, tile.size))) return;
    at += tile.origin;
    Parameters parameters = scene_parameters();

    Pixel pixel = pixel_load(at);
    uint before = pixel.samples;
    uint target = pixel_target(pixel, tile.target_samples);
    if (before >= target) return;

    bvh_prepare();
    light_prepare();

    // One vertex per iteration: a lane whose path has ended begins its next sample while its neighbours go on; the ray
    // traced after the last shadow ray of the ended path is that of the next sample.
    //
    // Each step of a sample is in the code only once: the compiler might round differently in a copy, and a sample's
    // bits must not depend on its place in a dispatch.
    //
    // Lavapipe ends all loops of an invocation after 65 535 iterations in total, regardless of their conditions. A
    // sample that is not folded by then is dropped, and the next dispatch traces it again.
    Sample s = sample_none();
    uint begun = before;  // Samples begun; pixel.samples of them are folded.
    uint rays = 0u;       // Rays of the folded samples.
    while (pixel.samples < target) {
        bool again = HAS_CATCHERS && s.ended && !s.path.alone && s.estimate.catcher != CATCHER_NONE;
        if (!s.alive && (again || begun < target)) {
            if (!again) ++begun;
            sample_begin(s, parameters, parameters.crop + at, parameters.first_sample + begun - 1u, again);
        }
        TraceResult met = sample_trace(s);
        if (!met.complete) break;
        if (met.lit) s.estimate.L += s.shadow.Ld;
        if (again) {
            estimate_turn(s.estimate);
        } else if (s.ended) {
            pixel_fold(pixel, s.estimate);
            rays += s.rays;
            s.rays = 0u;
        }
        if (s.alive) sample_step(s, met.hit, parameters);
    }
    count_rays(rays);
    if (pixel.samples < target) count(COUNTER_UNFINISHED, 1u);
    count(COUNTER_SAMPLES, pixel.samples - before);
    pixel.rays = min(pixel.rays + float(rays), MAX_RAYS);
    pixel_store(at, pixel);
}

void render_main() {
    if (GROUP_COUNTERS) {
        if (gl_LocalInvocationIndex < COUNTER_COUNT) group_counters[gl_LocalInvocationIndex] = 0u;
        if (gl_LocalInvocationIndex == 0u) group_finished = 0u;
        barrier();
    }
    render_pixel();
    if (GROUP_COUNTERS) flush_counters();
}

#endif
