// See describe_views.h.
#include "serve/describe_views.h"

#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

#include "serve/describe.h"
#include "serve/picture_request.h"
#include "views/views.h"

namespace candela::serve {
namespace {

constexpr uint32_t MAX_VIEWS = 4096;

double read_elevation(const Node& node) {
    return glm::radians(double(node.number(-90.0f, 90.0f)));
}

ViewStyle read_style(const Node& parameters, const Scene& scene) {
    ViewStyle style{.size = read_size(parameters).value_or(scene.film.size)};
    if (const auto fov = parameters.find("vertical_fov"))
        style.lens = VerticalFov{glm::radians(double(fov->number(0.1f, 179.0f)))};
    if (const auto margin = parameters.find("margin")) style.margin = double(margin->number(0.0f, 0.45f));
    return style;
}

std::vector<Camera> cameras_of(const Node& parameters, const Scene& scene, const ViewStyle& style) {
    const Surroundings surroundings(scene);
    if (const auto count = parameters.find("turntable")) {
        const auto elevation = parameters.find("elevation");
        constexpr double USUAL = 20.0;
        return surroundings.turntable(count->integer(1, MAX_VIEWS),
                                      elevation ? read_elevation(*elevation) : glm::radians(USUAL), style);
    }
    if (const auto count = parameters.find("dome"))
        return surroundings.dome(count->integer(1, MAX_VIEWS), style);
    std::vector<Camera> cameras;
    for (const Node& view : parameters.require("views").elements()) {
        const double azimuth = glm::radians(std::remainder(view.numbers(2)[0], 360.0));
        cameras.push_back(
            surroundings.view("view", {.azimuth = azimuth, .elevation = read_elevation(view[1])}, style));
    }
    return cameras;
}

}  // namespace

Json describe_views(const Node& parameters, const Scene& scene) {
    parameters.allow_only(
        {"scene", "views", "turntable", "elevation", "dome", "size", "vertical_fov", "margin"});
    if (parameters.find("elevation") && !parameters.find("turntable"))
        parameters.fail(R"("elevation" goes with "turntable")");
    const ViewStyle style = read_style(parameters, scene);
    Json list = Json::array();
    for (const Camera& camera : cameras_of(parameters, scene, style))
        list.push_back(describe_camera(camera, style.size));
    return {{"cameras", list}};
}

}  // namespace candela::serve
