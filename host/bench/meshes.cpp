// See meshes.h.
#include "bench/meshes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

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

// The number i / n of the way from -1 to 1; exact at both ends, so that neighbouring faces of a cube share
// their edges.
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

// A tree that grows level by level.
class Tree {
  public:
    explicit Tree(uint32_t seed) : random_(seed) {}

    // Triangles of the wood of a tree with that many levels of branches.
    static uint32_t wood(uint32_t levels) {
        uint32_t branches = 1;
        for (uint32_t level = 0; level < levels; ++level)
            branches = 1 + CHILDREN * branches;
        return branches * 2 * SIDES;
    }

    // A branch, those that leave it in its outer half, and so on up to the twigs.
    void grow(vec3 from, vec3 direction, float length, float radius, uint32_t levels) {
        const vec3 to = from + length * direction;
        add_tube(from, to, radius);
        if (levels == 0) {
            twigs_.emplace_back(from, to);
            return;
        }
        for (uint32_t i = 0; i < CHILDREN; ++i) {
            const vec3 at = mix(from, to, 0.5f + 0.5f * random_.unit());
            const vec3 bent = normalize(direction + 0.9f * random_.direction() + vec3(0.0f, 0.15f, 0.0f));
            grow(at, bent, 0.6f * length, 0.5f * radius, levels - 1);
        }
    }

    // Rhombuses of 10 x 4 cm around the twigs.
    void add_leaves(uint32_t count) {
        for (uint32_t i = 0; i < count; ++i) {
            const auto& [from, to] = twigs_[i % twigs_.size()];
            const vec3 at = mix(from, to, random_.unit()) + 0.15f * random_.cube();
            const vec3 along = random_.direction();
            const vec3 across = normalize(cross(along, random_.direction()));
            add_quad(at, at + 0.05f * along - 0.02f * across, at + 0.1f * along,
                     at + 0.05f * along + 0.02f * across);
        }
    }

    TriangleMesh mesh;

  private:
    static constexpr uint32_t CHILDREN = 5, SIDES = 5;

    // The far end is three fifths as thick.
    void add_tube(vec3 from, vec3 to, float radius) {
        const vec3 axis = normalize(to - from);
        const vec3 x = normalize(cross(axis, std::abs(axis.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0)));
        const vec3 y = cross(axis, x);
        const auto around = [&](uint32_t side) {
            const float angle = 2.0f * PI * float(side % SIDES) / float(SIDES);
            return radius * (std::cos(angle) * x + std::sin(angle) * y);
        };
        for (uint32_t side = 0; side < SIDES; ++side) {
            const vec3 a = around(side), b = around(side + 1);
            add_quad(from + a, from + b, to + 0.6f * b, to + 0.6f * a);
        }
    }

    void add_quad(vec3 a, vec3 b, vec3 c, vec3 d) {
        const auto first = uint32_t(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        mesh.triangles.emplace_back(first, first + 2, first + 3);
    }

    Random random_;
    std::vector<std::pair<vec3, vec3>> twigs_;
};

// `place` turned about an axis, and scaled along its own.
Transform placed_at(dvec3 place, dvec3 axis, double angle, dvec3 scale) {
    Transform transform;
    [[maybe_unused]] const bool regular =
        transform.append(translate(glm::dmat4(1.0), place) * rotate(glm::dmat4(1.0), angle, axis) *
                         glm::scale(glm::dmat4(1.0), scale));
    assert(regular);
    return transform;
}

void add_instance(Scene& scene, size_t mesh, const Transform& transform, uint32_t material) {
    scene.shapes.push_back(
        {.geometry = MeshInstance{uint32_t(mesh), transform}, .material = material, .emission = {}});
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

TriangleMesh tree_mesh(uint32_t triangles, uint32_t seed) {
    // A quarter of the triangles at most is wood.
    uint32_t levels = 0;
    while (levels < 4 && Tree::wood(levels + 1) <= triangles / 4)
        ++levels;
    Tree tree(seed);
    tree.grow(vec3(0), vec3(0, 1, 0), 3.5f, 0.2f, levels);
    tree.add_leaves((triangles - Tree::wood(levels)) / 2);
    return std::move(tree.mesh);
}

Scene forest_scene(uint32_t trees) {
    constexpr uint32_t TRIANGLES = 100'000, KINDS = 20, TREES_PER_KIND = 500;
    constexpr double SPACING = 4.5;  // Spacing of a square grid, around whose points trees stand [m].
    const auto rows = uint32_t(std::ceil(std::sqrt(double(trees))));
    const double edge = SPACING * rows;
    Scene scene = scene_with_camera(dvec3(-0.5 * edge, 16.0, 0.5 * edge), dvec3(0.0), 0.8f);
    const uint32_t green = add_diffuse(scene, vec3(0.3f, 0.5f, 0.2f));
    const uint32_t kinds = std::clamp(trees / TREES_PER_KIND, 1u, KINDS);
    for (uint32_t kind = 0; kind < kinds; ++kind)
        scene.meshes.push_back(tree_mesh(TRIANGLES, kind + 1));
    Random random(1);
    for (uint32_t i = 0; i < trees; ++i) {
        const uint32_t column = i % rows, row = i / rows;
        const vec3 jitter = random.cube();
        const double size = 0.8 + 0.4 * double(random.unit());
        const dvec3 place(SPACING * (column + 0.5 + 0.3 * double(jitter.x)) - 0.5 * edge, 0.0,
                          SPACING * (row + 0.5 + 0.3 * double(jitter.z)) - 0.5 * edge);
        add_instance(scene, random.bits() % kinds,
                     placed_at(place, dvec3(0, 1, 0), 2.0 * M_PI * double(random.unit()),
                               size * dvec3(1.0, 1.0 + 0.1 * double(jitter.y), 1.0)),
                     green);
    }
    const double beyond = edge + 40.0;
    add_shape(scene,
              parallelogram(dvec3(-beyond, 0, beyond), dvec3(2.0 * beyond, 0, 0), dvec3(0, 0, -2.0 * beyond)),
              green);
    add_shape(
        scene,
        parallelogram(dvec3(-0.2 * edge, 100, -0.2 * edge), dvec3(0.4 * edge, 0, 0), dvec3(0, 0, 0.4 * edge)),
        green, Emission{vec3(10.0f), false});
    return scene;
}

Scene scattered_scene(uint32_t instances) {
    Scene scene = scene_with_camera(dvec3(0, 0, 3), dvec3(0), 0.8f);
    const uint32_t grey = add_diffuse(scene, vec3(0.5f));
    scene.meshes.push_back(displaced_sphere(2, 1));
    Random random(1);
    const double size = 0.3 / std::cbrt(double(instances));
    for (uint32_t i = 0; i < instances; ++i) {
        const dvec3 place(random.cube()), axis(random.direction());
        add_instance(scene, 0, placed_at(place, axis, 2.0 * M_PI * double(random.unit()), dvec3(size)), grey);
    }
    return scene;
}

}  // namespace candela
