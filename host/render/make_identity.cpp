// See make_identity.h.
#include "render/make_identity.h"

#include <charconv>
#include <span>
#include <string>

#include "base/hash.h"
#include "scene/names.h"

namespace candela {
namespace {

// Increases with every change of the records' meaning, since equal numbers then give other pictures.
constexpr uint32_t RECORDS_VERSION = 6;

// The shortest text that reads back as that number.
template <class Number>
std::string exact(Number value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

template <class Number>
std::string exact(const glm::vec<3, Number>& v) {
    return exact(v.x) + ' ' + exact(v.y) + ' ' + exact(v.z);
}

std::string offset_text(vec2 principal_offset) {
    if (principal_offset == vec2(0.0f)) return "";
    return ", principal point " + exact(principal_offset.x) + ' ' + exact(principal_offset.y) +
           " off the centre";
}

std::string perspective_text(const Camera& camera) {
    std::string text = ", field of view " + exact(camera.vertical_fov) + " rad";
    text += offset_text(camera.principal_offset);
    if (camera.focal_ratio != 1.0f) text += ", focal ratio " + exact(camera.focal_ratio);
    const Lens& lens = camera.lens;
    if (lens.radius > 0.0f) {
        text += ", lens of radius " + exact(lens.radius) + " focused at " + exact(lens.focal_distance);
        if (lens.blades > 0)
            text += ", " + std::to_string(lens.blades) + " blades at " + exact(lens.rotation) + " rad";
    }
    return text;
}

std::string panorama_text(const Panorama& panorama, vec2 principal_offset) {
    std::string text = ", " + name_of(panorama.mapping, MAPPING_NAMES);
    if (panorama.mapping != Mapping::equirectangular) text += " of " + exact(panorama.fisheye_fov) + " rad";
    return text + offset_text(principal_offset);
}

std::string camera_text(const Camera& camera) {
    const std::string text =
        "at " + exact(camera.position) + " towards " + exact(camera.look_at) + ", up " + exact(camera.up);
    if (camera.ortho_height) return text + ", orthographic, " + exact(*camera.ortho_height) + " m high";
    return text + (camera.panorama ? panorama_text(*camera.panorama, camera.principal_offset)
                                   : perspective_text(camera));
}

std::string filter_text(const PixelFilter& filter) {
    return name_of(filter.shape, FILTER_SHAPE_NAMES) + ',' + exact(filter.width);
}

std::string frame_text(const SceneFrame& frame) {
    return "origin " + exact(frame.origin) + ", unit " + exact(frame.unit) + " m, records " +
           std::to_string(RECORDS_VERSION);
}

template <class T>
uint64_t add_to_hash(uint64_t hash, const T& array) {
    return hash_words(std::as_bytes(std::span(array)), hash);
}

// The constants, as they were before there were guides and, if there are none, before there were catchers:
// then the hash is that of older files.
std::vector<uint32_t> hashed_values(const KernelConstants& constants) {
    std::vector<uint32_t> values(constants.values.begin(), constants.values.end());
    values.erase(values.begin() + CONSTANT_DENOISING_LAYER);
    if (constants[CONSTANT_CATCHERS] == CATCHERS_NONE) values.erase(values.begin() + CONSTANT_CATCHERS);
    return values;
}

}  // namespace

uint64_t hash_arrays(const GpuScene& scene) {
    uint64_t hash = FNV1A64_BASIS;
    for (const Words& array : scene.arrays)
        hash = add_to_hash(hash, array);
    return hash;
}

Identity make_identity(const GpuScene& scene, const Camera& camera, const RenderSettings& settings) {
    return make_identity(scene, hash_arrays(scene), camera, settings);
}

Identity make_identity(const GpuScene& scene, uint64_t arrays_hash, const Camera& camera,
                       const RenderSettings& settings) {
    RenderSettings fixed = settings;
    fixed.first_sample = 0;
    fixed.aovs = false;
    fixed.guides = false;
    uint64_t hash = add_to_hash(arrays_hash, pack(make_parameters(scene, camera, fixed)));
    hash = add_to_hash(hash, hashed_values(make_constants(scene, camera, fixed)));
    hash = add_to_hash(hash, std::array<uint32_t, 2>{settings.crop.x1, settings.crop.y1});
    return {
        .settings = {size_text(settings.size), crop_text(settings.crop), std::to_string(settings.seed),
                     name_of(settings.sampler, SAMPLER_NAMES), name_of(settings.estimator, ESTIMATOR_NAMES),
                     name_of(chosen_light_sampler(settings.light_sampler, scene), LIGHT_SAMPLER_NAMES),
                     name_of(settings.terminator, TERMINATOR_NAMES), std::to_string(settings.max_depth),
                     std::to_string(settings.rr_depth), filter_text(settings.filter),
                     settings.clamp_indirect ? exact(*settings.clamp_indirect) : NO_CLAMP_TEXT,
                     camera_text(camera), frame_text(scene.frame)},
        .hash = hash};
}

}  // namespace candela
