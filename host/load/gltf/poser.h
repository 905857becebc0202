// Poser: shows a scene of a glTF file at one time of its animation after the other, in place. Only what moves
// is made again, and what it makes depends on the time alone, not on the times before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "load/gltf/animation.h"
#include "load/gltf/gltf.h"
#include "load/gltf/gltf_file.h"
#include "load/gltf/node_trees.h"
#include "load/gltf/primitive.h"
#include "load/gltf/ways.h"
#include "scene/places_before.h"
#include "scene/scene.h"
#include "scene/scene_change.h"

namespace candela::gltf {

class Poser {
  public:
    // A shape that a node shows, if it may change.
    struct PosedShape {
        uint32_t shape = 0;
        uint32_t node = 0;
        glm::dmat4 placement{1.0};        // From the mesh's space to the node's.
        std::optional<Node> primitive{};  // Of a mesh that deforms, which the shape alone has,
        std::optional<Node> skin{};       // and its skin.
        bool has_alpha = false;           // The file's material uses alpha.
        uint32_t mesh = 0;                // Set by complete(): the shape's mesh where it is visible.
        // Of a mesh that deforms: for each vertex that was added for attributes, the one that it copies.
        std::vector<uint32_t> copies{};
    };
    struct PosedLight {
        uint32_t light = 0;
        uint32_t node = 0;
        Node reference;
    };

    // Reads the animation that the options choose. `roots`: of the chosen scene, if there is one. Throws
    // Error (usage) if nothing is animated.
    Poser(std::shared_ptr<Contents> contents, const GltfOptions& options, const std::vector<uint32_t>& roots,
          bool has_scene);

    // Whether a node, or one above, moves or is hidden at some time.
    bool changes(uint32_t node) const { return moves_[node] || hides_[node]; }
    // Whether the node itself is hidden or shown.
    bool blinks(uint32_t node) const { return blinks_[node]; }
    // Whether the mesh of the node changes its form.
    bool deforms(uint32_t node) const;

    // What the scene has of them is posed from now on.
    void add(const PosedShape& shape) { shapes_.push_back(shape); }
    void add_camera(uint32_t camera, uint32_t node) { cameras_.push_back({camera, node, {}}); }
    void add(const PosedLight& light) { lights_.push_back(light); }
    // Called when all is added: gives the scene, whose shapes are this file's, its motion.
    void complete(Scene& scene);

    // The times of the first and of the last key [s].
    std::pair<double, double> times() const { return times_; }
    // Shows the scene at that time [s], and returns what of it has changed. If it throws Error, the scene is
    // unusable.
    SceneChange pose(Scene& scene, double time);
    // Where what `scene` shows, as pose() has left it, was at another time [s].
    PlacesBefore places_at(const Scene& scene, double time);
    // The warnings since the last call.
    std::vector<std::string> take_warnings();

  private:
    struct PosedCamera {
        uint32_t camera;
        uint32_t node;
        std::optional<Camera> before;  // As the file has it.
    };

    void find_changes();
    void place(double time);
    std::vector<Cloud> clouds_of(const Scene& scene, const std::vector<double>& times);
    std::map<uint32_t, WeightRanges> weights_at(const std::vector<double>& times);
    std::vector<dvec3> find_ways(const Scene& scene);
    std::vector<double> weights_of(uint32_t node) const;
    Deformation deformation_of(const PosedShape& posed, const std::vector<double>& weights);
    void pose_shape(Scene& scene, PosedShape& posed, SceneChange& change);
    void pose_camera(PosedCamera& posed, Camera& camera);
    TriangleMesh deformed(const Scene& scene, PosedShape& posed);
    std::vector<dvec3> positions_of(const PosedShape& posed);
    const std::vector<glm::dmat4>& joints_of(const Node& skin);

    std::shared_ptr<Contents> contents_;
    GltfOptions options_;
    File file_;
    std::vector<PosedNode> nodes_;  // Before trees_, which refers to it.
    NodeTrees trees_;
    std::vector<PosedNode> file_nodes_;  // As the file has them.
    Animation animation_;
    std::pair<double, double> times_{};
    // By node: itself or one above moves; may be hidden; itself is hidden or shown; has animated weights.
    std::vector<bool> moves_, hides_, blinks_, has_weights_;
    std::vector<PosedShape> shapes_;
    std::vector<PosedCamera> cameras_;
    std::vector<PosedLight> lights_;
    uint32_t nothing_ = 0;                                   // A mesh without triangles.
    std::map<std::string, std::vector<glm::dmat4>> joints_;  // Of skins, at the current time.
    size_t told_ = 0;                                        // Warnings that have been taken.
};

}  // namespace candela::gltf
