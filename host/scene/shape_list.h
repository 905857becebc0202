// What the readers of shapes share: where a shape goes, and the values that every shape may have.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/node.h"
#include "scene/scene.h"
#include "scene/transform.h"

namespace candela {

// The keys that every shape may have, for Node::allow_only.
inline constexpr std::array<std::string_view, 5> SHAPE_KEYS{"type", "material", "emission", "two_sided",
                                                            "transform"};

// What a shape is apart from its geometry.
struct Appearance {
    uint32_t material = 0;             // Index into Scene::materials.
    std::optional<Emission> emission;  // None: the shape does not emit.
};

struct MeshPart {
    Appearance appearance;
    TriangleMesh mesh;
};

// The shapes of a scene while they are read. Appends to the scene's shapes, materials, files and warnings.
class ShapeList {
  public:
    // Files are relative to `folder`. scene.materials holds exactly the materials that the scene file
    // defines; the scene must outlive the list.
    ShapeList(std::filesystem::path folder, Scene& scene);

    Scene& scene() { return scene_; }
    std::filesystem::path path_of(const std::string& file) const { return folder_ / file; }

    // The material and emission that a shape's node names. An emitter without a material gets a black one,
    // and emission of zero is none. Throws Error if the node has neither, or for a name of no material.
    Appearance appearance_of(const Node& node);
    // The emission of a shape's node; none if it is absent or zero. Throws Error for two_sided without it.
    static std::optional<Emission> emission_of(const Node& node);
    // The transform of a shape's node; the identity if it has none.
    static Transform transform_of(const Node& node);

    // Adds a finished geometry, which is in world space.
    template <class Geometry>
    void add(const Appearance& appearance, Geometry&& geometry) {
        scene_.shapes.push_back({std::forward<Geometry>(geometry), appearance.material, appearance.emission});
    }
    // Adds a mesh, given in parts, whose positions are in world space, but whose normals and winding are not
    // yet. Leaves out flat triangles with a warning; throws Error if no other is left in any part. Both name
    // the place of `node`.
    void add_mesh(const Node& node, const Transform& transform, std::vector<MeshPart> parts);
    // Adds a mesh of one part.
    void add_mesh(const Node& node, const Appearance& appearance, const Transform& transform,
                  TriangleMesh mesh);

    // Materials that files bring along: `name` is the file's and the material's, as `pot.obj/clay`. In the
    // scene a material is called so, or similarly if another has that name. `find` returns null for one that
    // was not added.
    const Appearance* find_file_appearance(const std::string& name) const;
    void add_file_appearance(const std::string& name, const decltype(Material::model)& model,
                             const std::optional<Emission>& emission);

  private:
    uint32_t index_of(const Node& material) const;
    uint32_t black();

    std::filesystem::path folder_;
    Scene& scene_;
    std::map<std::string, uint32_t, std::less<>> indices_;  // Of the materials that the scene file defines.
    std::map<std::string, Appearance, std::less<>> file_appearances_;
    std::optional<uint32_t> black_;
};

// A point in world space as floats. Throws Error at the place of `node`, where it came from, if it does not
// fit.
vec3 rounded(const Node& node, glm::dvec3 p);

}  // namespace candela
