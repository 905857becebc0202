// See meshes.h.
#include "bench/meshes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>

#include "gpu_scene/flatten.h"
#include "probe/random.h"
#include "probe/scenes.h"

namespace candela {
namespace {

constexpr uint32_t SPHERES = 4;
constexpr uint32_t PER_SPHERE = 12;  // Triangles of a displaced_sphere(), and of the floor, over n^2.

// A sum of waves in random directions, the finer ones lower; in [-1, 1].
class Bumps {
  public:
    explicit Bumps(uint32_t seed) {
        Random random(seed);
        float frequency = 2.0f;  // [rad/m]
        float sum = 0.0f;
        for (Wave& wave : waves_) {
            wave = {frequency * random.direction(), 2.0f * PI * random.unit(), 1.0f / frequency};
            sum += wave.height;
            frequency *= 1.5f;
        }
        for (Wave& wave : waves_)
            wave.height /= sum;
    }

    float at(vec3 p) const {
        float height = 0.0f;
        for (const Wave& wave : waves_)
            height += wave.height * std::sin(dot(wave.vector, p) + wave.phase);
        return height;
    }

  private:
    struct Wave {
        vec3 vector;
        float phase;
        float height;
    };
    std::array<Wave, 9> waves_{};
};

// Adds columns * rows quads, two triangles each, whose corners are point(i, j), i in [0, columns], j in [0,
// rows]. Their front is where i turns to j counter-clockwise.
template <class Point>
void add_grid(TriangleMesh& mesh, uint32_t columns, uint32_t rows, const Point& point) {
    const auto first = uint32_t(mesh.positions.size());
    for (uint32_t j = 0; j <= rows; ++j) {
        for (uint32_t i = 0; i <= columns; ++i)
            mesh.positions.push_back(point(i, j));
    }
    for (uint32_t j = 0; j < rows; ++j) {
        for (uint32_t i = 0; i < columns; ++i) {
            const uint32_t a = first + j * (columns + 1) + i, b = a + 1, d = a + columns + 1, c = d + 1;
            mesh.triangles.emplace_back(a, b, c);
            mesh.triangles.emplace_back(a, c, d);
        }
    }
}

// i / n of the way from -1 to 1; exact at both ends, so that neighbouring faces of a cube share their edges.
float across(uint32_t i, uint32_t n) {
    return float(2 * i) / float(n) - 1.0f;
}

// Wider than the room by 0.1 m on all sides, so that no ray escapes between floor and wall.
TriangleMesh hilly_floor(uint32_t n) {
    const Bumps bumps(5);
    TriangleMesh mesh;
    add_grid(mesh, 2 * n, 3 * n, [&](uint32_t i, uint32_t j) {
        const vec3 p = 3.1f * vec3(across(i, 2 * n), 0.0f, -across(j, 3 * n));
        return p + vec3(0.0f, 0.15f * bumps.at(p), 0.0f);
    });
    return mesh;
}

}  // namespace

TriangleMesh displaced_sphere(uint32_t n, uint32_t seed) {
    const Bumps bumps(seed);
    TriangleMesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {1.0f, -1.0f}) {
            add_grid(mesh, n, n, [&](uint32_t i, uint32_t j) {
                vec3 p(0.0f);
                p[axis] = side;
                // Swapped on the far side, so that the front is outside on both.
                p[(axis + 1) % 3] = across(side > 0.0f ? i : j, n);
                p[(axis + 2) % 3] = across(side > 0.0f ? j : i, n);
                p = normalize(p);
                return p * (1.0f + 0.2f * bumps.at(p));
            });
        }
    }
    return mesh;
}

Scene displaced_scene(uint32_t triangles) {
    const double quads = double(triangles) / ((SPHERES + 1) * PER_SPHERE);
    const uint32_t n = std::max(1u, uint32_t(std::lround(std::sqrt(quads))));
    Scene scene = scene_with_camera(dvec3(-2.6, 2.6, 2.6), dvec3(0.0, 0.8, 0.0), 1.0f);
    const uint32_t grey = add_diffuse(scene, vec3(0.7f));

    for (uint32_t i = 0; i < SPHERES; ++i) {
        const vec3 centre(i % 2 == 0 ? -1.4f : 1.4f, 1.2f, i < 2 ? -1.4f : 1.4f);
        add_shape(scene, transformed(displaced_sphere(n, i + 1), [&](vec3 p) { return centre + p; }), grey);
    }
    add_shape(scene, hilly_floor(n), grey);

    // Four walls, which begin below the floor, the ceiling, and the light just under it.
    const vec3 up(0, 5, 0), x(6, 0, 0), z(0, 0, 6);
    add_shape(scene, parallelogram(vec3(-3, -1, -3), x, up), grey);
    add_shape(scene, parallelogram(vec3(3, -1, 3), -x, up), grey);
    add_shape(scene, parallelogram(vec3(-3, -1, 3), -z, up), grey);
    add_shape(scene, parallelogram(vec3(3, -1, -3), z, up), grey);
    add_shape(scene, parallelogram(vec3(-3, 4, -3), x, z), grey);
    add_shape(scene, parallelogram(vec3(-0.75f, 3.99f, -0.75f), 0.25f * x, 0.25f * z), grey,
              Emission{vec3(10.0f), false});
    return scene;
}

std::vector<BenchTriangle> triangles_of(const Scene& scene) {
    const FlatScene flat = flatten(scene, SceneFrame{});
    std::vector<BenchTriangle> triangles(flat.id_count);
    for (size_t i = 0; i < flat.primitives.size(); ++i) {
        const Primitive& p = flat.primitives[i];
        assert(p.kind == PRIMITIVE_TRIANGLES);
        const uvec2 id = flat.surfaces[i].id;
        triangles[id.x] = {p.a, p.b, p.c};
        if (id.y != id.x) triangles[id.y] = {p.a, p.c, p.d};
    }
    return triangles;
}

std::string triangles_text(uint64_t triangles) {
    const auto count = double(triangles);
    char text[40];
    // From 999 500 on, three digits would round to 1000 k.
    if (triangles >= 999500) {
        std::snprintf(text, sizeof text, "%.3g M triangles", count / 1e6);
    } else if (triangles >= 1000) {
        std::snprintf(text, sizeof text, "%.3g k triangles", count / 1e3);
    } else {
        std::snprintf(text, sizeof text, "%.0f triangles", count);
    }
    return text;
}

}  // namespace candela
