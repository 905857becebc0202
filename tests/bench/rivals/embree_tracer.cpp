// The rival in `candela bench` of rays, if the program is built with it; see bench/tracer.h.
#include <atomic>
#include <new>
#include <thread>

#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include "bench/tracer.h"

namespace candela {
namespace {

// Rays in a thread's chunk of work.
constexpr size_t CHUNK = 4096;

RTCRay embree_ray(const BenchRay& ray) {
    RTCRay r{};
    r.org_x = ray.o.x;
    r.org_y = ray.o.y;
    r.org_z = ray.o.z;
    r.dir_x = ray.d.x;
    r.dir_y = ray.d.y;
    r.dir_z = ray.d.z;
    r.tfar = ray.t_max;
    r.mask = ~0u;
    return r;
}

uint32_t any(RTCScene scene, RTCIntersectContext& context, const BenchRay& ray) {
    RTCRay query = embree_ray(ray);
    rtcOccluded1(scene, &context, &query);
    return query.tfar < 0.0f ? ANY_HIT : NO_TRIANGLE;  // Embree sets tfar to minus infinity at a hit.
}

RTCScene scene_of(RTCDevice device, std::span<const BenchTriangle> triangles) {
    RTCScene scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const vertices = static_cast<vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), 3 * triangles.size()));
    auto* const indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3), triangles.size()));
    if (vertices == nullptr || indices == nullptr) throw std::bad_alloc();
    for (size_t i = 0; i < triangles.size(); ++i) {
        vertices[3 * i] = triangles[i].a;
        vertices[3 * i + 1] = triangles[i].b;
        vertices[3 * i + 2] = triangles[i].c;
    }
    for (size_t i = 0; i < 3 * triangles.size(); ++i)
        indices[i] = uint32_t(i);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    return scene;
}

void attach_instance(RTCDevice device, RTCScene scene, RTCScene mesh,
                     const BenchTriangles::Instance& instance) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, mesh);
    const glm::mat4x3 transform(vec3(instance.to_scene[0]), vec3(instance.to_scene[1]),
                                vec3(instance.to_scene[2]), instance.centre);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &transform);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

// Geometry 0 of its scene has the baked triangles; geometry i + 1 is instance i.
class EmbreeTracer : public RayTracer {
  public:
    explicit EmbreeTracer(const BenchTriangles& triangles)
        : device_(rtcNewDevice(nullptr)),
          scene_(scene_of(device_, triangles.baked())),
          triangles_(&triangles) {
        for (const std::vector<BenchTriangle>& mesh : triangles.meshes()) {
            meshes_.push_back(scene_of(device_, mesh));
            rtcCommitScene(meshes_.back());
        }
        for (const BenchTriangles::Instance& instance : triangles.instances())
            attach_instance(device_, scene_, meshes_[instance.mesh], instance);
        rtcCommitScene(scene_);  // Medium quality, the default.
    }
    ~EmbreeTracer() override {
        rtcReleaseScene(scene_);
        for (RTCScene mesh : meshes_)
            rtcReleaseScene(mesh);
        rtcReleaseDevice(device_);
    }

    void prepare(const RaySet& set) override {
        set_ = &set;
        results_.assign(set.rays.size(), NO_TRIANGLE);
    }

    Clocks trace(uint32_t repeats) override {
        const Stopwatch watch;
        std::atomic<size_t> next{0};
        std::vector<std::jthread> threads;
        for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
            threads.emplace_back([&] { trace_chunks(next, repeats); });
        threads.clear();
        return watch.elapsed();
    }

    std::vector<uint32_t> results() const override { return results_; }

  private:
    uint32_t closest(RTCIntersectContext& context, const BenchRay& ray) const {
        RTCRayHit query{embree_ray(ray), {}};
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return NO_TRIANGLE;
        if (query.hit.instID[0] == RTC_INVALID_GEOMETRY_ID) return query.hit.primID;
        return triangles_->instances()[query.hit.instID[0] - 1].first_id + query.hit.primID;
    }

    // Traces chunks, counted over all repeats, until none are left.
    void trace_chunks(std::atomic<size_t>& next, uint32_t repeats) {
        // As Embree's manual recommends.
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags =
            set_->coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        const size_t count = set_->rays.size();
        const size_t chunks = (count + CHUNK - 1) / CHUNK;
        for (size_t chunk = next++; chunk < chunks * repeats; chunk = next++) {
            const size_t first = chunk % chunks * CHUNK;
            const size_t end = std::min(first + CHUNK, count);
            if (set_->any_hit) {
                for (size_t i = first; i < end; ++i)
                    results_[i] = any(scene_, context, set_->rays[i]);
            } else {
                for (size_t i = first; i < end; ++i)
                    results_[i] = closest(context, set_->rays[i]);
            }
        }
    }

    RTCDevice device_;
    RTCScene scene_;
    const BenchTriangles* triangles_;
    std::vector<RTCScene> meshes_;
    const RaySet* set_ = nullptr;
    std::vector<uint32_t> results_;
};

}  // namespace

std::unique_ptr<RayTracer> make_embree_tracer(const BenchTriangles& triangles) {
    return std::make_unique<EmbreeTracer>(triangles);
}

std::optional<std::string> embree_version() {
    return "Embree " RTC_VERSION_STRING;
}

}  // namespace candela
