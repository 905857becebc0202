// Ref: Khronos, "glTF 2.0 Specification", section 3.5.2.
#include "load/gltf/node_trees.h"

#include "base/text.h"

namespace candela::gltf {

NodeTrees::NodeTrees(File& file, const std::vector<uint32_t>& roots, bool has_scene,
                     std::vector<PosedNode>& nodes)
    : file_(file), nodes_(nodes), states_(nodes.size(), State::unseen) {
    for (const uint32_t root : roots)
        walk(root, shown_);
    strict_ = !has_scene;
    std::vector<bool> is_child(nodes.size(), false);
    for (uint32_t i = 0; i < nodes.size(); ++i) {
        if (strict_ || states_[i] != State::unseen) continue;
        for (const uint32_t child : nodes[i].children)
            is_child[child] = true;
    }
    for (uint32_t i = 0; i < nodes.size(); ++i) {
        if (states_[i] == State::unseen && !is_child[i]) walk(i, others_);
    }
}

void NodeTrees::walk(uint32_t root, std::vector<uint32_t>& order) {
    if (states_[root] != State::unseen) {
        meet_root_again(root);
        return;
    }
    enter(root, order);
    while (!path_.empty()) {
        Visit& visit = path_.back();
        const uint32_t node = visit.node;
        const std::vector<uint32_t>& children = nodes_[node].children;
        if (visit.next == children.size()) {
            states_[node] = State::done;
            path_.pop_back();
            continue;
        }
        const uint32_t child = children[visit.next];
        if (states_[child] == State::unseen) {
            ++visit.next;
            nodes_[child].parent = node;
            enter(child, order);
        } else {
            if (strict_) meet_child_again(visit, child);
            ++visit.next;
        }
    }
}

void NodeTrees::enter(uint32_t node, std::vector<uint32_t>& order) {
    states_[node] = State::open;
    order.push_back(node);
    path_.push_back({node});
}

void NodeTrees::meet_root_again(uint32_t root) {
    if (nodes_[root].parent) {
        twice_.push_back({root, *nodes_[root].parent});
    } else {
        file_.warn(file_.element("nodes", root), "the node is listed twice in the scene, and shown once");
    }
}

void NodeTrees::meet_child_again(const Visit& above, uint32_t child) {
    if (states_[child] == State::open)
        file_.element("nodes", child).fail("the node is its own descendant; nodes must form trees");
    const std::optional<uint32_t>& parent = nodes_[child].parent;
    const Node reference = file_.element("nodes", above.node).require("children")[above.next];
    if (!parent) {
        twice_.push_back({child, above.node});
    } else if (*parent == above.node) {
        file_.warn(reference, concat("node ", child, " is listed twice among the children, and shown once"));
    } else {
        reference.fail(concat("node ", child, " has a parent already, node ", *parent,
                              "; copy the node, so that each has one"));
    }
}

void NodeTrees::place() {
    for (const std::vector<uint32_t>* order : {&shown_, &others_}) {
        for (const uint32_t i : *order) {
            PosedNode& node = nodes_[i];
            const glm::dmat4 local = node.matrix ? *node.matrix : matrix_of(node.trs);
            node.world = node.parent ? nodes_[*node.parent].world * local : local;
            if (node.parent) node.is_visible &= nodes_[*node.parent].is_visible;
        }
    }
    for (const Twice& twice : twice_) {
        const Node node = file_.element("nodes", twice.node);
        if (nodes_[twice.parent].world != glm::dmat4(1.0)) {
            node.fail(concat("the node is a root of the scene and a child of node ", twice.parent,
                             ", which moves it: it would be at two places; leave one of them out"));
        }
        file_.warn(node, concat("the node is a root of the scene and a child of node ", twice.parent,
                                ", and shown once"));
    }
}

}  // namespace candela::gltf
