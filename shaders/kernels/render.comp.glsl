// Brings every pixel of a tile to a number of samples, or to the pixel's limit if that is less: each invocation traces
// one path after the other for its pixel and folds it into the accumulation image. Which samples a pixel still needs,
// its own count says, so that any cut of the work into tiles and dispatches gives the same bits.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "integrator/path.glsl"
#include "scene/camera.glsl"

layout(local_size_x = WORKGROUP_SIZE, local_size_y = WORKGROUP_SIZE) in;

layout(binding = BINDING_IMAGE, rgba32f) uniform image2DArray accumulation;
layout(std430, binding = BINDING_COUNTERS) buffer CountersBlock { uint counters[COUNTER_COUNT]; };
layout(push_constant) uniform TileBlock { Tile tile; };

vec4 layer_load(uvec2 at, uint layer) {
    return imageLoad(accumulation, ivec3(at, layer));
}

void layer_store(uvec2 at, uint layer, vec4 value) {
    imageStore(accumulation, ivec3(at, layer), value);
}

// What the invocations of a work group have counted, if GROUP_COUNTERS: on a GPU they would queue for the same words of
// the buffer.
shared uint group_counters[COUNTER_COUNT];
shared uint group_finished;  // Invocations that have nothing more to count.

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

// The last invocation of the group to come here adds the group's counts to the counters. (One invocation for each
// counter would have to keep its number while it traces, in a register.)
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

void render_pixel() {
    uvec2 group = gl_WorkGroupID.xy * tile.stride % gl_NumWorkGroups.xy;
    uvec2 at = group * WORKGROUP_SIZE + gl_LocalInvocationID.xy;
    if (any(greaterThanEqual(at, tile.size))) return;
    at += tile.origin;
    Parameters parameters = scene_parameters();
    uvec2 pixel = parameters.crop + at;

    vec4 sum = layer_load(at, LAYER_L);
    vec4 compensation = layer_load(at, LAYER_L_COMPENSATION);
    vec4 square_sum = layer_load(at, LAYER_SQUARE);
    vec4 square_compensation = layer_load(at, LAYER_SQUARE_COMPENSATION);
    vec3 albedo_sum = vec3(0.0);
    vec3 albedo_compensation = vec3(0.0);
    vec3 normal_sum = vec3(0.0);
    vec3 normal_compensation = vec3(0.0);
    if (HAS_AOVS) {
        albedo_sum = layer_load(at, LAYER_ALBEDO).rgb;
        albedo_compensation = layer_load(at, LAYER_ALBEDO_COMPENSATION).rgb;
        normal_sum = layer_load(at, LAYER_NORMAL).rgb;
        normal_compensation = layer_load(at, LAYER_NORMAL_COMPENSATION).rgb;
    }
    uint first = uint(compensation.a);
    uint target = square_sum.a > 0.0 ? min(tile.target_samples, uint(square_sum.a) - 1u) : tile.target_samples;
    if (first >= target) return;

    bvh_prepare();
    light_prepare();

    // One vertex per turn: a lane whose path has ended begins its next sample while its neighbours go on. The shadow
    // ray of a vertex and the path's next ray are traced one after the other, without waiting for the neighbours in
    // between; if the path has ended, the next ray is the next sample's.
    //
    // There is one place for everything that a sample goes through: the compiler may round differently in another, and
    // a sample's bits must not depend on where in a dispatch it comes.
    //
    // Lavapipe ends all loops of an invocation after 65 535 turns in sum, whatever their conditions say. What is not
    // folded then is dropped, and traced again by the next dispatch.
    uint n = first;         // Samples folded, the first of which has the index parameters.first_sample,
    uint started = first;   // and begun.
    uint rays = 0u;         // Of the samples folded,
    uint sample_rays = 0u;  // and of the one on its way.
    Sampler random;
    Path path;
    Estimate estimate;
    ShadowRay shadow = shadow_none();
    bool alive = false;  // The path goes on.
    bool ended = false;  // The sample's path has ended; its shadow ray may still be on its way.
    while (n < target) {
        if (!alive && started < target) {
            random = sampler_make(pixel, parameters.first_sample + started, parameters.seed);
            vec2 film = vec2(pixel) + unit_float(sampler_pair(random, PAIR_PIXEL));
            path = path_begin(camera_ray(parameters, film, unit_float(sampler_pair(random, PAIR_LENS))));
            alive = true;
            ++started;
        }

        bool shadowed = shadow.t_max > 0.0;
        Ray next = path.ray;
        if (shadowed) next = shadow.ray;
        Traversal traversal = bvh_begin(next, shadowed ? shadow.t_max : FLOAT_MAX, shadowed);
        if (!shadowed && !alive) bvh_end(traversal);
        bool lit = false;
        while (!bvh_ended(traversal)) {
            bvh_advance(traversal);
            if (traversal.any_hit && bvh_ended(traversal)) {
                lit = traversal.hit.t == shadow.t_max;
                if (alive) traversal = bvh_begin(path.ray, FLOAT_MAX, false);
            }
        }
        if (!bvh_ended(traversal)) break;
        if (lit) estimate.L += shadow.Ld;

        if (ended) {
            // A sample whose value or square is not finite adds zero and is counted.
            if (!is_finite(estimate.L * estimate.L)) {
                count(COUNTER_NONFINITE, 1u);
                estimate.L = vec3(0.0);
            }
            if (estimate.cut) count(COUNTER_DEPTH_LIMIT, 1u);
            compensated_add(sum.rgb, compensation.rgb, estimate.L);
            compensated_add(square_sum.rgb, square_compensation.rgb, estimate.L * estimate.L);
            sum.a += estimate.visible ? 1.0 : 0.0;
            if (HAS_AOVS) {
                compensated_add(albedo_sum, albedo_compensation, estimate.albedo);
                compensated_add(normal_sum, normal_compensation, estimate.normal);
            }
            rays += sample_rays;
            sample_rays = 0u;
            ++n;
        }
        if (alive) {
            if (path.depth == 0u) estimate = estimate_begin();
            alive = path_step(path, estimate, shadow, traversal.hit, random, parameters);
            sample_rays += shadow.t_max > 0.0 ? 2u : 1u;
            ended = !alive;
        }
    }
    count_rays(rays);
    if (n < target) count(COUNTER_UNFINISHED, 1u);
    count(COUNTER_SAMPLES, n - first);
    compensation.a = float(n);
    square_compensation.a = min(square_compensation.a + float(rays), MAX_RAYS);

    layer_store(at, LAYER_L, sum);
    layer_store(at, LAYER_L_COMPENSATION, compensation);
    layer_store(at, LAYER_SQUARE, square_sum);
    layer_store(at, LAYER_SQUARE_COMPENSATION, square_compensation);
    if (HAS_AOVS) {
        layer_store(at, LAYER_ALBEDO, vec4(albedo_sum, 0.0));
        layer_store(at, LAYER_ALBEDO_COMPENSATION, vec4(albedo_compensation, 0.0));
        layer_store(at, LAYER_NORMAL, vec4(normal_sum, 0.0));
        layer_store(at, LAYER_NORMAL_COMPENSATION, vec4(normal_compensation, 0.0));
    }
}

void main() {
    if (GROUP_COUNTERS) {
        if (gl_LocalInvocationIndex < COUNTER_COUNT) group_counters[gl_LocalInvocationIndex] = 0u;
        if (gl_LocalInvocationIndex == 0u) group_finished = 0u;
        barrier();
    }
    render_pixel();
    if (GROUP_COUNTERS) flush_counters();
}
