// The decoded tree is conservative: a traversal reaches the leaf of every box that brute force finds, for
// rays that run along axes, in faces and through corners too.
#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "bvh/bvh.h"
#include "unit/bvh/bvh_boxes.h"

namespace candela {
namespace {

struct Ray {
    glm::dvec3 origin;
    glm::dvec3 direction;
};

// Whether the ray hits the closed box at any t >= 0.
bool meets(const Box& box, const Ray& ray) {
    if (box.is_empty()) return false;  // Inverted, as for a child that does not exist.
    double begin = 0.0, end = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a) {
        const double lo = double(box.lo[a]) - ray.origin[a], hi = double(box.hi[a]) - ray.origin[a];
        if (ray.direction[a] == 0.0) {
            if (lo > 0.0 || hi < 0.0) return false;
            continue;
        }
        const double t0 = lo / ray.direction[a], t1 = hi / ray.direction[a];
        begin = std::max(begin, std::min(t0, t1));
        end = std::min(end, std::max(t0, t1));
    }
    return begin <= end;
}

// The primitives of all leaves that the ray reaches, in order of index.
std::vector<uint32_t> reach(const Bvh& bvh, const Ray& ray) {
    std::vector<uint32_t> stack{0}, primitives;
    while (!stack.empty()) {
        const uint32_t reference = stack.back();
        stack.pop_back();
        if (is_leaf(reference)) {
            primitives.push_back(bvh.order[leaf_position(reference)]);
            continue;
        }
        const BvhNode node = unpack(bvh.nodes[reference]);
        for (uint32_t c = 0; c < bvh_child_count(node); ++c) {
            if (meets(child_box(node, c), ray)) stack.push_back(bvh_child(node.children, c));
        }
    }
    std::sort(primitives.begin(), primitives.end());
    return primitives;
}

void expect_conservative(const std::vector<Box>& boxes, int rays) {
    const Bvh bvh = build_bvh(boxes);
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    size_t hits = 0;
    for (int i = 0; i < rays; ++i) {
        Ray ray;
        for (int a = 0; a < 3; ++a) {
            ray.origin[a] = uniform(generator);
            ray.direction[a] = uniform(generator);
        }
        const Box& target = boxes[size_t(i) % boxes.size()];
        if (i % 2 == 1)
            ray.origin = glm::dvec3(i % 4 == 1 ? target.lo : target.hi);  // A corner: on three faces.
        if (i % 3 == 1) ray.direction[i % 5 % 3] = 0.0;
        if (i % 3 == 2) ray.direction = glm::dvec3(0.0), ray.direction[i % 5 % 3] = i % 7 < 3 ? 1.0 : -1.0;
        const std::vector<uint32_t> reached = reach(bvh, ray);
        for (uint32_t primitive = 0; primitive < boxes.size(); ++primitive) {
            if (!meets(boxes[primitive], ray)) continue;
            ++hits;
            ASSERT_TRUE(std::binary_search(reached.begin(), reached.end(), primitive))
                << "ray " << i << ", primitive " << primitive;
        }
    }
    EXPECT_GT(hits, size_t(rays) / 2);
}

TEST(BvhTraversal, ReachesEveryBoxThatBruteForceFinds) {
    expect_conservative(random_boxes(2000, 0.05f), 2000);
    expect_conservative(random_boxes(300, 1.0f), 2000);
    expect_conservative(random_boxes(3, 0.3f), 500);
}

TEST(BvhTraversal, ReachesFlatBoxes) {
    std::vector<Box> boxes = random_boxes(999, 0.2f);
    for (size_t i = 0; i < boxes.size(); ++i)
        boxes[i].hi[int(i % 3)] = boxes[i].lo[int(i % 3)];
    expect_conservative(boxes, 2000);
}

TEST(BvhTraversal, ReachesBoxesOfVeryDifferentSizes) {
    std::vector<Box> boxes = random_boxes(500, 0.1f);
    float scale = 1.0f;
    for (Box& box : boxes) {
        box = {box.lo * scale, box.hi * scale};
        scale *= 0.9f;
    }
    expect_conservative(boxes, 2000);
}

TEST(BvhTraversal, MissesTheEmptyTree) {
    EXPECT_TRUE(reach(build_bvh({}), {glm::dvec3(0), glm::dvec3(1)}).empty());
}

}  // namespace
}  // namespace candela
