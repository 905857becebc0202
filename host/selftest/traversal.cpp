// See traversal.h.
#include "selftest/traversal.h"

#include <algorithm>

#include "base/text.h"
#include "probe/random.h"
#include "probe/scenes.h"

namespace candela {

namespace {

void append(Rays& rays, const Rays& more) {
    rays.insert(rays.end(), more.begin(), more.end());
}

// Compares with brute force through both kinds of buffers. Returns how many rays missed.
size_t test_rays(const vk::Device& device, const TriangleMesh& mesh, const Rays& rays, Evidence& evidence) {
    const GpuScene scene = build_gpu_scene(scene_of_mesh(mesh), SceneFrame{});
    size_t escapes = 0;
    for (const SceneAccess access : {SceneAccess::texel_buffers, SceneAccess::storage_buffers}) {
        const std::vector<TraversalResult> results = trace(device, scene, rays, access);
        evidence.add(compare_with_brute_force(results));
        escapes += results.size() - hits(results);
    }
    return escapes;
}

}  // namespace

void add(Rays& rays, vec3 o, vec3 d) {
    rays.push_back({o, 0.0f, d, 0.0f});
}

Rays random_rays(size_t count, vec3 centre, float size, uint32_t seed) {
    Random random(seed);
    Rays rays;
    while (rays.size() < count) {
        const vec3 o = centre + size * random.cube();
        add(rays, o, random.direction());
    }
    return rays;
}

Rays rays_at_features(const TriangleMesh& mesh, size_t count, vec3 centre, float size, uint32_t seed) {
    Random random(seed);
    Rays rays;
    while (rays.size() < count) {
        const uvec3 t = mesh.triangles[random.bits() % mesh.triangles.size()];
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const vec3 o = centre + size * random.cube();
        add(rays, o, normalize(a - o));
        add(rays, o, a - o);  // Not of unit length: the vertex is hit at t = 1.
        add(rays, o, normalize(0.5f * (a + b) - o));
        add(rays, o, normalize((a + b + c) / 3.0f - o));
    }
    return rays;
}

std::vector<TraversalResult> trace(const vk::Device& device, const GpuScene& scene, const Rays& rays,
                                   SceneAccess access) {
    const DeviceScene on_device(device, scene, access);
    return probe<TraversalResult>(device, kernels::traversal, rays, traversal_constants(scene), &on_device);
}

Evidence compare_with_brute_force(const std::vector<TraversalResult>& results) {
    Evidence evidence;
    for (size_t i = 0; i < results.size(); ++i) {
        const TraversalResult& r = results[i];
        const uint32_t hit = r.t < NO_HIT;
        evidence.expect(r.t == r.brute_t && r.id == r.brute_id && r.occluded_before == 0 &&
                            r.occluded_at == hit && r.occluded == hit,
                        [&] {
                            return concat("ray ", i, ": t ", r.t, ", primitive ", r.id,
                                          "; brute force: ", r.brute_t, ", ", r.brute_id,
                                          "; occluded before, at, anywhere: ", r.occluded_before,
                                          r.occluded_at, r.occluded);
                        });
    }
    return evidence;
}

Evidence test_closed_meshes(const vk::Device& device, Effort effort) {
    struct Place {
        vec3 centre;
        float scale;
    };
    Evidence evidence;
    for (const auto& [centre, scale] : {Place{vec3(0), 1.0f}, Place{vec3(0), 1e-4f}, Place{vec3(0), 1e5f},
                                        Place{vec3(1000, -2000, 3000), 1.0f}}) {
        const TriangleMesh mesh =
            transformed(sphere_mesh(16, 24), [&, c = centre, s = scale](vec3 p) { return c + s * p; });
        Rays rays = random_rays(sized(effort, 2000), centre, 0.5f * scale, 15);
        append(rays, rays_at_features(mesh, sized(effort, 8000), centre, 0.5f * scale, 16));
        for (const int axis : {0, 1, 2}) {
            for (const float sign : {-1.0f, 1.0f}) {
                vec3 d(0.0f);
                d[axis] = sign;
                add(rays, centre, d);
            }
        }
        const size_t escapes = test_rays(device, mesh, rays, evidence);
        evidence.expect(escapes == 0, [&, s = scale] {
            return concat(escapes, " of ", 2 * rays.size(), " rays escape from a mesh of size ", s);
        });
    }
    return evidence;
}

Evidence test_nasty_mesh(const vk::Device& device, Effort effort) {
    const TriangleMesh mesh = nasty_mesh(1600);
    Rays rays;
    for (const float scale : {1e-3f, 1e-1f, 1e1f, 1e3f}) {
        append(rays, random_rays(sized(effort, 1250), vec3(0), scale, 22));
        append(rays, rays_at_features(mesh, sized(effort, 3750), vec3(0), scale, 23));
    }
    Evidence evidence;
    test_rays(device, mesh, rays, evidence);
    return evidence;
}

size_t hits(const std::vector<TraversalResult>& results) {
    return size_t(std::count_if(results.begin(), results.end(), [](const auto& r) { return r.t < NO_HIT; }));
}

}  // namespace candela
