// See kernel_classes.h.
#include "render/kernel_classes.h"

#include <algorithm>
#include <span>

#include "shared/light.h"
#include "shared/material.h"
#include "shared/principled.h"
#include "shared/texture.h"

namespace candela {
namespace {

constexpr uint32_t ALL_FORMS =
    TEXEL_FORMATS | TEXTURE_ENCODINGS | TEXTURE_FILTERS | TEXTURE_WRAPS | TEXTURE_WRAPS << TEXTURE_WRAP_V;

// What materials may have.
struct MaterialClass {
    uint32_t principled;  // Bits PRINCIPLED_HAS_*.
    uint32_t textured;    // Bits TEXTURED_*.
};

constexpr uint32_t BASIC = PRINCIPLED_HAS_METAL | PRINCIPLED_HAS_ROUGH | PRINCIPLED_HAS_DIFFUSE |
                           PRINCIPLED_HAS_SPECULAR | PRINCIPLED_HAS_CULLED;
constexpr uint32_t IMAGES = BASIC | PRINCIPLED_HAS_IMAGES;
constexpr uint32_t GLASS = PRINCIPLED_HAS_THIN | PRINCIPLED_HAS_VOLUME | PRINCIPLED_HAS_DIFFUSE_TRANSMISSION |
                           PRINCIPLED_IS_LIT_FROM_BEHIND;
constexpr uint32_t LAYERS = PRINCIPLED_HAS_COAT | PRINCIPLED_HAS_SHEEN | PRINCIPLED_HAS_IRIDESCENCE;
// Turned frames change the random directions, too; and few models have any of these.
constexpr uint32_t RARE = PRINCIPLED_HAS_ANISOTROPY | PRINCIPLED_HAS_COAT_NORMAL | PRINCIPLED_HAS_DISPERSION |
                          PRINCIPLED_HAS_COATED_EMISSION;
constexpr uint32_t COLORS = TEXTURED_PASSABLE | TEXTURED_VERTEX_COLORS;
constexpr uint32_t MAPS = COLORS | TEXTURED_NORMAL | TEXTURED_OPACITY;
constexpr uint32_t EMISSIVE = MAPS | TEXTURED_EMISSION;
constexpr uint32_t UNLIT = TEXTURED_BASE;  // Their images.

// The cheapest is first.
constexpr MaterialClass UNDER_A_SKY[] = {
    {BASIC, TEXTURED_PASSABLE}, {IMAGES, COLORS},       {IMAGES, COLORS | TEXTURED_NORMAL},
    {IMAGES, MAPS | UNLIT},     {IMAGES | GLASS, MAPS}, {IMAGES | LAYERS, MAPS},
};
constexpr MaterialClass UNDER_LAMPS[] = {
    {IMAGES, EMISSIVE},
    {IMAGES | GLASS | LAYERS | RARE, EMISSIVE | UNLIT},
};

// The cheapest of these that allows for what the constants say, or none.
const MaterialClass* class_of(const KernelConstants& constants, std::span<const MaterialClass> classes) {
    const auto allows = [&](const MaterialClass& c) {
        return (constants[CONSTANT_PRINCIPLED] & ~c.principled) == 0 &&
               (constants[CONSTANT_TEXTURED] & ~c.textured) == 0;
    };
    const auto found = std::ranges::find_if(classes, allows);
    return found == classes.end() ? nullptr : &*found;
}

void set_class(KernelConstants& constants, const MaterialClass& materials) {
    constants[CONSTANT_MATERIALS] |= 1u << MATERIAL_PRINCIPLED | 1u << MATERIAL_UNLIT;
    constants[CONSTANT_PRINCIPLED] = materials.principled;
    constants[CONSTANT_TEXTURED] = materials.textured;
    if ((materials.principled & PRINCIPLED_HAS_IMAGES) != 0)
        constants[CONSTANT_TEXTURE_TRAITS] = ALL_FORMS | TEXTURE_UV_SETS;
    if ((materials.principled & PRINCIPLED_HAS_VOLUME) != 0) constants[CONSTANT_HAS_MEDIA] = 1;
    constants[CONSTANT_HAS_NORMALS] = 1;
}

// All lights that a small model may have, from the tree; those that it lacks have no part of the choice.
void set_lamps(KernelConstants& constants) {
    constants[CONSTANT_LIGHT_SAMPLER] = LIGHT_SAMPLER_TREE;
    constants[CONSTANT_ONE_LIGHT] = 0;
    constants[CONSTANT_LIGHTS] |= 1u << LIGHT_TRIANGLE | 1u << LIGHT_ENVIRONMENT | 1u << LIGHT_POINT |
                                  1u << LIGHT_SPOT | 1u << LIGHT_DIRECTIONAL;
    constants[CONSTANT_EVEN_SKY] = 0;
    uint32_t& environment = constants[CONSTANT_ENVIRONMENT];
    if ((environment & ~ENVIRONMENT_BEHIND_GLASS) == ENVIRONMENT_NONE) environment |= ENVIRONMENT_HIDDEN;
}

// As if a hidden sky were the light of a scene of unlit surfaces.
void set_sky(KernelConstants& constants, const RenderSettings& settings) {
    constants[CONSTANT_ESTIMATOR] = uint32_t(settings.estimator);
    constants[CONSTANT_ONE_LIGHT] = 1;
    constants[CONSTANT_LIGHTS] = 1u << LIGHT_ENVIRONMENT;
    constants[CONSTANT_ENVIRONMENT] |= ENVIRONMENT_HIDDEN;
}

// The class of a small model; false if there is none.
bool share(KernelConstants& constants, const GpuScene& scene, const RenderSettings& settings) {
    if (!scene.small_model) return false;
    constexpr uint32_t SKY = 1u << LIGHT_ENVIRONMENT;
    const uint32_t lights = constants[CONSTANT_LIGHTS];
    const MaterialClass* materials = (lights & ~SKY) == 0 ? class_of(constants, UNDER_A_SKY) : nullptr;
    if (materials != nullptr) {
        set_class(constants, *materials);
        if (lights == 0 && scene.materials_present == 1u << MATERIAL_UNLIT) set_sky(constants, settings);
        return true;
    }
    materials = class_of(constants, UNDER_LAMPS);
    const bool by_tree = constants[CONSTANT_LIGHT_SAMPLER] == LIGHT_SAMPLER_TREE || scene.light_count == 1;
    if (materials == nullptr || !by_tree) return false;
    set_class(constants, *materials);
    set_lamps(constants);
    return true;
}

}  // namespace

void widen(KernelConstants& constants, const GpuScene& scene, const RenderSettings& settings) {
    const uint32_t levels = scene.small_model ? 16 : 8;
    uint32_t& depth = constants[CONSTANT_BVH_DEPTH];
    depth = (depth + levels - 1) / levels * levels;
    static_assert(BVH_MAX_DEPTH % 16 == 0);
    if (share(constants, scene, settings)) return;
    uint32_t& principled = constants[CONSTANT_PRINCIPLED];
    if (principled == 0) return;
    principled |= PRINCIPLED_HAS_METAL | PRINCIPLED_HAS_ROUGH | PRINCIPLED_HAS_DIFFUSE;
    if ((principled & PRINCIPLED_HAS_IMAGES) != 0) constants[CONSTANT_TEXTURE_TRAITS] |= ALL_FORMS;
}

}  // namespace candela
