// Lights that lie in the plane of another surface are found, and no others.
#include "gpu_scene/coplanar_lights.h"

#include <gtest/gtest.h>

#include "gpu_scene/gpu_scene.h"
#include "probe/scenes.h"

namespace candela {
namespace {

// A ceiling of 10 m, and a lamp of 1 m, at that height above it and that far from its middle, all of it
// turned so that no axis is a normal.
class CoplanarLight : public testing::Test {
  protected:
    static dvec3 turned(dvec3 p) {
        const dvec3 axis = normalize(dvec3(1, 2, 3));
        return p * std::cos(1.0) + glm::cross(axis, p) * std::sin(1.0) +
               axis * dot(axis, p) * (1 - std::cos(1.0));
    }
    static Quad square(dvec3 middle, double half) {
        return {{turned(middle + dvec3(-half, 0, half)), turned(middle + dvec3(half, 0, half)),
                 turned(middle + dvec3(half, 0, -half)), turned(middle + dvec3(-half, 0, -half))}};
    }
    static TriangleMesh mesh_of(const Quad& quad) {
        TriangleMesh mesh;
        for (const dvec3 corner : quad.corners)
            mesh.positions.emplace_back(corner);
        mesh.triangles = {uvec3(0, 1, 2), uvec3(0, 2, 3)};
        return mesh;
    }
    template <class Geometry>
    static void add_lamp(Scene& scene, const Geometry& geometry) {
        add_shape(scene, geometry, 0);
        scene.shapes.back().emission = Emission{.radiance = vec3(1)};
    }
    static Scene ceiling() {
        Scene scene;
        add_shape(scene, square(dvec3(0), 5.0), add_material(scene, DiffuseMaterial{}));
        return scene;
    }
    static bool warns(double height, double x) {
        Scene scene = ceiling();
        add_lamp(scene, square(dvec3(x, height, 0), 0.5));
        return warn_of_coplanar_lights(scene).has_value();
    }
};

TEST_F(CoplanarLight, IsFoundInAWall) {
    EXPECT_TRUE(warns(0.0, 0.0));
    EXPECT_TRUE(warns(1e-7, 0.0));
    EXPECT_FALSE(warns(1e-4, 0.0));
    EXPECT_FALSE(warns(-1e-4, 0.0));
    EXPECT_TRUE(warns(0.0, 5.0)) << "half of it in the wall";
    EXPECT_FALSE(warns(0.0, 5.5)) << "beside it, along an edge";
    EXPECT_FALSE(warns(0.0, 7.0));
}

TEST_F(CoplanarLight, IsFoundWhateverTheShapes) {
    Scene scene = ceiling();
    add_lamp(scene, Disk{turned(dvec3(1, 0, 0)), turned(dvec3(0.1, 0, 0)), turned(dvec3(0, 0, -0.1))});
    EXPECT_TRUE(warn_of_coplanar_lights(scene));
    scene.shapes.pop_back();
    add_lamp(scene, Sphere{dvec3(0), 0.1});
    EXPECT_FALSE(warn_of_coplanar_lights(scene));
    scene.shapes.pop_back();
    add_lamp(scene, mesh_of(square(dvec3(1, 0, 0), 0.1)));
    EXPECT_TRUE(warn_of_coplanar_lights(scene));

    Scene meshes;
    add_shape(meshes, mesh_of(square(dvec3(0), 5.0)), add_material(meshes, DiffuseMaterial{}));
    EXPECT_FALSE(warn_of_coplanar_lights(meshes));
    add_lamp(meshes, square(dvec3(1, 0, 1), 0.5));
    EXPECT_TRUE(warn_of_coplanar_lights(meshes));
    // The triangles of one mesh are those of one light.
    Scene lamp;
    add_material(lamp, DiffuseMaterial{});
    add_lamp(lamp, mesh_of(square(dvec3(0), 5.0)));
    EXPECT_FALSE(warn_of_coplanar_lights(lamp));
}

TEST_F(CoplanarLight, IsAWarningOfTheScene) {
    Scene scene = ceiling();
    scene.materials[0].name = "plaster";
    add_lamp(scene, square(dvec3(0), 0.5));
    const std::string text =
        "shape 1 (material \"plaster\"): the light lies in the plane of shape 0 (material \"plaster\"), so "
        "either may hide the other; move it off that plane";
    EXPECT_EQ(build_gpu_scene(scene).warnings, std::vector<std::string>{text});
    add_lamp(scene, square(dvec3(3, 0, 0), 0.5));
    EXPECT_EQ(build_gpu_scene(scene).warnings, std::vector<std::string>{text + " (and 1 more)"});
}

}  // namespace
}  // namespace candela
