// See triangle_pairs.h.
#include "gpu_scene/triangle_pairs.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>

#include "bvh/measure.h"

namespace candela {
namespace {

// The triangles around each vertex: those of v are triangles[start[v] .. start[v + 1]).
class Fans {
  public:
    explicit Fans(const TriangleMesh& mesh) : start_(mesh.positions.size() + 1) {
        for (const uvec3 t : mesh.triangles) {
            for (int i = 0; i < 3; ++i)
                ++start_[t[i]];
        }
        std::inclusive_scan(start_.begin(), start_.end(), start_.begin());
        triangles_.resize(3 * mesh.triangles.size());
        // From the last to the first, so that each fan is in order.
        for (size_t i = mesh.triangles.size(); i-- > 0;) {
            for (int k = 0; k < 3; ++k)
                triangles_[--start_[mesh.triangles[i][k]]] = uint32_t(i);
        }
    }

    std::span<const uint32_t> around(uint32_t vertex) const {
        return std::span(triangles_).subspan(start_[vertex], start_[vertex + 1] - start_[vertex]);
    }

  private:
    std::vector<uint32_t> start_;
    std::vector<uint32_t> triangles_;
};

// The third vertex of a triangle that runs along the edge from `from` to `to`.
std::optional<uint32_t> apex(uvec3 t, uint32_t from, uint32_t to) {
    for (int i = 0; i < 3; ++i) {
        if (t[i] == from && t[(i + 1) % 3] == to) return t[(i + 2) % 3];
    }
    return std::nullopt;
}

Box box_of(const TriangleMesh& mesh, uvec3 t) {
    Box box;
    for (int i = 0; i < 3; ++i)
        box.extend(mesh.positions[t[i]]);
    return box;
}

// The best partner for triangle `first` among those not yet taken, or the triangle alone.
TrianglePair best_pair(const TriangleMesh& mesh, const Fans& fans, const std::vector<bool>& taken,
                       uint32_t first) {
    const uvec3 t = mesh.triangles[first];
    TrianglePair best{uvec4(t.x, t.y, t.z, t.z), first, first};
    const Box box = box_of(mesh, t);
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
        const uint32_t c = t[i], a = t[(i + 1) % 3], b = t[(i + 2) % 3];
        // Any number of triangles may share a vertex; neighbours are mostly near in order.
        constexpr size_t MAX_LOOKED_AT = 64;
        const std::span<const uint32_t> fan = fans.around(a);
        const auto after = size_t(std::ranges::upper_bound(fan, first) - fan.begin());
        for (const uint32_t other : fan.subspan(after, std::min(fan.size() - after, MAX_LOOKED_AT))) {
            if (taken[other]) continue;
            const std::optional<uint32_t> d = apex(mesh.triangles[other], a, c);
            if (!d) continue;
            Box both = box;
            both.extend(mesh.positions[*d]);
            // Above 0 if the pair is worth it.
            const double gain =
                half_area(box) + half_area(box_of(mesh, mesh.triangles[other])) - half_area(both);
            if (gain < 0.0 || (best.second != first && gain <= largest)) continue;
            largest = gain;
            best = {uvec4(a, b, c, *d), first, other};
        }
    }
    return best;
}

}  // namespace

std::vector<TrianglePair> pair_triangles(const TriangleMesh& mesh) {
    const Fans fans(mesh);
    std::vector<bool> taken(mesh.triangles.size());
    std::vector<TrianglePair> pairs;
    pairs.reserve(mesh.triangles.size() / 2 + 1);
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        if (taken[i]) continue;
        pairs.push_back(best_pair(mesh, fans, taken, i));
        taken[pairs.back().second] = true;
    }
    return pairs;
}

std::vector<TrianglePair> single_triangles(const TriangleMesh& mesh) {
    std::vector<TrianglePair> singles;
    singles.reserve(mesh.triangles.size());
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const uvec3 t = mesh.triangles[i];
        singles.push_back({uvec4(t.x, t.y, t.z, t.z), i, i});
    }
    return singles;
}

}  // namespace candela
