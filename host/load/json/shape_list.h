// What the readers of shapes share: where a shape goes, and the values that every shape may have.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "load/json/loader_textures.h"
#include "load/json/transforms.h"
#include "load/node.h"
#include "scene/scene_builder.h"

namespace candela {

// The shapes of a scene while they are read.
class ShapeList : public SceneBuilder {
  public:
    // Files are relative to `folder`. scene.materials holds exactly the materials that the scene file
    // defines; the scene must outlive the list.
    ShapeList(std::filesystem::path folder, Scene& scene);

    // The file that a node names. Throws Error if it is out of reach.
    std::filesystem::path path_of(const Node& file) { return find_file(file, folder_, scene().reach); }

    // The material and emission that a shape's node names. An emitter without a material gets a black one.
    // Zero emission means none; a shape without the key uses its material's. Throws Error if the node has
    // neither, or names an unknown material.
    Appearance appearance_of(const Node& node);
    // The material and emission of a shape of an object that an instance's node shows: those that the node
    // names replace the shape's own.
    Appearance appearance_of(const Node& node, const Shape& shape);
    // The emission of a shape's node; none if it is absent or zero. Throws Error for two_sided without it.
    std::optional<Emission> emission_of(const Node& node);
    // The angle [rad] within which a shape's emission leaves.
    static float spread_of(const Node& node);
    // How the camera sees the shapes from that one on, which a shape's node describes: whether they are
    // catchers, or hidden. Throws Error if a catcher emits light.
    void read_seen(const Node& node, size_t first);
    // Adds a geometry of a space of its own, which the transform places. Returns the shape.
    const Shape& add_placed_by(const Appearance& appearance, const Geometry& own, const Transform& transform);
    // The transform of a shape's node; the identity if it has none.
    static Transform transform_of(const Node& node);

  private:
    uint32_t index_of(const Node& material);

    std::filesystem::path folder_;
    std::map<std::string, uint32_t, std::less<>> indices_;  // Indices of the materials that the scene file
                                                            // defines.
    // Materials of catchers and of what is hidden, by those of others and what a shape says.
    std::map<std::tuple<uint32_t, std::optional<Catcher>, std::optional<bool>>, uint32_t> seen_;
};

// Returns a point in world space. Throws Error at the place of `node`, where it came from, if it lies too far
// out.
dvec3 within_reach(const Node& node, dvec3 p);

}  // namespace candela
