// A scene's records in stages, each of which is a value made of the scene and of stages before it. After a
// change of the scene, only those are made again that depend on it, and the records are the same bits as if
// all were.
//
//   textures, materials   of materials, emissions and images, and the unit of the frame
//   texels                of images
//   surfaces              of shapes that are not instances, in the frame: primitives, and pieces that emit
//   tree of surfaces      of these, only of a frame of an animation
//   mesh trees            of meshes that instances show, in frames of their own
//   area lights, lamps    of surfaces and mesh trees, and their emissions, materials and images
//   tree above            of the boxes around surfaces and instances, in the frame, or of the tree of
//   surfaces
//                         and the boxes around instances
//   leaves                of surfaces and mesh trees and the lights on them, in the order of the tree above
//   nodes                 of the tree above, mesh trees and the number of area lights
//   light tree            of area lights, the places of lamps and punctual lights
//   lights                of these, the power of the sky and the bounds of the tree
//   sky                   of the environment, and of whether it is a light
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/nesting.h"
#include "scene/scene_change.h"

namespace candela {

class SceneStages {
  public:
    struct Options {
        std::optional<SceneFrame> frame{};  // None: that which choose_frame() chooses.
        InstancingRule rule{};
        // Called when the texels of image i have been copied for the first time.
        std::function<void(size_t)> packed = [](size_t) {};
    };

    // Throws what build_gpu_scene() throws.
    explicit SceneStages(const Scene& scene) : SceneStages(scene, Options()) {}
    SceneStages(const Scene& scene, const Options& options);

    const GpuScene& joined() const { return gpu_; }
    GpuScene take() && { return std::move(gpu_); }

    // Makes the records those of `scene`, which differs by `change` from what it was. Returns the buffers
    // whose words have changed. Throws what build_gpu_scene() throws; the stages are then unusable.
    BufferSet update(const Scene& scene, const SceneChange& change);

  private:
    // What is being made, and which stages have other values than before.
    struct Work {
        const Scene& scene;
        const SceneChange& change;
        bool all = false;  // Nothing has been made before.
        bool frame = false, materials = false, attributes = false, normals = false, texels = false,
             surfaces = false, instances = false, trees = false, tree = false, leaves = false;
    };

    void make(Work& work, const std::function<void(size_t)>& packed);
    void make_frame(Work& work);
    void make_materials(Work& work);
    void make_nesting(const Work& work);
    void make_surfaces(Work& work);
    void make_mesh_trees(Work& work);
    void make_area_lights(Work& work);
    const Bvh* kept_tree(const Work& work);
    void make_tree(Work& work);
    void make_geometry(const Work& work);
    void make_lights(const Work& work);
    bool has_other_surfaces(const Work& work, const Instancing& instancing,
                            const std::vector<bool>& passable) const;
    void put(uint32_t array, std::vector<uvec4>&& words);

    std::optional<SceneFrame> given_frame_;
    InstancingRule rule_;

    // What later stages need of earlier ones; the arrays are in gpu_ alone.
    MaterialArrays materials_;
    Nesting nesting_;
    std::optional<std::string> coplanar_lights_;  // The warning about them.
    Instancing instancing_;
    std::vector<bool> passable_;  // Of each shape.
    bool has_normals_ = false;    // Some mesh has shading normals.
    FlatScene surfaces_;
    std::optional<Bvh> surface_tree_;
    MeshTrees trees_;
    AreaLights area_lights_;
    Lamps lamps_;
    SceneTree tree_;
    LightTree light_tree_;
    std::optional<SkyLight> sky_;
    bool sky_is_light_ = false;
    bool small_model_ = false;  // Whether the sky was made for one.

    GpuScene gpu_;
    BufferSet changed_;
};

}  // namespace candela
