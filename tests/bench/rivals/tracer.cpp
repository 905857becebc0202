// A minimal scalar path tracer over Embree 3, with which candela is compared. It renders candela's scenes
// with light samples and BSDF samples under multiple importance sampling, independent random numbers, and
// Russian roulette.
//
// usage: tracer SCENE OUT.exr WIDTH SPP MAX_DEPTH RR_DEPTH SEED THREADS
//
// Prints JSON: CPU time and wall time of the rendering alone [s], rays per sample.
#include <atomic>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>
#include <thread>

#include <pmmintrin.h>
#include <xmmintrin.h>

#include "base/error.h"
#include "image/image_io.h"
#include "load/load.h"
#include "tracer_materials.h"
#include "tracer_scene.h"

namespace candela::bench {
namespace {

struct Settings {
    std::string scene, output;
    uint32_t width = 0;  // And height.
    uint32_t spp = 0, max_depth = 0, rr_depth = 0, seed = 0, threads = 0;
};

struct Ray {
    vec3 o, d;
};

// A camera without its lens.
struct Pinhole {
    Pinhole(const Camera& camera, uint32_t width) : position(camera.position) {
        const float reach = std::tan(0.5f * camera.vertical_fov), pixel = 2.0f * reach / float(width);
        const vec3 forward(normalize(camera.look_at - camera.position));
        const vec3 r = normalize(cross(forward, camera.up)), u = cross(r, forward);
        corner = forward - reach * r + reach * u;
        right = pixel * r;
        down = -pixel * u;
    }
    Ray ray(float x, float y) const { return {position, normalize(corner + x * right + y * down)}; }

    vec3 position, corner, right, down;
};

float max_component(vec3 v) {
    return std::max(v.x, std::max(v.y, v.z));
}

// Veach's power heuristic.
float weight(float pdf, float other) {
    return pdf * pdf / (pdf * pdf + other * other);
}

class Tracer {
  public:
    Tracer(const TracerScene& scene, const Settings& settings)
        : scene_(scene), settings_(settings), gap_(4e-6f * scene.diagonal) {}

    // Radiance along a ray from the camera; counts rays.
    vec3 radiance(Ray ray, Random& random);

    uint64_t rays = 0;

  private:
    // The state of a path between vertices.
    struct Path {
        Ray ray;
        vec3 beta{1};
        float eta_scale =
            1.0f;  // Product of the squared relative indices of refraction, by which beta was divided.
        vec3 L{0};
        float pdf = 0.0f;  // Density of the ray's direction [1/sr]; 0: light samples cannot find what it
                           // hits.
    };
    struct Vertex {
        vec3 p, wo, n, ns;  // Normals on the viewer's side; n is geometric.
        bool front;
        const Surface* surface;
    };

    bool intersect(Path& path, Vertex& vertex);
    bool occluded(vec3 from, vec3 d, float distance);
    vec3 direct_light(const Vertex& vertex, const Frame& frame, vec3 wo, Random& random);
    bool scatter(Path& path, const Vertex& vertex, const Frame& frame, vec3 wo, Random& random) const;

    const TracerScene& scene_;
    const Settings& settings_;
    const float gap_;  // Between a surface and the rays that leave it [m].
};

// Finds the next vertex and adds what it emits, or what the sky does; returns whether the path goes on there.
bool Tracer::intersect(Path& path, Vertex& vertex) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    const auto [o, d] = path.ray;
    RTCRayHit query;
    query.ray = {o.x, o.y, o.z, 0.0f, d.x, d.y, d.z, 0.0f, INFINITE, ~0u, 0u, 0u};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.embree, &context, &query);
    ++rays;
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        const EnvironmentTexel sky = scene_.environment(d);
        path.L += path.beta * sky.radiance * (path.pdf > 0.0f ? weight(path.pdf, sky.pdf) : 1.0f);
        return false;
    }
    const Triangle& triangle = scene_.triangles[query.hit.primID];
    const float t = query.ray.tfar, u = query.hit.u, v = query.hit.v;
    const vec3 n = normalize(cross(triangle.p[1] - triangle.p[0], triangle.p[2] - triangle.p[0]));
    const float cosine = -dot(d, n);
    vertex.front = cosine > 0.0f;
    if (triangle.lamp != NO_LAMP && vertex.front) {
        const Lamp& lamp = scene_.lamps[triangle.lamp];
        const float pdf_light = lamp.pdf_area * t * t / cosine;
        path.L += path.beta * lamp.radiance * (path.pdf > 0.0f ? weight(path.pdf, pdf_light) : 1.0f);
    }
    vertex.surface = &scene_.surfaces[triangle.surface];
    if (vertex.surface->colour == vec3(0)) return false;
    const vec3 ns = normalize((1.0f - u - v) * triangle.n[0] + u * triangle.n[1] + v * triangle.n[2]);
    vertex.p = o + t * d;
    vertex.wo = -d;
    vertex.n = vertex.front ? n : -n;
    vertex.ns = dot(ns, vertex.n) < 0.0f ? -ns : ns;
    return true;
}

bool Tracer::occluded(vec3 from, vec3 d, float distance) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray{from.x, from.y, from.z, 0.0f, d.x, d.y, d.z, 0.0f, 0.9995f * distance, ~0u, 0u, 0u};
    rtcOccluded1(scene_.embree, &context, &ray);
    ++rays;
    return ray.tfar < 0.0f;
}

// Direct light by one light sample, weighted.
vec3 Tracer::direct_light(const Vertex& vertex, const Frame& frame, vec3 wo, Random& random) {
    const vec3 from = vertex.p + gap_ * vertex.n;
    const LightSample light = scene_.sample_light(from, random);
    if (light.pdf == 0.0f || dot(light.wi, vertex.n) <= 0.0f) return vec3(0);
    const vec3 wi = frame.to_local(light.wi);
    if (wi.z <= 0.0f) return vec3(0);
    const BsdfValue value = bsdf_value(*vertex.surface, wo, wi);
    if (value.pdf == 0.0f || occluded(from, light.wi, light.distance)) return vec3(0);
    return value.f * light.radiance * (wi.z * weight(light.pdf, value.pdf) / light.pdf);
}

// Continues the path in a direction that the BSDF samples; returns whether it goes on.
bool Tracer::scatter(Path& path, const Vertex& vertex, const Frame& frame, vec3 wo, Random& random) const {
    const Surface& surface = *vertex.surface;
    BsdfSample sample;
    switch (surface.model) {
        case Model::diffuse:
            sample = diffuse_sample(surface, random);
            break;
        case Model::metal:
            sample = metal_sample(surface, wo, random);
            break;
        case Model::glass:
            sample = glass_sample(vertex.front ? surface.parameter : 1.0f / surface.parameter, wo, random);
    }
    path.beta *= sample.weight;
    path.eta_scale *= sample.eta * sample.eta;
    path.pdf = sample.pdf;
    const vec3 n = sample.wi.z > 0.0f ? vertex.n : -vertex.n;
    const vec3 wi = normalize(frame.to_world(sample.wi));
    path.ray = {vertex.p + gap_ * n, wi};
    return sample.weight != vec3(0) && dot(wi, n) > 0.0f;
}

vec3 Tracer::radiance(Ray ray, Random& random) {
    Path path{ray};
    for (uint32_t depth = 0;; ++depth) {
        Vertex vertex;
        if (!intersect(path, vertex) || depth == settings_.max_depth) return path.L;
        const Frame frame(vertex.ns);
        const vec3 wo = frame.to_local(vertex.wo);
        if (vertex.surface->model != Model::glass && scene_.has_lights) {
            path.L += path.beta * direct_light(vertex, frame, wo, random);
        }
        if (!scatter(path, vertex, frame, wo, random)) return path.L;
        const float survival = std::sqrt(max_component(path.beta) * path.eta_scale);
        if (depth >= settings_.rr_depth && vertex.surface->model != Model::glass && survival < 1.0f) {
            if (random.number() >= survival) return path.L;
            path.beta *= 1.0f / survival;
        }
    }
}

// The sum of all samples of one pixel.
vec3 pixel(Tracer& tracer, const Pinhole& camera, const Settings& settings, uint32_t x, uint32_t y) {
    vec3 sum(0);
    for (uint32_t i = 0; i < settings.spp; ++i) {
        Random random(y * settings.width + x, settings.seed * 0x10000u + i);
        const float dx = random.number(), dy = random.number();
        sum += tracer.radiance(camera.ray(float(x) + dx, float(y) + dy), random);
    }
    return sum;
}

struct Work {
    double cpu_seconds = 0.0;
    uint64_t rays = 0;
};

// One thread's share of the tiles of 16 x 16 pixels; `next` is the next free tile.
Work render_tiles(const TracerScene& scene, const Pinhole& camera, const Settings& settings,
                  std::atomic<uint32_t>& next, std::vector<vec3>& picture) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    constexpr uint32_t TILE = 16;
    Tracer tracer(scene, settings);
    const uint32_t width = settings.width, tiles = (width + TILE - 1) / TILE;
    for (uint32_t tile = next++; tile < tiles * tiles; tile = next++) {
        const uint32_t x0 = tile % tiles * TILE, y0 = tile / tiles * TILE;
        for (uint32_t y = y0; y < std::min(y0 + TILE, width); ++y)
            for (uint32_t x = x0; x < std::min(x0 + TILE, width); ++x)
                picture[size_t(y) * width + x] = pixel(tracer, camera, settings, x, y) / float(settings.spp);
    }
    timespec cpu;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &cpu);
    return {double(cpu.tv_sec) + 1e-9 * double(cpu.tv_nsec), tracer.rays};
}

void write(const Settings& settings, const std::vector<vec3>& picture) {
    Image image;
    image.full = uvec2(settings.width);
    image.data = {0, 0, settings.width, settings.width};
    for (int c = 0; c < 3; ++c) {
        Channel& channel = image.add(std::string(1, "RGB"[c]));
        std::transform(picture.begin(), picture.end(), channel.values.begin(), [c](vec3 v) { return v[c]; });
    }
    write_exr(settings.output, image);
}

void render(const Settings& settings) {
    const Scene scene = load_scene(settings.scene, {.reach = {.anywhere = true}});
    const Camera& camera = scene.cameras.front();
    if (camera.lens.radius > 0.0f)
        throw Error(settings.scene + ": the tracer's camera has no lens; set its radius to 0");
    const TracerScene tracer_scene(scene);
    const Pinhole pinhole(camera, settings.width);
    std::vector<vec3> picture(size_t(settings.width) * settings.width);
    std::vector<Work> work(settings.threads);
    std::vector<std::thread> threads;
    std::atomic<uint32_t> next{0};
    const auto start = std::chrono::steady_clock::now();
    for (Work& mine : work)
        threads.emplace_back([&] { mine = render_tiles(tracer_scene, pinhole, settings, next, picture); });
    for (std::thread& thread : threads)
        thread.join();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    Work total;
    for (const Work& part : work)
        total = {total.cpu_seconds + part.cpu_seconds, total.rays + part.rays};
    write(settings, picture);
    const double samples = double(picture.size()) * settings.spp;
    std::printf("{\"cpu\": %.6f, \"wall\": %.6f, \"rays\": %.6f}\n", total.cpu_seconds, wall.count(),
                double(total.rays) / samples);
}

uint32_t number(const std::string& text, const char* what, uint32_t min) {
    uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < min)
        throw Error(std::string(what) + ": cannot use \"" + text + "\"; expected a whole number from " +
                        std::to_string(min),
                    ErrorKind::request);
    return value;
}

int run(int argc, char** argv) {
    if (argc != 9) {
        throw Error("usage: tracer SCENE OUT.exr WIDTH SPP MAX_DEPTH RR_DEPTH SEED THREADS",
                    ErrorKind::request);
    }
    render({argv[1], argv[2], number(argv[3], "WIDTH", 1), number(argv[4], "SPP", 1),
            number(argv[5], "MAX_DEPTH", 0), number(argv[6], "RR_DEPTH", 0), number(argv[7], "SEED", 0),
            number(argv[8], "THREADS", 1)});
    return 0;
}

}  // namespace
}  // namespace candela::bench

int main(int argc, char** argv) {
    try {
        return candela::bench::run(argc, argv);
    } catch (const candela::Error& error) {
        std::fprintf(stderr, "tracer: error: %s\n", error.what());
        return 1;
    }
}
