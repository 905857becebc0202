// From the nodes of a glTF file to shapes, cameras and lights.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "load/gltf/gltf.h"
#include "load/gltf/gltf_file.h"
#include "load/gltf/pose.h"
#include "load/gltf/poser.h"
#include "load/gltf/primitive.h"
#include "scene/load_progress.h"
#include "scene/scene_builder.h"
#include "scene/unique_names.h"

namespace candela::gltf {

class SceneReader {
  public:
    // All must outlive the reader.
    SceneReader(File& file, Scene& scene, const GltfOptions& options, const LoadProgress& progress);

    // Adds what the nodes of the chosen scene show, in the order of the file. If it is read for its frames,
    // the scene then has all that is visible at some time, gets its motion, and can be posed by the result.
    std::shared_ptr<Poser> read();

  private:
    // A material as it looks on meshes with or without colours of their own.
    using MaterialUse = std::pair<std::optional<uint32_t>, bool>;

    // The chosen scene; nothing if the file has none.
    std::optional<Node> chosen_scene() const;
    // Its root nodes; of a file without scenes, all nodes without a parent.
    std::vector<uint32_t> root_nodes(const std::optional<Node>& scene) const;
    // How many primitives the nodes show.
    size_t count_primitives(const std::vector<uint32_t>& nodes) const;
    void read_node(uint32_t index);
    void show_what_blinks();
    void read_mesh(const Node& node, uint32_t index);
    void read_skinned_mesh(const Node& node, uint32_t index, const Node& primitives,
                           const std::vector<double>& weights);
    // Notes that the shapes from that one on, which the node has placed there, may change.
    void note_changes(size_t first, uint32_t node, const glm::dmat4& placement);
    // Notes the same of a mesh that deforms.
    void note_deformation(size_t shape, uint32_t node, const glm::dmat4& placement, const Node& primitive,
                          const std::optional<Node>& skin);
    // A mesh that stands still: its index, and the weights of its morph targets.
    using StandingMesh = std::pair<uint32_t, std::vector<double>>;
    // Shows the mesh with these primitives once.
    void place_mesh(const Node& node, const Node& primitives, const StandingMesh& mesh,
                    const Transform& transform);
    // Adds a primitive; returns the index of its shape, or nothing if it shows nothing.
    std::optional<size_t> add_primitive(const Node& primitive, const Deformation& deformation,
                                        const Transform& transform);
    // Whether the material of a primitive uses alpha.
    bool has_alpha(const Node& primitive) const;
    // The material of a primitive, by its variant.
    std::optional<uint32_t> material_of(const Node& primitive) const;
    // Index into scene_.materials; reads the file's at its first use.
    uint32_t material_for(MaterialUse use);
    uint32_t read_file_material(uint32_t index);
    void read_camera(const Node& node, const Node& camera, uint32_t index);
    void read_light_of(const Node& node, uint32_t index);

    File& file_;
    Scene& scene_;
    const GltfOptions& options_;
    const LoadProgress& progress_;
    SceneBuilder builder_;
    LightUnits units_;
    std::optional<uint32_t> variant_;
    std::unordered_map<std::string, uint32_t> known_materials_;  // The scene's materials before this file's.
    UniqueNames camera_names_;
    std::vector<PosedNode> nodes_;
    std::shared_ptr<Poser> poser_;
    size_t primitives_ = 0;                                              // Number shown.
    size_t done_ = 0;                                                    // Number read so far.
    std::map<MaterialUse, uint32_t> materials_;                          // Indices into scene_.materials.
    std::map<uint32_t, std::vector<glm::dmat4>> joints_;                 // Matrices of skins.
    std::map<StandingMesh, std::vector<std::optional<size_t>>> shapes_;  // Shapes of each primitive.
};

}  // namespace candela::gltf
