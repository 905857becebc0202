// Finishes the shapes from a loader of any format, and adds them to a scene.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"
#include "scene/transform.h"
#include "scene/unique_names.h"

namespace candela {

// The appearance of a shape.
struct Appearance {
    uint32_t material = 0;             // Index into Scene::materials.
    std::optional<Emission> emission;  // None: the shape does not emit.
    bool states_emission = false;      // Otherwise the emission is the material's.
    Beam beam{};                       // Where it goes.
};

struct MeshPart {
    Appearance appearance;
    TriangleMesh mesh;
};

// Whether no coordinate of a point in world space lies beyond MAX_COORDINATE.
bool is_within_reach(dvec3 p);

// The message about a shape with such a point.
inline constexpr const char* TOO_FAR =
    "the shape reaches beyond 1e37 along an axis; check its numbers and its transform";

// The material of a file's faces without one: grey, or the colours of their vertices.
Material default_material(bool has_colors);

// Whether no coordinate of a mesh that is placed so lies beyond it.
bool reaches_no_farther(const TriangleMesh& mesh, const Transform& transform);

// Gives a mesh, none of whose triangles is flat, the normals and tangents that a loader leaves out. Throws
// Error if it lacks texture coordinates that its appearance needs.
void finish_mesh(const Scene& scene, const std::string& place, const Appearance& appearance,
                 TriangleMesh& mesh);

// Appends to a scene's shapes, materials and warnings. Messages begin with a place, such as
// `file:line:column`.
class SceneBuilder {
  public:
    // The scene must outlive the builder.
    explicit SceneBuilder(Scene& scene) : scene_(scene) {}

    Scene& scene() { return scene_; }
    void warn(const std::string& place, const std::string& warning) {
        scene_.warnings.push_back(place + ": " + warning);
    }

    // The shapes that are added from now on are parts of a new object of that name, or of a similar one if
    // that is taken; of its first instance, or of the next one. Before the first call, shapes are no
    // object's.
    void begin_object(const std::string& name);
    // The same for objects that have one mesh in common (TriangleMesh::groups); at least one.
    void begin_objects(const std::vector<std::string>& names);
    void begin_copy() { ++copy_; }

    // Adds a finished geometry in world space.
    template <class Geometry>
    void add(const Appearance& appearance, Geometry&& geometry) {
        push({.geometry = std::forward<Geometry>(geometry),
              .material = appearance.material,
              .emission = appearance.emission,
              .states_emission = appearance.states_emission,
              .beam = appearance.beam});
    }
    // Adds the parts of a mesh, each as a mesh with one instance. Completes their normals, and leaves out
    // flat triangles with a warning; adds tangents where the material needs them. Throws Error if no
    // triangles remain, if the mesh reaches too far, or if it lacks texture coordinates that its appearance
    // needs.
    void add_mesh(const std::string& place, const Transform& transform, std::vector<MeshPart> parts);
    // Adds a mesh of one part.
    void add_mesh(const std::string& place, const Appearance& appearance, const Transform& transform,
                  TriangleMesh mesh);
    // Adds another instance of the mesh of scene().shapes[shape], with the same appearance.
    void add_instance(const std::string& place, size_t shape, const Transform& transform);
    // Gives a mesh of the scene what a second appearance needs. Throws Error if it lacks texture coordinates.
    void complete_mesh(const std::string& place, const Appearance& appearance, uint32_t mesh);
    // Adds a shape with a finished geometry that is placed elsewhere. Returns false, and adds nothing, if it
    // reaches too far.
    bool add_placed(Shape shape);

    // Adds a material under its name, or a similar one if that is taken; returns its index.
    uint32_t add_material(Material material);

    // Materials that come from files: `name` joins those of file and material, as in `pot.obj/clay`. The
    // scene's material gets this name, or a similar one if it is taken. `find` returns null for a name that
    // was not added. The material's own name is ignored.
    const Appearance* find_file_appearance(const std::string& name) const;
    void add_file_appearance(const std::string& name, Material material,
                             const std::optional<Emission>& emission);

    // Index of the black material, for emitters that reflect nothing.
    uint32_t black();

  private:
    // The material whose heights are right for a mesh that is placed at that scale. (The first is
    // `material`.)
    uint32_t material_at_scale(uint32_t material, double scale);
    // Adds the shape to the current object.
    void push(Shape shape);
    // Whether an instance lies within reach.
    bool instance_fits(const MeshInstance& instance);

    Scene& scene_;
    std::map<std::string, Appearance, std::less<>> file_appearances_;
    std::map<uint32_t, std::map<double, uint32_t>> at_scale_;  // By material and scale.
    std::optional<uint32_t> black_;
    UniqueNames material_names_;  // Names of the first `named_` of scene_.materials.
    size_t named_ = 0;
    UniqueNames object_names_;  // Names of the first `named_objects_` of scene_.objects.
    size_t named_objects_ = 0;
    uint32_t object_ = NO_OBJECT;                 // As Shape::object
    uint32_t copy_ = 0;                           // and Shape::copy.
    std::vector<std::optional<Box>> mesh_boxes_;  // Boxes of meshes that have several instances.
};

}  // namespace candela
