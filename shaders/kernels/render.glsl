// Brings every pixel of a tile to a number of samples, or to the pixel's limit if that is less: each invocation traces
// one path after the other for its pixel and folds it into the accumulation image. A pixel's own count determines which
// samples it still needs, so that any division of the work into tiles and dispatches gives the same bits.
//
// One iteration of a lane's loop, for a path on its way to vertex k:
//     trace the shadow ray of vertex k - 1, then the path's ray to vertex k
//     if the shadow ray passed an interface: go on with it in the next iteration, before all that follows
//     add the direct light of vertex k - 1; if the path ended there, fold the sample
//     shade vertex k, which yields its shadow ray and the path's next ray
// For a new sample, "vertex k - 1" is the last one of the sample before. A sample that hits a catcher first is begun
// twice: with everything there, and then with catchers, sky and lights alone.
#ifndef KERNELS_RENDER_GLSL
#define KERNELS_RENDER_GLSL

#include "integrator/path.glsl"
#include "integrator/walk.glsl"
#include "kernels/pixel.glsl"
#include "scene/camera.glsl"

layout(local_size_x = WORKGROUP_SIZE, local_size_y = WORKGROUP_SIZE) in;

layout(push_constant) uniform TileBlock {
    Tile tile;
};

// Steps of a walk that a lane takes before others go on.
const uint WALK_STEPS = 16u;

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
    // Only if VOLUMETRIC: the shadow ray goes on beyond an interface, while the path's ray has been traced. The rest
    // then waits, with what the ray hit.
    bool waits;
    Hit hit;
    bool walked;  // Only if WALKS: the path has not come to a surface; its next ray is still to be traced.
};

// No sample yet.
Sample sample_none() {
    Sample s;
    s.shadow = shadow_none();
    s.alive = false;
    s.ended = false;
    s.rays = 0u;
    s.shadow_alone = false;
    s.waits = false;
    s.hit = hit_none(FLOAT_MAX);
    s.walked = false;
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
    uint depth;     // Optical depth of what it has passed, in parts; only if HAS_OPACITY.
    Hit hit;        // The hit of the path's ray, if the path continues.
    Hit shadow;     // The nearest hit of the shadow ray, if there is one; only if VOLUMETRIC.
};

// Any hit of a shadow ray blocks it, unless it may be on an interface.
bool is_shadow(Traversal traversal, bool shadowing) {
    return VOLUMETRIC ? shadowing : traversal.any_hit;
}

// Advances the traversal; once that of a shadow ray has ended, begins that of the path's next ray, if there is one.
void sample_advance(Sample s, float t_max, inout Traversal traversal, inout bool shadowing, inout TraceResult met) {
    bvh_advance(traversal);
    if (is_shadow(traversal, shadowing) && bvh_ended(traversal)) {
        met.lit = !is_hit(traversal.hit);
        if (VOLUMETRIC) met.shadow = traversal.hit;
        if (HAS_OPACITY) met.depth = traversal.depth;
        if (HAS_PASSABLE) traversal.any_hit = false;
        shadowing = false;
        uint iterations = traversal.iterations;
        if (s.alive && !(VOLUMETRIC && s.waits)) traversal = bvh_begin(s.path.ray, t_max, false);
        if (VOLUMETRIC) traversal.iterations = iterations;
        if (HAS_CATCHERS) traversal.alone = s.path.alone;
        if (HAS_HIDDEN) traversal.of_camera = s.path.depth == 0u;
    }
}

// What the path meets on its next segment if it walks, before what is in its way is known; also how far to trace it.
bool sample_walks(Sample s, Parameters parameters, out MediumSample way, out float t_max) {
    t_max = FLOAT_MAX;
    if (!WALKS || !s.alive || s.waits || !path_walks(s.path, s.estimate, parameters)) return false;
    way = path_medium_sample(s.path, FLOAT_MAX, s.random);
    if (way.scattered) t_max = way.t;
    return way.scattered;
}

// Traces the shadow ray of a vertex and the path's next ray, one after the other, without waiting for neighbouring
// lanes in between. A path that walks takes up to WALK_STEPS steps before it comes to a surface.
TraceResult sample_trace(inout Sample s, Parameters parameters) {
    bool shadowed = s.shadow.t_max > 0.0;
    bool shadowing = shadowed;
    MediumSample way;
    float t_max;
    bool walks = sample_walks(s, parameters, way, t_max);
    uint steps = 0u;
    Ray first = s.path.ray;
    if (shadowed) first = s.shadow.ray;
    Traversal traversal = bvh_begin(first, shadowed ? s.shadow.t_max : t_max, shadowed && !VOLUMETRIC);
    if (HAS_CATCHERS) traversal.alone = shadowed ? s.shadow_alone : s.path.alone;
    if (HAS_HIDDEN) traversal.of_camera = !shadowed && s.path.depth == 0u;
    if (!shadowed && !s.alive) bvh_end(traversal);
    TraceResult met = TraceResult(false, false, 0u, traversal.hit, traversal.hit);
    if (WALKS && !s.waits) s.walked = false;
    if (HAS_PASSABLE || WALKS) {
        // On software Vulkan, code in a branch takes its time even if no lane takes the branch. So the decision about
        // opacity, and the steps of a walk, are in an outer loop, at whose end lanes wait for each other once more.
        bool more;
        do {
            while (!bvh_waits(traversal) && (is_shadow(traversal, shadowing) || !bvh_ended(traversal))) {
                sample_advance(s, t_max, traversal, shadowing, met);
            }
            bvh_decide(traversal);
            more = is_shadow(traversal, shadowing) || !bvh_ended(traversal);
            if (WALKS && !more && walks && !is_hit(traversal.hit)) {
                s.path.iterations += traversal.iterations + 2u;
                s.alive = path_walk(s.path, way, s.random, parameters);
                ++s.rays;
                ++steps;
                more = walks = steps < WALK_STEPS && sample_walks(s, parameters, way, t_max);
                s.walked = !more;
                if (more) traversal = bvh_begin(s.path.ray, t_max, false);  // It has scattered: no camera ray.
            }
        } while (more);
    } else {
        while (!bvh_ended(traversal))
            sample_advance(s, t_max, traversal, shadowing, met);
    }
    bool turned = !(HAS_PASSABLE && is_shadow(traversal, shadowing));  // To the path's ray, if there is one.
    met.complete = turned && bvh_ended(traversal);
    // A shadow ray before the first segment is that of the sample before.
    if (VOLUMETRIC && s.path.depth + s.path.crossed > 0u) {
        s.path.iterations += traversal.iterations + ITERATIONS_PER_VERTEX;
    }
    met.hit = traversal.hit;
    if (VOLUMETRIC && s.waits) met.hit = s.hit;
    return met;
}

// Advances the path past the hit of its ray, or past its miss.
void sample_step(inout Sample s, Hit hit, Parameters parameters) {
    bool first = s.path.depth == 0u && !(VOLUMETRIC && s.path.crossed > 0u);
    if (first && !(HAS_CATCHERS && s.path.alone)) s.estimate = estimate_begin();
    s.shadow_alone = s.path.alone;
    s.alive = path_step(s.path, s.estimate, s.shadow, hit, s.random, parameters);
    s.rays += s.shadow.t_max > 0.0 ? 2u : 1u;
    s.ended = !s.alive;
}

void render_pixel() {
    uvec2 group = gl_WorkGroupID.xy * tile.stride % gl_NumWorkGroups.xy;
    uvec2 at = group * WORKGROUP_SIZE + gl_LocalInvocationID.xy;
    if (any(greaterThanEqual(at, tile.size))) return;
    if (VOLUMETRIC && tile.lane != LANES && gl_LocalInvocationIndex % LANES != tile.lane) return;
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
    // Lavapipe ends all loops of its lanes after 65 535 iterations in total, regardless of their conditions. A sample
    // that is not folded by then is dropped, and the next dispatch traces it again; at last alone, without the
    // iterations that only the neighbours need.
    Sample s = sample_none();
    uint begun = before;  // Samples begun; pixel.samples of them are folded.
    uint rays = 0u;       // Rays of the folded samples.
    bool again = false;   // The sample's second path begins, without the rest of the scene.
    while (pixel.samples < target) {
        if (!(VOLUMETRIC && s.waits)) {
            again = HAS_CATCHERS && s.ended && !s.path.alone && s.estimate.catcher != CATCHER_NONE;
        }
        if (!s.alive && !(VOLUMETRIC && s.waits) && (again || begun < target)) {
            if (!again) ++begun;
            sample_begin(s, parameters, parameters.crop + at, parameters.first_sample + begun - 1u, again);
        }
        TraceResult met = sample_trace(s, parameters);
        if (!met.complete) break;
        if (VOLUMETRIC) {
            s.waits = shadow_goes_on(s.shadow, met.shadow);
            if (s.waits) {
                s.hit = met.hit;
                ++s.rays;
                continue;
            }
        }
        if (HAS_OPACITY) s.shadow.Ld *= passed_fraction(met.depth);
        if (met.lit) s.estimate.L += s.shadow.Ld;
        if (again) {
            estimate_turn(s.estimate);
        } else if (s.ended) {
            pixel_fold(pixel, s.estimate);
            rays += s.rays;
            s.rays = 0u;
        }
        if (WALKS && s.walked) {
            s.shadow.t_max = 0.0;
            s.ended = !s.alive;
        } else if (s.alive) {
            sample_step(s, met.hit, parameters);
        }
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
