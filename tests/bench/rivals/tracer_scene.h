// What the tracer makes of a candela scene: triangles for Embree, their surfaces, and lights chosen by power.
#pragma once

#include <cstdint>
#include <vector>

#include <embree3/rtcore.h>

#include "gpu_scene/environment_map.h"
#include "scene/scene.h"

namespace candela::bench {

enum class Model { diffuse, glass, metal };

struct Surface {
    Model model = Model::diffuse;
    vec3 colour{0};          // Reflectance; of metal at normal incidence.
    float parameter = 0.0f;  // For glass, the index of refraction inside over outside; for metal, alpha.
};

// A parallelogram p + u e1 + v e2 with u and v in [0, 1], or its half with u + v <= 1. Its front emits.
struct Lamp {
    vec3 p{0};
    vec3 e1{0};
    vec3 e2{0};
    bool is_triangle = false;
    vec3 n{0};              // Unit normal of the front.
    vec3 radiance{0};       // [W/(m^2 sr)]
    double area = 0.0;      // [m^2]
    float pdf_area = 0.0f;  // Density of light samples there [1/m^2], choice among lights included.
};
inline constexpr uint32_t NO_LAMP = UINT32_MAX;

struct Triangle {
    vec3 p[3];
    vec3 n[3];  // Unit shading normals.
    uint32_t surface;
    uint32_t lamp;  // Or NO_LAMP.
};

// A point on a light, seen from another point. pdf is 0 if no light arrives there.
struct LightSample {
    vec3 wi{0};
    vec3 radiance{0};
    float distance = 0.0f;  // [m]; INFINITE for the environment.
    float pdf = 0.0f;       // [1/sr], choice among lights included.
};

// Random numbers by pcg32. Ref: O'Neill 2014, PCG: A Family of Simple Fast Space-Efficient Statistically Good
// Algorithms for Random Number Generation.
class Random {
  public:
    // Each pair has a stream of its own; the hash keeps neighbouring pairs apart, which the generator would
    // not. Ref: Steele et al. 2014, Fast Splittable Pseudorandom Number Generators.
    Random(uint32_t a, uint32_t b) {
        uint64_t x = (uint64_t(a) << 32 | b) + 0x9e3779b97f4a7c15u;
        x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
        x = (x ^ x >> 27) * 0x94d049bb133111ebu;
        state_ = x ^ x >> 31;
    }
    uint32_t bits() {
        const uint64_t old = state_;
        state_ = old * 6364136223846793005u + 1442695040888963407u;
        const auto mixed = uint32_t(((old >> 18) ^ old) >> 27);
        const auto turn = uint32_t(old >> 59);
        return mixed >> turn | mixed << (-turn & 31);
    }
    float number() { return float(bits() >> 8) * 0x1p-24f; }  // In [0, 1).

  private:
    uint64_t state_;
};

class TracerScene {
  public:
    // Throws Error for what the tracer cannot render: round shapes, other materials, two-sided emission,
    // hidden skies.
    explicit TracerScene(const Scene& scene);
    ~TracerScene();
    TracerScene(const TracerScene&) = delete;
    TracerScene& operator=(const TracerScene&) = delete;

    // A point on a light chosen by power, seen from `from`. The scene has a light.
    LightSample sample_light(vec3 from, Random& random) const;
    // Radiance of the environment from the unit direction d, and the density of light samples there [1/sr].
    EnvironmentTexel environment(vec3 d) const;

    RTCScene embree = nullptr;  // One geometry; Embree's primID is an index of `triangles`.
    std::vector<Triangle> triangles;
    std::vector<Surface> surfaces;
    std::vector<Lamp> lamps;
    bool has_lights = false;
    float diagonal = 0.0f;  // Diagonal of the box around the scene [m].

  private:
    void add(const Shape& shape, const std::vector<TriangleMesh>& meshes);
    uint32_t add_lamp(const Shape& shape, vec3 p, vec3 e1, vec3 e2, bool is_triangle);
    void build_lights();
    void build_embree();
    LightSample sample_environment(Random& random) const;

    Environment environment_;
    EnvironmentMap map_;
    std::vector<float> row_cosines_;     // Of the angles from +Y between the map's rows of texels.
    std::vector<AliasEntry> alias_;      // Of the lamps and, last, the environment.
    std::vector<AliasEntry> sky_alias_;  // Of its texels.
    RTCDevice device_ = nullptr;
};

}  // namespace candela::bench
