// Meshes with smooth normals, whose shading normals lean away from their triangles: where light ends on them,
// what a body reflects that loses nothing, and that no light passes what is closed.
#include <cmath>
#include <random>

#include "estimator_fixture.h"

namespace candela {
namespace {

using Bend = std::function<vec3(vec3)>;

// A sphere of few triangles around 0; its vertices have the normals bend(n) for the sphere's own n.
TriangleMesh coarse_sphere(const Bend& bend = [](vec3 n) { return n; }) {
    TriangleMesh mesh = sphere_mesh(8, 16);
    for (const vec3 p : mesh.positions)
        mesh.normals.push_back(normalize(bend(normalize(p))));
    return mesh;
}

TriangleMesh moved(const TriangleMesh& mesh, float scale, vec3 by) {
    return transformed(mesh, [&](vec3 p) { return scale * p + by; });
}

// Normals that lean by up to 60 degrees in random directions.
TriangleMesh ragged_sphere() {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    return coarse_sphere([&](vec3 n) {
        const vec3 any = vec3(unit(random), unit(random), unit(random));
        const vec3 across = normalize(any - dot(any, n) * n);
        return n + std::tan(float(60 * DEGREE) * std::abs(unit(random))) * across;
    });
}

Light sun(vec3 towards, float irradiance) {
    DirectionalLight light;
    light.direction = -dvec3(normalize(towards));
    light.irradiance = vec3(irradiance);
    return {"sun", light};
}

class TerminatorTest : public RenderTest {
  protected:
    static constexpr uint32_t SIZE = 64;

    static Scene under_white_sky(const TriangleMesh& mesh, const decltype(Material::model)& model) {
        Scene scene = scene_with_camera(dvec3(1, 2, 4.5), dvec3(0), 0.45f);
        scene.environment = constant_environment(vec3(1));
        add_shape(scene, mesh, add_material(scene, model));
        return scene;
    }
    Image picture(const Scene& scene, Estimator estimator, uint32_t spp, uint32_t seed = 1) const {
        return image_of(render(scene, independent_settings(SIZE, estimator, seed), spp));
    }
    // The part of the sun's light that a convex body of reflectance 1/2 does not reflect as its normals say.
    double lost(Terminator terminator, vec3 towards) const {
        Scene scene = scene_with_camera(dvec3(0, 0, 6), dvec3(0), 0.4f);
        scene.lights.push_back(sun(towards, float(M_PI)));
        add_shape(scene, coarse_sphere(), add_diffuse(scene, vec3(0.5f)));
        RenderSettings settings = independent_settings(SIZE, Estimator::mis, 1);
        settings.aovs = true;
        settings.max_depth = 1;
        settings.terminator = terminator;
        const Image image = make_image(render(scene, settings, 1), {.normal = true}, {});
        const Channel* normal[] = {image.find("N.X"), image.find("N.Y"), image.find("N.Z")};
        double expected = 0.0, reflected = 0.0;
        for (size_t i = 0; i < image.pixel_count(); ++i) {
            const vec3 n(normal[0]->values[i], normal[1]->values[i], normal[2]->values[i]);
            if (n.z < 0.3f) continue;  // Light begins lower where it is seen at a grazing angle.
            const double cosine = std::max(0.0f, dot(n, normalize(towards)));
            expected += 0.5 * cosine;
            reflected += double(plane(image, "", 0)[i]);
        }
        EXPECT_GT(expected, 100.0);
        return 1.0 - reflected / expected;
    }
};

// The closed form for a convex body: every point whose normal turns towards the sun sees it, and no other
// does. Some tens of roundings of the cosine; and normals are kept in 2 x 16 bits, on both sides.
TEST_F(TerminatorTest, SmoothMeshesShadeAsTheirNormalsSay) {
    for (const vec3 towards : {vec3(1, 0.5f, 0.5f), vec3(-1, 0.2f, -0.3f), vec3(0.1f, -1, 0.2f)}) {
        EXPECT_NEAR(lost(Terminator::smooth, towards), 0.0, 1e-4);
        EXPECT_GT(lost(Terminator::flat, towards), 0.005);
    }
}

// However the normals lean, every path of a white body ends in the sky with all of its light. Without
// roulette and light samples, that is one number.
TEST_F(TerminatorTest, WhiteBodiesWithAnyNormalsAreInvisible) {
    const PrincipledMaterial plastic{.base_color = vec3(1), .roughness = 0.3f};
    const PrincipledMaterial metal{.base_color = vec3(1), .metalness = 1.0f, .roughness = 0.0f};
    for (const TriangleMesh& mesh : {coarse_sphere(), ragged_sphere()}) {
        for (const decltype(Material::model)& model :
             {decltype(Material::model)(DiffuseMaterial{vec3(1)}),
              decltype(Material::model)(MirrorMaterial{vec3(1)}), decltype(Material::model)(metal)}) {
            SCOPED_TRACE(testing::Message() << "model " << model.index());
            RenderSettings settings = independent_settings(SIZE, Estimator::bsdf, 1);
            settings.rr_depth = DEPTH_SAFETY_LIMIT;
            const Image image = image_of(render(under_white_sky(mesh, model), settings, 4));
            EXPECT_EQ(coverage(image), 1.0);
            for (const float value : plane(image, "", 1))
                ASSERT_NEAR(value, 1.0f, 0x1p-14);
        }
        expect_mean(picture(under_white_sky(mesh, plastic), Estimator::mis, samples(256)), glm::dvec3(1),
                    0x1p-18);
        expect_mean(picture(under_white_sky(mesh, DiffuseMaterial{vec3(1)}), Estimator::light, samples(512)),
                    glm::dvec3(1), 0x1p-18);
    }
}

// Triangles that bulge nowhere are lit where they are: bit for bit.
TEST_F(TerminatorTest, AFlatMeshHasTheSamePicture) {
    TriangleMesh floor;
    floor.positions = {vec3(-2, 0, -2), vec3(-2, 0, 2), vec3(2, 0, 2), vec3(2, 0, -2)};
    floor.normals.assign(4, vec3(0, 1, 0));
    floor.triangles = {uvec3(0, 1, 2), uvec3(0, 2, 3)};
    Scene scene = under_white_sky(floor, DiffuseMaterial{REFLECTANCE});
    add_shape(scene, Sphere{dvec3(0, 0.5, 0), 0.5}, add_diffuse(scene, vec3(0.5f)));
    RenderSettings settings = independent_settings(SIZE, Estimator::mis, 1);
    const Accumulation smooth = render(scene, settings, 4);
    settings.terminator = Terminator::flat;
    EXPECT_EQ(smooth.values, render(scene, settings, 4).values);
}

// As fine as a pixel, a mesh is the sphere that it approximates: its area and its silhouette are 2e-4
// smaller.
TEST_F(TerminatorTest, AFineMeshIsTheSphere) {
    const auto scene_with = [](const auto& geometry) {
        Scene scene = scene_with_camera(dvec3(0, 1.5, 4), dvec3(0, 0.3, 0), 0.6f);
        scene.environment = constant_environment(vec3(0.2f));
        add_shape(scene, parallelogram(vec3(-2, 0, -2), vec3(0, 0, 4), vec3(4, 0, 0)),
                  add_diffuse(scene, vec3(0.5f)));
        add_shape(scene, geometry, add_diffuse(scene, REFLECTANCE));
        add_shape(scene, parallelogram(vec3(1.5f, 2, -1), vec3(0.5f, 0, 0), vec3(0, 0, 0.5f)), 0,
                  Emission{.radiance = vec3(8), .two_sided = true});
        return scene;
    };
    TriangleMesh fine = sphere_mesh(96, 192);
    fine.normals = fine.positions;
    expect_same_expectation(
        picture(scene_with(moved(fine, 0.5f, vec3(0, 0.5f, 0))), Estimator::mis, samples(512)),
        picture(scene_with(Sphere{dvec3(0, 0.5, 0), 0.5}), Estimator::light, samples(512), 2));
}

// A sphere of few triangles that touches the walls of a closed box, and reaches a little into one of them:
// what is lit within stays dark, however bright the day is outside. And a lamp within a closed body is not
// seen from outside.
TEST_F(TerminatorTest, NoLightPassesClosedBodies) {
    Scene room = scene_with_camera(dvec3(0, 0.3, 0.9), dvec3(0, -0.2, 0), 1.2f);
    room.environment = constant_environment(vec3(1e6f));
    room.lights.push_back(sun(vec3(1, 1, 0.1f), 1e6f));
    const uint32_t white = add_diffuse(room, vec3(0.9f));
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            vec3 corner(-1), e1(0), e2(0);
            corner[axis] = side;
            e1[(axis + 1) % 3] = 2;
            e2[(axis + 2) % 3] = 2;
            add_shape(room, parallelogram(corner, e1, e2), white);
        }
    }
    for (const vec3 at : {vec3(0.3f, -0.7f, 0), vec3(0.705f, 0, 0), vec3(-0.69f, -0.69f, 0)})
        add_shape(room, moved(coarse_sphere(), 0.3f, at), white);
    add_shape(room, moved(ragged_sphere(), 0.2f, vec3(0, -0.3f, -0.8f)), white);
    for (const Estimator estimator : ESTIMATORS)
        expect_pixels(picture(room, estimator, 16), vec3(0));

    for (const TriangleMesh& shell : {coarse_sphere(), ragged_sphere()}) {
        Scene outside = scene_with_camera(dvec3(0, 0, 5), dvec3(0), 0.5f);
        const uint32_t grey = add_diffuse(outside, vec3(0.9f));
        add_shape(outside, shell, grey);
        add_shape(outside, moved(shell, 0.9f, vec3(0)), grey);
        add_shape(outside, Sphere{dvec3(0), 0.5}, grey, Emission{.radiance = vec3(1e6f)});
        for (const Estimator estimator : ESTIMATORS)
            expect_pixels(picture(outside, estimator, 16), vec3(0));
    }
}

class TerminatorEstimatorTest : public EstimatorTest {};

// Lamps so near that a few percent of the sphere's radius change what it receives.
TEST_F(TerminatorEstimatorTest, AgreeOnCoarseMeshesNearLamps) {
    Scene scene = scene_with_camera(dvec3(0.5, 1.2, 4), dvec3(0, 0, 0), 0.6f);
    scene.environment = constant_environment(vec3(0.3f));
    add_shape(scene, coarse_sphere(), add_diffuse(scene, REFLECTANCE));
    add_shape(scene, moved(ragged_sphere(), 0.5f, vec3(1.3f, -0.4f, 0.6f)),
              add_material(scene, PrincipledMaterial{.base_color = vec3(0.5f), .roughness = 0.5f}));
    const uint32_t black = add_diffuse(scene, vec3(0));
    add_shape(scene, Sphere{dvec3(-0.3, 1.3, 0.5), 0.25}, black, Emission{.radiance = RADIANCE});
    add_shape(scene, parallelogram(vec3(-1.2f, -0.5f, 0), vec3(0, 0.8f, 0), vec3(0, 0, 0.8f)), black,
              Emission{.radiance = RADIANCE, .two_sided = true});
    expect_estimators_agree(scene, 2048, 512);
}

}  // namespace
}  // namespace candela
