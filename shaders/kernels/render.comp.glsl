// Brings every pixel of a tile to a number of samples: each invocation traces one path after the other for its pixel
// and folds it into the accumulation image. Which samples a pixel still needs, its own count says, so that any cut of
// the work into tiles and dispatches gives the same bits.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "integrator/path.glsl"
#include "scene/camera.glsl"

layout(local_size_x = WORKGROUP_SIZE, local_size_y = WORKGROUP_SIZE) in;

layout(constant_id = CONSTANT_HAS_AOVS) const bool HAS_AOVS = true;

layout(binding = BINDING_IMAGE, rgba32f) uniform image2DArray accumulation;
layout(std430, binding = BINDING_COUNTERS) buffer CountersBlock { uint counters[COUNTER_COUNT]; };
layout(push_constant) uniform TileBlock { Tile tile; };

vec4 layer_load(uvec2 at, uint layer) {
    return imageLoad(accumulation, ivec3(at, layer));
}

void layer_store(uvec2 at, uint layer, vec4 value) {
    imageStore(accumulation, ivec3(at, layer), value);
}

void count_rays(uint rays) {
    uint before = atomicAdd(counters[COUNTER_RAYS_LOW], rays);
    if (before + rays < before) atomicAdd(counters[COUNTER_RAYS_HIGH], 1u);
}

void main() {
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, tile.size))) return;
    uvec2 at = tile.origin + gl_GlobalInvocationID.xy;
    Parameters parameters = scene_parameters();
    uvec2 pixel = parameters.crop + at;

    vec4 sum = layer_load(at, LAYER_L);
    vec4 compensation = layer_load(at, LAYER_L_COMPENSATION);
    vec3 square_sum = layer_load(at, LAYER_SQUARE).rgb;
    vec3 square_compensation = layer_load(at, LAYER_SQUARE_COMPENSATION).rgb;
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

    // One vertex per turn: a lane whose path has ended begins its next sample while its neighbours go on.
    //
    // A path is folded in the turn after its last vertex. Lavapipe ends all loops of an invocation after 65 535 turns
    // in sum, whatever their conditions say, so that the last turn may have gone wrong: such a path is dropped here,
    // and traced again by the next dispatch.
    uint rays = 0u;
    uint n = uint(compensation.a);
    Sampler random;
    Path path;
    bool alive = false;  // The path goes on.
    bool ended = false;  // The path waits to be folded.
    while (true) {
        if (ended) {
            // A sample whose value or square is not finite adds zero and is counted.
            if (!is_finite(path.L * path.L)) {
                atomicAdd(counters[COUNTER_NONFINITE], 1u);
                path.L = vec3(0.0);
            }
            if (path.cut) atomicAdd(counters[COUNTER_DEPTH_LIMIT], 1u);
            rays += path.rays;
            compensated_add(sum.rgb, compensation.rgb, path.L);
            compensated_add(square_sum, square_compensation, path.L * path.L);
            sum.a += path.visible ? 1.0 : 0.0;
            if (HAS_AOVS) {
                compensated_add(albedo_sum, albedo_compensation, path.albedo);
                compensated_add(normal_sum, normal_compensation, path.normal);
            }
            ++n;
        }
        if (n >= tile.target_samples) break;
        if (!alive) {
            random = sampler_make(pixel, n, parameters.seed);
            vec2 film = vec2(pixel) + unit_float(sampler_pair(random, PAIR_PIXEL));
            path = path_begin(camera_ray(parameters, film, unit_float(sampler_pair(random, PAIR_LENS))));
        }
        alive = path_step(path, random, parameters);
        ended = !alive;
    }
    count_rays(rays);
    if (n < tile.target_samples) atomicAdd(counters[COUNTER_UNFINISHED], 1u);
    atomicAdd(counters[COUNTER_SAMPLES], n - uint(compensation.a));
    compensation.a = float(n);

    layer_store(at, LAYER_L, sum);
    layer_store(at, LAYER_L_COMPENSATION, compensation);
    layer_store(at, LAYER_SQUARE, vec4(square_sum, 0.0));
    layer_store(at, LAYER_SQUARE_COMPENSATION, vec4(square_compensation, 0.0));
    if (HAS_AOVS) {
        layer_store(at, LAYER_ALBEDO, vec4(albedo_sum, 0.0));
        layer_store(at, LAYER_ALBEDO_COMPENSATION, vec4(albedo_compensation, 0.0));
        layer_store(at, LAYER_NORMAL, vec4(normal_sum, 0.0));
        layer_store(at, LAYER_NORMAL_COMPENSATION, vec4(normal_compensation, 0.0));
    }
}
