// The hierarchy of a glTF file's nodes: the trees of a scene, and the other trees.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "load/gltf/gltf_file.h"
#include "load/gltf/pose.h"

namespace candela::gltf {

class NodeTrees {
  public:
    // Sets the parents of the nodes, which the lists of children name. A root has none, even if a node
    // outside of the scene lists it. Throws Error if a node below the roots has two parents or is its own
    // descendant. Other nodes are not shown, but skins may need their positions; if there is a scene, their
    // faults are ignored.
    NodeTrees(File& file, const std::vector<uint32_t>& roots, bool has_scene, std::vector<PosedNode>& nodes);

    // The nodes below the roots, in the order of the file.
    const std::vector<uint32_t>& shown() const { return shown_; }

    // Computes PosedNode::world of all nodes. Throws Error for a root that is also below another root, and
    // would have a second position there.
    void place();

  private:
    enum class State : uint8_t { unseen, open, done };
    // A node whose children are being visited.
    struct Visit {
        uint32_t node = 0;
        size_t next = 0;  // Index of the next child.
    };
    // A root that is a child, too.
    struct Twice {
        uint32_t node = 0;
        uint32_t parent = 0;
    };

    void walk(uint32_t root, std::vector<uint32_t>& order);
    void enter(uint32_t node, std::vector<uint32_t>& order);
    void meet_root_again(uint32_t root);
    void meet_child_again(const Visit& above, uint32_t child);

    File& file_;
    std::vector<PosedNode>& nodes_;
    bool strict_ = true;
    std::vector<State> states_;
    std::vector<Visit> path_;      // From a root down to the node that is being visited.
    std::vector<uint32_t> shown_;  // Parents before their children, as the other nodes.
    std::vector<uint32_t> others_;
    std::vector<Twice> twice_;
};

}  // namespace candela::gltf
