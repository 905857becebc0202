// Renderer::motion(): from the points that the kernel of first points finds to how far they have moved.
#include "render/motion.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <vector>

#include "render/part_of_word.h"
#include "render/renderer.h"
#include "scene/projection.h"
#include "shared/first_points.h"

namespace candela {
namespace {

// Pixels of a submission: at one ray each, far below a watchdog's limit.
constexpr uint32_t SUBMISSION_PIXELS = 1u << 18;

using PixelWords = std::array<uvec4, FIRST_POINT_WORDS>;

// A point of the world, now and in the frame before.
struct MovingPoint {
    dvec3 now{0.0}, before{0.0};
};

// Finds where points were.
class PointOfWords {
  public:
    PointOfWords(const GpuScene& scene, const SceneMotion& motion)
        : scene_(scene), motion_(motion), part_of_(scene) {
        for (const InstancePlace& place : scene.instances)
            first_ids_.emplace(place.shape, instance_at(scene, place).first_id);
        for (const ShapeIds& ids : scene.shape_ids)
            first_ids_.try_emplace(ids.shape, ids.first);
        for (const auto& [shape, moved] : motion.shapes)
            back_.emplace(shape, moved.before * inverse(moved.now));
    }

    MovingPoint operator()(const PixelWords& words) {
        const uint32_t shape = part_of_(words[0].x).shape;
        const dvec3 p =
            scene_.frame.world(std::bit_cast<vec3>(std::array{words[1].x, words[1].y, words[1].z}));
        const auto moved = motion_.shapes.find(shape);
        if (moved == motion_.shapes.end()) return {p, p};
        const ShapeMotion& motion = moved->second;
        if (motion.corners.empty()) return {p, transformed(back_.at(shape), p)};
        const uvec3 corners = motion.corners[words[0].y - first_ids_.at(shape)];
        const double x = std::bit_cast<float>(words[0].z), y = std::bit_cast<float>(words[0].w);
        const auto at = [&](const std::vector<dvec3>& positions) {
            const dvec3 a = positions[corners.x];
            return a + x * (positions[corners.y] - a) + y * (positions[corners.z] - a);
        };
        return {transformed(motion.now, at(motion.positions_now)),
                transformed(motion.before, at(motion.positions_before))};
    }

  private:
    static dvec3 transformed(const glm::dmat4& matrix, dvec3 p) { return dvec3(matrix * dvec4(p, 1.0)); }

    const GpuScene& scene_;
    const SceneMotion& motion_;
    PartOfWord part_of_;
    std::unordered_map<uint32_t, uint32_t> first_ids_;  // The id of each shape's first triangle.
    std::unordered_map<uint32_t, glm::dmat4> back_;     // From where shapes are to where they were.
};

// The motion of what a pixel with its centre at `film` shows.
vec2 motion_of(const Projection& now, const Projection& before, glm::dvec2 film, const PixelWords& words,
               PointOfWords& point_of) {
    std::optional<glm::dvec2> from, to;
    if (words[0].x == 0) {
        const std::optional<dvec3> direction = now.direction_at(film);
        if (!direction || now.is_parallel()) return vec2(0.0f);
        to = now.place_of_direction(*direction);
        from = before.place_of_direction(*direction);
    } else {
        const MovingPoint point = point_of(words);
        to = now.place_of(point.now);
        from = before.place_of(point.before);
    }
    if (!from) return vec2(INFINITE);
    // Rounding may put a point that the camera touches behind it.
    return vec2(now.way(*from, to.value_or(film)));
}

}  // namespace

std::vector<vec2> Renderer::motion(const GpuScene& scene, const Camera& camera, const MotionSince& since) {
    const uvec2 size = image_size();
    const uint32_t rows = std::clamp(SUBMISSION_PIXELS / size.x, 1u, size.y);
    const vk::Buffer words(*device_, uint64_t{rows} * size.x * sizeof(PixelWords), vk::BufferUsage::readback,
                           "first points");
    vk::Kernel kernel = scene_kernel(RenderKernel::first_points);
    kernel.bind(BINDING_FIRST_POINTS, words);
    const Projection now(camera, settings_.size), before(since.camera, settings_.size);
    PointOfWords point_of(scene, *since.scene);
    std::vector<vec2> motion;
    motion.reserve(size_t(size.x) * size.y);
    for (uint32_t y = 0; y < size.y; y += rows) {
        const uvec2 tile(size.x, std::min(rows, size.y - y));
        record(kernel,
               {.origin = {0, y}, .size = tile, .stride = {1, 1}, .target_samples = 0, .lane = LANES});
        commands_.submit_and_wait();
        for (uint32_t i = 0; i < tile.x * tile.y; ++i) {
            PixelWords of_pixel;
            std::memcpy(of_pixel.data(), words.mapped() + i * sizeof of_pixel, sizeof of_pixel);
            const glm::dvec2 corner(settings_.crop.x0 + i % size.x, settings_.crop.y0 + y + i / size.x);
            motion.push_back(motion_of(now, before, corner + 0.5, of_pixel, point_of));
        }
    }
    return motion;
}

}  // namespace candela
