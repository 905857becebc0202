// How much emitting surfaces light their scene: closed forms for small ones.
#include "scene/glow.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace candela {
namespace {

using std::numbers::pi;

const double RADIUS = std::sqrt(3.0);  // Radius of the sphere around the box from (-1, -1, -1) to (1, 1, 1).
constexpr double AREA = 1e-10;         // Area of each emitter.

// Scenes within that box, whose corners two tiny triangles hold.
class GlowTest : public testing::Test {
  protected:
    GlowTest() {
        add_triangle({-1, -1, -1}, {1, 1, 1}, 0.0);
        add_triangle({1, 1, 1}, {-1, -1, -1}, 0.0);
    }

    // A right-angled triangle with a corner at p, and the others towards the middle of the scene or on its
    // side, which faces along n. Returns the index of its shape.
    size_t add_triangle(dvec3 p, dvec3 n, double area, std::optional<Emission> emission = {}) {
        n = normalize(n);
        const dvec3 t = normalize(cross(std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), n));
        const double side = std::sqrt(2.0 * area);
        TriangleMesh mesh;
        mesh.origin = p;
        mesh.positions = {vec3(0), vec3(side * t), vec3(side * cross(n, t))};
        mesh.triangles = {uvec3(0, 1, 2)};
        scene_.meshes.push_back(mesh);
        scene_.shapes.push_back({MeshInstance{uint32_t(scene_.meshes.size() - 1), Transform()}, 0, emission});
        return scene_.shapes.size() - 1;
    }
    void emit(dvec3 p, dvec3 n, const Emission& emission = {vec3(1), false}) {
        add_triangle(p, n, AREA, emission);
    }
    void expect(double radiance) const {
        // The directions are 16: the mean of a root over [0, 1] by the midpoint rule is off by 0.16 / 16^1.5.
        // What sticks out of the box, at most the emitter's edge of 1.4e-5, moves its rim.
        EXPECT_NEAR(glow_of(scene_, 0.1).radiance, radiance, 0.005 * radiance + 1e-4 * of_way_);
    }

    Scene scene_;
    // Flux per area and radiance, spread over all directions in the volume, per length of way.
    const double of_way_ = pi * AREA / (4.0 * pi * (4.0 / 3.0 * pi * std::pow(RADIUS, 3)));
};

TEST_F(GlowTest, WithoutEmissionThereIsNone) {
    const Glow glow = glow_of(scene_, 0.1);
    EXPECT_EQ(glow.radiance, 0.0);
    EXPECT_EQ(glow.area, 0.0);
    EXPECT_FALSE(glow.above_white);
    EXPECT_EQ(glow_of(Scene(), 0.1).radiance, 0.0);
}

TEST_F(GlowTest, FromTheMiddleLightGoesOneRadius) {
    emit({0, 0, 0}, {1, 2, 3});
    expect(of_way_ * RADIUS);
    emit({0, 0, 0}, {0, 0, -1}, {vec3(1), true});  // To both sides.
    expect(3.0 * of_way_ * RADIUS);
}

TEST_F(GlowTest, FromTheRimInwardsItGoesFourThirds) {
    emit({1, 1, 1}, {-1, -1, -1});
    expect(of_way_ * 4.0 / 3.0 * RADIUS);  // The mean of 2 r cos over a matt surface's directions.
}

TEST_F(GlowTest, FromTheRimOutwardsItGoesNowhere) {
    emit({1, 1, 1}, {1, 1, 1});
    expect(0.0);
}

TEST_F(GlowTest, CountsInLuminanceAndSaysWhatIsAboveWhite) {
    emit({0, 0, 0}, {0, 1, 0}, {vec3(0, 0.5, 0), false});
    expect(0.7152 * 0.5 * of_way_ * RADIUS);
    EXPECT_FALSE(glow_of(scene_, 0.1).above_white);
    emit({0, 0, 0}, {0, 1, 0}, {vec3(0, 0, 1.5), false});
    EXPECT_TRUE(glow_of(scene_, 0.1).above_white);
}

TEST_F(GlowTest, InstancesEmitEach) {
    emit({0, 0, 0}, {0, 0, 1});
    Transform mirror;
    glm::dmat4 matrix(1.0);
    matrix[0][0] = -1.0;
    ASSERT_TRUE(mirror.append(matrix));
    Shape copy = scene_.shapes.back();
    std::get<MeshInstance>(copy.geometry).transform = mirror;
    scene_.shapes.push_back(copy);
    expect(2.0 * of_way_ * RADIUS);
}

// The front of a mirrored mesh is the mirror image of its front.
TEST_F(GlowTest, MirroredEmittersFaceTheirSide) {
    emit({1, 1, 1}, {1, 1, 1});
    Transform through_origin;
    ASSERT_TRUE(through_origin.append(glm::dmat4(-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1)));
    std::get<MeshInstance>(scene_.shapes.back().geometry).transform = through_origin;
    expect(0.0);
}

TEST_F(GlowTest, ImagesGiveTheirMean) {
    // A white texel beside three black ones, in sRGB; and half of it all in grey.
    TexelImage image{.size = {2, 2}, .channels = 1, .type = TexelType::unorm8, .texels = {}, .gamma = {}};
    for (const int code : {255, 0, 0, 0})
        image.texels.push_back(std::byte(code));
    scene_.images.push_back({.path = "a.png", .image = std::make_shared<TexelImage>(image)});
    Textured<vec3> radiance(vec3(0.5));
    radiance.texture = Texture{.image = 0, .encoding = TextureEncoding::srgb};
    emit({0, 0, 0}, {0, 0, 1}, {radiance, false});
    expect(0.5 * 0.25 * of_way_ * RADIUS);
    EXPECT_NEAR(glow_of(scene_, 0.1).area, 0.25, 1e-6);  // The only triangle with an area.
    EXPECT_EQ(glow_of(scene_, 0.6).area, 0.0);
}

// Among a million triangles, only some are looked at.
TEST_F(GlowTest, ManyTrianglesAreSampled) {
    emit({0, 0, 0}, {0, 0, 1});
    std::vector<uvec3>& triangles = scene_.meshes.back().triangles;
    triangles.resize(1000003, triangles[0]);
    const double whole = 1000003 * of_way_ * RADIUS;
    EXPECT_NEAR(glow_of(scene_, 0.1).radiance, whole, 1e-4 * whole);
}

TEST(MeanRadiance, WeightsTexelsByTheirSolidAngles) {
    // The upper quarter of the polar angle has (1 - cos 45) / 2 of the sphere.
    Environment environment{.size = {2, 4}, .radiance = std::vector<vec3>(8, vec3(0))};
    environment.radiance[0] = environment.radiance[1] = vec3(2);
    EXPECT_NEAR(mean_radiance(environment), 1.0 - std::sqrt(0.5), 1e-6);
}

}  // namespace
}  // namespace candela
