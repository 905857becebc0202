// The specialization constants of the renderer's kernels, for a scene on a device.
#include <algorithm>

#include "render/kernel_classes.h"
#include "render/media_at.h"
#include "render/renderer.h"
#include "shared/primitive.h"
#include "shared/texture.h"

namespace candela {
namespace {

// Without lights there is nothing to choose a sample from.
uint32_t estimator_constant(Estimator estimator, uint32_t light_count) {
    if (light_count == 0) return ESTIMATOR_BSDF;
    switch (estimator) {
        case Estimator::bsdf:
            return ESTIMATOR_BSDF;
        case Estimator::light:
            return ESTIMATOR_LIGHT;
        case Estimator::mis:
            break;
    }
    return ESTIMATOR_MIS;
}

uint32_t light_sampler_constant(LightSampler chosen) {
    switch (chosen) {
        case LightSampler::uniform:
            return LIGHT_SAMPLER_UNIFORM;
        case LightSampler::tree:
            return LIGHT_SAMPLER_TREE;
        default:
            return LIGHT_SAMPLER_POWER;
    }
}

uint32_t environment_constant(uint32_t environment, Backdrop backdrop) {
    if (backdrop == Backdrop::environment) return environment;
    const uint32_t hidden = std::min(environment, ENVIRONMENT_HIDDEN);
    return backdrop == Backdrop::transmitted ? hidden | ENVIRONMENT_BEHIND_GLASS : hidden;
}

uint32_t panorama_constant(Mapping mapping) {
    switch (mapping) {
        case Mapping::fisheye:
            return CAMERA_FISHEYE;
        case Mapping::equisolid:
            return CAMERA_EQUISOLID;
        case Mapping::equirectangular:
            break;
    }
    return CAMERA_EQUIRECTANGULAR;
}

uint32_t camera_constant(const Camera& camera) {
    if (camera.ortho_height) return CAMERA_ORTHOGRAPHIC;
    if (camera.panorama) return panorama_constant(camera.panorama->mapping);
    const Lens& lens = camera.lens;
    if (lens.radius == 0.0f) return CAMERA_PINHOLE;
    return lens.blades == 0 ? CAMERA_DISK : CAMERA_POLYGON;
}

// The length of the list that replaces the tree; 0 for the tree. Only on lavapipe: a GPU has no registers for
// a list, and runs other work while some lanes wait; on SwiftShader the list is 2.4 times as slow as the
// tree. Only for triangles, since every lane executes the tests of all kinds in the scene for each primitive;
// and only if rays pass none of them, and none is left out beside catchers.
uint32_t list_constant(const vk::Device& device, const GpuScene& scene, bool catchers) {
    const bool triangles = scene.primitives_present == 1u << PRIMITIVE_TRIANGLES;
    if (!scene.instances.empty() || scene.small_model) return 0;
    const bool opaque = (scene.textured & TEXTURED_PASSABLE) == 0;
    return device.info().is_lavapipe() && triangles && !catchers && opaque &&
                   scene.primitive_count <= LIST_MAX
               ? scene.primitive_count
               : 0;
}

uint32_t filter_constant(const PixelFilter& filter) {
    switch (filter.shape) {
        case FilterShape::tent:
            return PIXEL_FILTER_TENT;
        case FilterShape::gaussian:
            return PIXEL_FILTER_GAUSSIAN;
        case FilterShape::blackman_harris:
            return PIXEL_FILTER_BLACKMAN_HARRIS;
        case FilterShape::box:
            break;
    }
    return filter.width == 1.0f ? PIXEL_FILTER_SQUARE : PIXEL_FILTER_BOX;
}

uint32_t sampler_constant(SamplerKind sampler) {
    switch (sampler) {
        case SamplerKind::independent:
            return SAMPLER_INDEPENDENT;
        case SamplerKind::stratified:
            return SAMPLER_STRATIFIED;
        case SamplerKind::sobol:
            break;
    }
    return SAMPLER_SOBOL;
}

}  // namespace

uint32_t layers_before_guides(const RenderSettings& settings) {
    if (settings.catchers) return LAYER_COUNT_CATCHERS;
    return settings.aovs ? LAYER_COUNT_AOVS : LAYER_COUNT_COLOUR;
}

KernelConstants make_constants(const GpuScene& scene, const Camera& camera, const RenderSettings& settings) {
    KernelConstants constants;
    constants[CONSTANT_SAMPLER] = sampler_constant(settings.sampler);
    constants[CONSTANT_ESTIMATOR] = estimator_constant(settings.estimator, scene.light_count);
    constants[CONSTANT_HAS_NORMALS] = scene.has_normals;
    constants[CONSTANT_SMOOTH_TERMINATOR] = settings.terminator == Terminator::smooth;
    constants[CONSTANT_HAS_AOVS] = settings.aovs;
    constants[CONSTANT_DENOISING_LAYER] = settings.guides ? layers_before_guides(settings) : 0;
    constants[CONSTANT_CATCHERS] = !scene.has_catchers ? CATCHERS_NONE
                                   : settings.catchers ? CATCHERS_SEEN
                                                       : CATCHERS_SHOWN;
    constants[CONSTANT_CAMERA] = camera_constant(camera);
    constants[CONSTANT_PIXEL_FILTER] = filter_constant(settings.filter);
    constants[CONSTANT_PIXEL_FILTER_WIDTH] = floatBitsToUint(settings.filter.width);
    constants[CONSTANT_CLAMP_INDIRECT] = floatBitsToUint(settings.clamp_indirect.value_or(0.0f));
    constants[CONSTANT_ENVIRONMENT] = environment_constant(scene.environment, settings.backdrop);
    constants[CONSTANT_EVEN_SKY] = scene.even_sky;
    constants[CONSTANT_MATERIALS] = scene.materials_present;
    constants[CONSTANT_PRINCIPLED] = scene.principled;
    constants[CONSTANT_PRIMITIVES] = scene.primitives_present;
    constants[CONSTANT_BVH_DEPTH] = scene.bvh_depth;
    constants[CONSTANT_INSTANCED] = !scene.instances.empty();
    constants[CONSTANT_LIGHTS] = scene.lights_present;
    constants[CONSTANT_HAS_MEDIA] = scene.has_media;
    constants[CONSTANT_VOLUMETRIC] = scene.volumetric;
    constants[CONSTANT_WALKS] = scene.sealed_media;
    constants[CONSTANT_NESTED_MEDIA] = scene.nested_media || media_at(scene, camera.position) != uvec2(0);
    // Boundaries within one medium: see path_step().
    if (constants[CONSTANT_NESTED_MEDIA] != 0 && (scene.principled & PRINCIPLED_HAS_VOLUME) != 0)
        constants[CONSTANT_MATERIALS] |= 1u << MATERIAL_DIELECTRIC_EXACT;
    constants[CONSTANT_ATTRIBUTES] = scene.attributes;
    constants[CONSTANT_TEXTURED] = scene.textured;
    constants[CONSTANT_TEXTURE_TRAITS] = scene.texture_traits;
    constants[CONSTANT_LIGHT_SAMPLER] =
        light_sampler_constant(chosen_light_sampler(settings.light_sampler, scene));
    constants[CONSTANT_ONE_LIGHT] = scene.light_count == 1;
    return constants;
}

KernelConstants kernel_constants(const vk::Device& device, const GpuScene& scene, const ArrayMap& map,
                                 const Camera& camera, const RenderSettings& settings) {
    auto constants = make_constants(scene, camera, settings);
    set_arrays(constants, map);
    constants[CONSTANT_LIST] = list_constant(device, scene, settings.catchers);
    if (constants[CONSTANT_LIST] > 0) {
        std::ranges::copy(scene.list_corners, &constants[CONSTANT_LIST_CORNERS_0]);
    } else if (device.info().is_lavapipe()) {
        widen(constants, scene, settings);
    }
    constants[CONSTANT_GROUP_COUNTERS] = !device.info().is_lavapipe();
    return constants;
}

}  // namespace candela
