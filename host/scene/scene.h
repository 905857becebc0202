// A scene as plain structs, in the units that the renderer uses: metres, radians, linear Rec.709 radiance.
// World space is right-handed with +Y up. Nothing here knows of GPUs.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "base/file_reach.h"
#include "base/math.h"
#include "scene/named_arrays.h"
#include "scene/principled.h"
#include "scene/texture.h"
#include "scene/transform.h"

namespace candela {

// A thin lens. Its aperture is a disk, or a regular polygon whose corners lie on the disk's rim.
struct Lens {
    float radius = 0.0f;          // Radius of the aperture [m]; 0: a pinhole, with everything sharp.
    float focal_distance = 1.0f;  // From the lens to the plane in focus, along the view [m]; above 0.
    uint32_t blades = 0;          // Corners of the polygon, 3 .. MAX_BLADES; 0: a disk.
    float rotation = 0.0f;        // Angle of the polygon's first corner [rad], from the right towards up.

    bool operator==(const Lens&) const = default;
};
inline constexpr uint32_t MAX_BLADES = 64;

// The most by which a principal point may be off the picture's centre, and the ratio of focal lengths off 1.
inline constexpr float MAX_PRINCIPAL_OFFSET = 1000.0f;
inline constexpr float MAX_FOCAL_RATIO = 1000.0f;

// How a camera sees all around, or far to the sides.
enum class Mapping {
    equirectangular,  // Longitude to the right, over 360 degrees, and latitude upwards, over 180.
    fisheye,          // Equidistant: the distance from the centre is proportional to the angle to the axis.
    equisolid,        // A fisheye in which equal areas show equal solid angles.
};

// What such a camera shows. A fisheye sees within a circle that touches the longer sides of the picture.
struct Panorama {
    Mapping mapping = Mapping::equirectangular;
    float fisheye_fov = PI;  // Full angle across the circle [rad], within the limits below.

    bool operator==(const Panorama&) const = default;
};
inline constexpr float MIN_FISHEYE_DEGREES = 1.0f;
inline constexpr float MAX_FISHEYE_DEGREES = 360.0f;

// A camera. Right is cross(forward, up).
struct Camera {
    std::string name;
    dvec3 position{0};
    dvec3 look_at{0, 0, -1};
    vec3 up{0, 1, 0};
    float vertical_fov = 0.0f;  // Full angle [rad], in (0, pi), if the principal point is in the middle.
    // Where the axis meets the picture: from its centre to the right and downwards, in heights of the
    // picture. Each component is at most MAX_PRINCIPAL_OFFSET in size.
    vec2 principal_offset{0};
    // The focal length in widths of a pixel over that in heights of a pixel, from 1 / MAX_FOCAL_RATIO to
    // MAX_FOCAL_RATIO; 1: pixels are square.
    float focal_ratio = 1.0f;
    // Full height of the view [m], above 0. If there is one, all rays are parallel and leave the plane
    // through the position; the camera has square pixels around its axis, no field of view and no lens.
    std::optional<double> ortho_height{};
    // If there is one, the camera is no plane's projection: it has no field of view, height or lens, and
    // square pixels. An equirectangular one has its axis in the middle.
    std::optional<Panorama> panorama{};
    Lens lens;
    std::optional<uvec2> film_size{};  // Size of the picture [pixels], if the file states it for this camera.

    bool operator==(const Camera&) const = default;
};

// How the samples of a pixel are spread around its centre. A sample belongs to one pixel.
enum class FilterShape { box, tent, gaussian, blackman_harris };
struct PixelFilter {
    FilterShape shape = FilterShape::box;
    float width = 1.0f;  // Beyond half of it the filter is 0 [pixels].

    bool operator==(const PixelFilter&) const = default;
};
inline constexpr float MIN_FILTER_WIDTH = 0.01f;
inline constexpr float MAX_FILTER_WIDTH = 10.0f;

struct Film {
    uvec2 size{512, 512};  // Pixels.
    PixelFilter filter{};
};

enum class Estimator { bsdf, light, mis };
enum class SamplerKind { independent, stratified, sobol };
// Where the light on a mesh with smooth normals ends: where its normals turn away from the light, or where
// its triangles do.
enum class Terminator { smooth, flat };
// How a light is chosen for a lit point: each as often as the others, by power, by what it may send there, or
// by the one of the last two that has less noise in equal time.
enum class LightSampler { automatic, uniform, power, tree };

// The scene file's proposals; the command line overrides them.
struct IntegratorSettings {
    uint32_t spp = 64;
    std::optional<uint32_t> max_depth;  // Scattering vertices at most; none: unlimited.
    uint32_t rr_depth = 3;              // The first rr_depth bounces always survive.
    Estimator estimator = Estimator::mis;
    SamplerKind sampler = SamplerKind::sobol;
    LightSampler light_sampler = LightSampler::automatic;
    Terminator terminator = Terminator::smooth;
    uint32_t seed = 0;
    std::optional<float> clamp_indirect{};  // See RenderSettings.
};

// Lambert: f = reflectance / pi on both sides.
struct DiffuseMaterial {
    Textured<vec3> reflectance{vec3(0.5f)};  // Each in [0, 1].

    bool operator==(const DiffuseMaterial&) const = default;
};

// A diffuse base under a glossy lobe around the mirrored direction: modified Phong. diffuse + specular is at
// most 1 in each channel, so that it creates no energy.
struct PhongMaterial {
    Textured<vec3> diffuse{vec3(0)};   // kd.
    Textured<vec3> specular{vec3(0)};  // ks.
    Textured<float> exponent = 1.0f;   // n, in [0, MAX_PHONG_EXPONENT].

    bool operator==(const PhongMaterial&) const = default;
};
inline constexpr float MAX_PHONG_EXPONENT = 1e5f;

// An ideal mirror.
struct MirrorMaterial {
    Textured<vec3> reflectance{vec3(1)};  // Each in [0, 1], at any angle.

    bool operator==(const MirrorMaterial&) const = default;
};

// A metal with microfacets (GGX). Its reflectance rises to 1 towards grazing angles (Schlick).
struct ConductorMaterial {
    Textured<vec3> reflectance{vec3(1)};  // At normal incidence, each in [0, 1].
    Textured<float> alpha = 0.1f;         // Roughness, in [MIN_ALPHA, 1].

    bool operator==(const ConductorMaterial&) const = default;
};
inline constexpr float MIN_ALPHA = 1e-3f;

// A thin sheet that scatters light diffusely to both sides. reflectance + transmittance is at most 1 in each
// channel, so that it creates no energy.
struct DiffuseTransmissionMaterial {
    Textured<vec3> reflectance{vec3(0.5f)};    // On the side that light comes from.
    Textured<vec3> transmittance{vec3(0.5f)};  // On the other side.
    std::optional<Medium> inside{};            // Behind the surface; none: the same as in front of it.

    bool operator==(const DiffuseTransmissionMaterial&) const = default;
};

enum class Fresnel { schlick, exact };

// A smooth boundary between two transparent media: glass, water. Its front side is outside. Solids of it must
// be closed; they may lie within each other and overlap.
struct DielectricMaterial {
    float ior = 1.5f;  // Index of refraction behind the surface; above 0.
    std::optional<float>
        exterior_ior{};  // In front of it; none: that of the medium there, which is 1 outside of everything.
    Fresnel fresnel = Fresnel::schlick;
    Medium inside{};        // Behind the surface.
    uint32_t priority = 0;  // Where media overlap, the highest fills the space.

    bool operator==(const DielectricMaterial&) const = default;
};
inline constexpr uint32_t MAX_PRIORITY = 15;

// The end of a medium without a surface: light passes it straight. Solids of it must be closed.
struct InterfaceMaterial {
    Medium inside{};        // Behind it.
    uint32_t priority = 0;  // As in DielectricMaterial.

    bool operator==(const InterfaceMaterial&) const = default;
};

// Heights above a surface, for the normals that it would have if it were displaced by them.
struct BumpMap {
    Texture texture{};   // Only its channel is used.
    float scale = 1.0f;  // The height for a value of 1 [m].
    // As stated by a mesh's own file: the height for a value of 1 in units of the mesh, or, if the image
    // turns out to hold normals, the scale of the normal map.
    std::optional<float> multiplier{};

    bool operator==(const BumpMap&) const = default;
};

// Opacity: some rays pass a surface as if it were not there.
struct Opacity {
    Textured<float> value = 1.0f;   // The probability that a ray does not, in [0, 1].
    std::optional<float> cutoff{};  // If given, no ray passes where the value is at least this, and every ray
                                    // passes elsewhere.

    bool operator==(const Opacity&) const = default;
};

// Whether the camera sees a surface only by how it darkens what is behind the picture; docs/catcher.md
// defines it.
enum class Catcher {
    none,
    shadows,
    reflections,  // It also reflects the rest of the scene.
    holdout,      // Not at all: it sees what is behind the picture.
};

struct Material {
    std::string name;
    std::variant<DiffuseMaterial, PhongMaterial, MirrorMaterial, ConductorMaterial, DielectricMaterial,
                 DiffuseTransmissionMaterial, InterfaceMaterial, PrincipledMaterial>
        model;
    std::optional<NormalMap> normal_map{};
    std::optional<BumpMap> bump_map{};  // Not beside a normal map.
    Opacity opacity{};
    bool vertex_colors =
        false;  // The colours of vertices are factors of the model's first colour and of opacity.
    Catcher catcher = Catcher::none;

    bool operator==(const Material&) const = default;
};

// Radiance that a surface emits [W/(m^2 sr)], from its front side (counter-clockwise) or from both.
struct Emission {
    Textured<vec3> radiance{vec3(0)};  // Each >= 0 and finite.
    bool two_sided = false;

    bool operator==(const Emission&) const = default;
};

// Between the angles of a cone; t is linear in the cosine, 0 at the outer angle, 1 at the inner.
enum class SpotFalloff {
    square,      // t^2, as glTF's KHR_lights_punctual recommends.
    smoothstep,  // t^2 (3 - 2t), as in Cycles.
};

// The angles of a cone in which light leaves.
struct Cone {
    float inner_angle = 0.0f;       // From the axis [rad]; 0 <= inner_angle < outer_angle <= pi / 2.
    float outer_angle = PI / 4.0f;  // Beyond it, there is no light.
    SpotFalloff falloff = SpotFalloff::square;

    bool operator==(const Cone&) const = default;
};

// In which directions a surface emits.
struct Beam {
    // The full angle around the normal [rad], from MIN_SPREAD_DEGREES to pi. At half of it, the radiance has
    // fallen to 0, as linear in the tangent of the angle to the normal, as through a honeycomb; pi: it does
    // not fall.
    float spread = PI;
    std::optional<Cone> cone{};  // Of a sphere: only in that cone around Sphere::axis.

    bool operator==(const Beam&) const = default;
};
inline constexpr float MIN_SPREAD_DEGREES = 0.01f;

// Triangles over shared vertices, counter-clockwise seen from the front, in a space of their own. The array
// of an attribute is empty or has one element per position.
struct TriangleMesh {
    glm::dvec3 origin{0};            // Origin of the positions; see set_positions() in mesh.h.
    std::vector<vec3> positions{};   // Relative to the origin.
    std::vector<vec3> normals{};     // For shading; of any length, zero if there is none. Empty: flat.
    std::vector<vec4> tangents{};    // x, y, z: the direction in which u grows; w: -1 if the bitangent is
                                     // mirrored, otherwise 1.
    std::vector<vec2> uv0{};         // First set of texture coordinates, v upwards.
    std::vector<vec2> uv1{};         // Second set.
    std::vector<vec4> colors{};      // Linear RGB, and opacity.
    std::vector<uvec3> triangles{};  // Indices of vertices.
    // For each triangle, which of several objects it belongs to, counted from that of the shape. Empty: 0.
    // Only of meshes that are shown once.
    std::vector<uint32_t> groups{};
};

// A mesh of the scene, placed in the world.
struct MeshInstance {
    uint32_t mesh = 0;      // Index into Scene::meshes.
    Transform transform{};  // From the mesh's space to the world's.

    bool operator==(const MeshInstance&) const = default;
};

// A planar, convex quadrilateral with counter-clockwise corners.
struct Quad {
    dvec3 corners[4];
    vec2 uvs[4]{{0, 0}, {1, 0}, {1, 1}, {0, 1}};  // Texture coordinates.

    bool operator==(const Quad&) const = default;
};

// A true sphere; its front is outside.
struct Sphere {
    dvec3 center{0};
    double radius = 1.0;   // Above 0.
    dvec3 axis{0, 0, -1};  // Of the cone in which it emits, if it does; of any length above 0.

    bool operator==(const Sphere&) const = default;
};

// center + x e1 + y e2 with x^2 + y^2 <= 1: a disk, or an ellipse. Its front is the side that cross(e1, e2)
// points to.
struct Disk {
    dvec3 center{0};
    dvec3 e1{1, 0, 0};
    dvec3 e2{0, 1, 0};
    vec2 uvs[3]{{0.5f, 0.5f},
                {1.0f, 0.5f},
                {0.5f, 1.0f}};  // Texture coordinates of the centre, and of the ends of e1, e2.

    bool operator==(const Disk&) const = default;
};

// No object: see Shape::object.
inline constexpr uint32_t NO_OBJECT = UINT32_MAX;

using Geometry = std::variant<MeshInstance, Quad, Sphere, Disk>;

// What a shape is in the space of its object, and where the object is.
struct Origin {
    Geometry geometry;
    Transform transform;
};

struct Shape {
    Geometry geometry;
    uint32_t material = 0;                   // Index into Scene::materials.
    std::optional<Emission> emission;        // None: the shape does not emit.
    bool states_emission = false;            // If false, the emission is its material's, and changes with it.
    uint32_t object = NO_OBJECT;             // Index into Scene::objects; NO_OBJECT: it is one by itself.
    uint32_t copy = 0;                       // The number of this instance among those of the object, from 0.
    std::shared_ptr<const Origin> origin{};  // None: a mesh that the object's transform alone places, or
                                             // another geometry, of an object that no transform places.
    bool visible = true;                     // If false, the geometry is a mesh without triangles.
    Beam beam{};                             // Where its emission goes.
};

// Radiance from infinitely far away, as a latitude-longitude map [W/(m^2 sr)], row-major from the top. Its
// centre lies towards -Z, u grows to +X, v downwards from +Y; it is constant over each texel. A single texel
// is a constant sky.
struct Environment {
    uvec2 size{1, 1};                     // Texels.
    std::vector<vec3> radiance{vec3(0)};  // Finite, each >= 0; intensity included.
    float rotation = 0.0f;                // About +Y [rad], counter-clockwise seen from above.
    bool visible = true;                  // To camera rays; it always lights the scene and is reflected.
};

// Light from a point, equal in all directions. This light and the next two have no surface: only light
// samples find them.
struct PointLight {
    dvec3 position{0};
    vec3 intensity{1};  // [W/sr], each >= 0 and finite.
};

// Light from a point into a cone.
struct SpotLight {
    dvec3 position{0};
    dvec3 direction{0, 0, -1};  // Direction of the axis, of any length above 0.
    vec3 intensity{1};          // Up to the inner angle [W/sr], each >= 0 and finite.
    Cone cone{};
};

// Light from infinitely far away, in a single direction or from a disk there, which rays that leave the scene
// find, too, but those of the camera.
struct DirectionalLight {
    dvec3 direction{0, 0, -1};  // The direction of travel, of any length above 0.
    vec3 irradiance{1};         // On a surface perpendicular to it [W/m^2], each >= 0 and finite.
    float angle = 0.0f;         // Across the disk [rad]; 0: a single direction; below pi.
};

struct Light {
    std::string name;
    std::variant<PointLight, SpotLight, DirectionalLight> model;
};

// What of a scene changes with time, if it shows a frame of an animation: of its shapes, those from
// first_shape on, as many as `moves` has. Everything fitted to what the scene shows (the frame, a studio,
// views) is fitted to all times.
struct Motion {
    uint32_t first_shape = 0;
    std::vector<bool> moves{};  // Whether the shape moves, deforms, or is hidden at some time.
    DoubleBox still{};          // Around those that do not.
    // Corners of a body that holds the others at all times, but for about 2 % of their extent.
    std::vector<dvec3> ways{};

    bool covers(size_t shape) const { return shape - first_shape < moves.size(); }
    bool moves_shape(size_t shape) const { return covers(shape) && moves[shape - first_shape]; }
};

struct Scene {
    std::vector<Camera> cameras;  // At least one; the first is the default.
    Film film;
    IntegratorSettings integrator;
    std::vector<ImageFile> images;                            // Looked up by textures.
    std::unordered_map<std::string, uint32_t> image_indices;  // By real_path, for images that files name.
    std::vector<Material> materials;
    std::vector<TriangleMesh> meshes;
    std::vector<Shape> shapes;
    std::vector<std::string> objects;          // Names, all different, of what shapes are parts of.
    std::vector<Light> lights;                 // Besides shapes that emit and the environment.
    std::optional<Environment> environment;    // None: black.
    Medium medium{};                           // Where no solid is.
    std::optional<uint32_t> ground{};          // A shape that was added below the others; views ignore it.
    std::optional<Motion> motion;              // Only of a scene that shows a frame of an animation.
    FileReach reach;                           // The files that may be read for it.
    const NamedArrays* arrays = nullptr;       // Those that its text may name, while it is loaded.
    std::vector<std::filesystem::path> files;  // Files read in addition to a JSON scene file: meshes,
                                               // materials, images.
    std::vector<std::string> warnings;         // Oddities that the loader could use, each with its place.
    std::vector<std::pair<std::string, std::string>>
        attributes;  // The file's description of itself: name and text.
};

}  // namespace candela
