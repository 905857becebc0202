// From the nodes of a glTF file to shapes, cameras and lights.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "load/gltf/gltf.h"
#include "load/gltf/gltf_file.h"
#include "load/gltf/pose.h"
#include "load/gltf/primitive.h"
#include "scene/load_progress.h"
#include "scene/scene_builder.h"
#include "scene/unique_names.h"

namespace candela::gltf {

class SceneReader {
  public:
    // All must outlive the reader.
    SceneReader(File& file, Scene& scene, const GltfOptions& options, const LoadProgress& progress);

    // Adds what the nodes of the chosen scene show, in the order of the file.
    void read();

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
    void read_mesh(const Node& node, const PosedNode& posed);
    // A mesh that stands still: its index, and the weights of its morph targets.
    using StandingMesh = std::pair<uint32_t, std::vector<double>>;
    // Shows the mesh with these primitives once.
    void place_mesh(const Node& node, const Node& primitives, const StandingMesh& mesh,
                    const Transform& transform);
    // Adds a primitive; returns the index of its shape, or nothing if it shows nothing.
    std::optional<size_t> add_primitive(const Node& primitive, const Deformation& deformation,
                                        const Transform& transform);
    // The material of a primitive, by its variant.
    std::optional<uint32_t> material_of(const Node& primitive) const;
    // Index into scene_.materials; reads the file's at its first use.
    uint32_t material_for(MaterialUse use);
    uint32_t read_file_material(uint32_t index);
    void read_camera(const Node& node, const Node& camera, const PosedNode& posed);

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
    size_t primitives_ = 0;                                              // Number shown.
    size_t done_ = 0;                                                    // Number read so far.
    std::map<MaterialUse, uint32_t> materials_;                          // Indices into scene_.materials.
    std::map<uint32_t, std::vector<glm::dmat4>> joints_;                 // Matrices of skins.
    std::map<StandingMesh, std::vector<std::optional<size_t>>> shapes_;  // Shapes of each primitive.
};

}  // namespace candela::gltf
