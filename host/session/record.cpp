// See record.h.
#include "session/record.h"

#include <cmath>

#include "film/sample_range.h"
#include "render/make_identity.h"
#include "scene/camera_axes.h"
#include "session/version.h"

namespace candela {
namespace {

// From the world to the camera as OpenEXR's standard attributes define its space: left-handed, x to the
// right, y up, and z forwards, so that what is in front of the camera has positive z.
glm::dmat4 world_to_camera(const Camera& camera) {
    using glm::dvec4;
    const auto [right, up, forward] = axes_of(camera);
    const glm::dmat4 axes =
        transpose(glm::dmat4(dvec4(right, 0), dvec4(up, 0), dvec4(forward, 0), dvec4(0, 0, 0, 1)));
    return axes *
           glm::dmat4(dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0), dvec4(-camera.position, 1));
}

// From the world to OpenEXR's normalised device coordinates, after the division by w: x to the right and y
// down, (0,0) and (1,1) the upper left and lower right corners of the display window. The standard leaves z
// open; here it is the inverse of the depth [1/m], so that the matrix can be inverted; of an orthographic
// camera, whose w is 1, the depth [m].
glm::dmat4 world_to_ndc(const Camera& camera, uvec2 size) {
    using glm::dvec4;
    if (camera.ortho_height) {
        const double height = *camera.ortho_height;
        const double width = height * size.x / size.y;
        const glm::dmat4 projection(dvec4(1.0 / width, 0, 0, 0), dvec4(0, -1.0 / height, 0, 0),
                                    dvec4(0, 0, 1, 0), dvec4(0.5, 0.5, 0, 1));
        return projection * world_to_camera(camera);
    }
    const double tan_y = std::tan(0.5 * double(camera.vertical_fov));
    const double tan_x = tan_y * size.x / size.y / double(camera.focal_ratio);
    const glm::dvec2 center =
        0.5 + glm::dvec2(camera.principal_offset) * glm::dvec2(double(size.y) / size.x, 1);
    const glm::dmat4 projection(dvec4(0.5 / tan_x, 0, 0, 0), dvec4(0, -0.5 / tan_y, 0, 0),
                                dvec4(center, 0, 1), dvec4(0, 0, 1, 0));
    return projection * world_to_camera(camera);
}

}  // namespace

RenderRecord make_record(const Scene& scene, const GpuScene& gpu_scene, const RenderJob& job) {
    return make_record(scene, gpu_scene, hash_arrays(gpu_scene), job);
}

RenderRecord make_record(const Scene& scene, const GpuScene& gpu_scene, uint64_t arrays_hash,
                         const RenderJob& job) {
    RenderSettings settings = job.settings;
    settings.light_sampler = chosen_light_sampler(settings.light_sampler, gpu_scene);
    return {.scene_attributes = scene.attributes,
            .identity = make_identity(gpu_scene, arrays_hash, job.camera, job.settings),
            .adaptive = job.adaptive,
            .camera = job.camera,
            .settings = settings,
            .primitives = gpu_scene.id_count,
            .lights = gpu_scene.light_count,
            .bvh_seconds = gpu_scene.bvh_seconds,
            .target_error = job.target_error};
}

Maker make_maker(const vk::DeviceInfo& device) {
    return {.device = device.name, .driver = device.driver, .version = CANDELA_VERSION};
}

std::string samples_text(const RenderRecord& record) {
    const SampleRange held{record.settings.first_sample, record.settings.first_sample + record.max_spp};
    return to_text({&held, 1});
}

void add_attributes(Image& image, const RenderRecord& record) {
    image.attributes["worldToCamera"] = mat4(world_to_camera(record.camera));
    if (!record.camera.panorama)
        image.attributes["worldToNDC"] = mat4(world_to_ndc(record.camera, record.settings.size));
    image.attributes["samplesPerPixel"] = float(record.spp);
    image.attributes["renderTimeSeconds"] = float(record.render_seconds);
    image.attributes["candela.samples"] = samples_text(record);
    if (record.adaptive) image.attributes[ADAPTIVE_ATTRIBUTE] = "yes";
    set_maker(image, record.maker);
    set_identity(image, record.identity);
    for (const auto& [name, text] : record.scene_attributes)
        image.attributes[name] = text;
    image.attributes["candela.commandLine"] = record.command_line;
}

}  // namespace candela
