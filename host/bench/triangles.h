// The triangles of a scene by their ids, as in its records: a mesh that instances share has its triangles
// once.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/math.h"
#include "gpu_scene/gpu_scene.h"

namespace candela {

// In the frame of the scene, or in the space of a mesh.
struct BenchTriangle {
    vec3 a, b, c;
};

class BenchTriangles {
  public:
    struct Instance {
        uint32_t mesh;      // Index into meshes().
        uint32_t first_id;  // First id of its triangles.
        glm::dmat3 to_scene;
        vec3 centre;  // The place of the mesh's origin.
    };

    // For a scene of triangles alone, at most 2^32 of them.
    explicit BenchTriangles(const GpuScene& scene);

    // The triangle of that id, in the frame of the scene.
    BenchTriangle at(uint32_t id) const;
    // The number that is visible.
    uint64_t count() const { return count_; }
    // The bounds of the triangles.
    const Box& bounds() const { return bounds_; }

    // Triangles in the frame of the scene, by id; triangles of meshes, by their ids in an instance minus its
    // first id.
    const std::vector<BenchTriangle>& baked() const { return baked_; }
    const std::vector<std::vector<BenchTriangle>>& meshes() const { return meshes_; }
    // In the order of their ids, which follow those of the baked triangles.
    const std::vector<Instance>& instances() const { return instances_; }

  private:
    std::vector<BenchTriangle> baked_;
    std::vector<std::vector<BenchTriangle>> meshes_;
    std::vector<Instance> instances_;
    uint64_t count_ = 0;
    Box bounds_;
};

// "190 k triangles", "1 M triangles", "72 triangles": a number of triangles for people, to three digits.
std::string triangles_text(uint64_t triangles);

}  // namespace candela
