// Ref: Khronos, "glTF 2.0 Specification", section 3.10.
#include "load/gltf/camera.h"

#include <algorithm>
#include <cmath>

#include "base/limits.h"
#include "load/gltf/values.h"

namespace candela::gltf {

Camera read_camera(File& file, const Node& camera) {
    constexpr uint32_t LINES = 720;
    const Node type = camera.require("type");
    Camera result;
    double aspect = 0.0;  // 0: the file states none.
    if (type.string() == "orthographic") {
        const Node sizes = camera.require("orthographic");
        const auto half = [&](const char* key) {
            const Node value = sizes.require(key);
            if (value.number() < 0.0) file.warn(value, "the sign of the view's size is ignored");
            const double size = std::abs(value.number());
            if (size < double(FLOAT_MIN) || size > double(MAX_COORDINATE))
                value.fail_expected("a number from 1.2e-38 to 1e37, half the size of the view");
            return size;
        };
        const double half_width = half("xmag"), half_height = half("ymag");
        result.ortho_height = 2.0 * half_height;
        aspect = half_width / half_height;
    } else if (type.string() == "perspective") {
        const Node view = camera.require("perspective");
        const Node angle = view.require("yfov");
        result.vertical_fov = float(angle.number());
        if (!(result.vertical_fov > 0.0f && result.vertical_fov < PI))
            angle.fail_expected("an angle between 0 and pi");
        if (const auto ratio = view.find("aspectRatio")) {
            aspect = std::max(ratio->number(), 0.0);
            if (aspect == 0.0) file.warn(*ratio, "an aspect ratio that is not above 0 is ignored");
        }
    } else {
        type.fail_expected(R"("perspective" or "orthographic")");
    }
    if (aspect > 0.0) {
        result.film_size =
            uvec2(uint32_t(std::clamp(std::round(aspect * LINES), 1.0, double(MAX_PICTURE_SIZE))), LINES);
    }
    return result;
}

bool place_camera(const Node& node, const glm::dmat4& world, Camera& camera) {
    const dvec3 backwards(world[2]);
    const dvec3 up(world[1]);
    if (!has_direction(cross(backwards, up)) || !has_direction(backwards) || !has_direction(up)) return false;
    camera.position = position_of(node, world);
    camera.look_at = camera.position - normalize(backwards);
    camera.up = vec3(normalize(up));
    return true;
}

}  // namespace candela::gltf
