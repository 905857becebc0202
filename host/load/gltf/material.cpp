// Ref: Khronos, "glTF 2.0 Specification", section 3.9 and appendix B, and the texts of the extensions named
// here.
#include "load/gltf/material.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "base/text.h"
#include "load/gltf/texture.h"
#include "load/gltf/values.h"
#include "scene/images.h"

namespace candela::gltf {
namespace {

// From an image whose alpha, times `factor`, is glossiness: one channel, 1 minus that product.
TexelImage roughness_of(const TexelImage& image, float factor) {
    TexelImage result{
        .size = image.size, .channels = 1, .type = TexelType::unorm8, .texels = {}, .gamma = {}};
    result.texels.resize(size_t(image.size.x) * image.size.y);
    for (size_t i = 0; i < result.texels.size(); ++i)
        result.texels[i] = std::byte(std::lround(255.0f * (1.0f - factor * texel_codes(image, i).w)));
    return result;
}

constexpr uint32_t GREEN = 1;
constexpr uint32_t BLUE = 2;

class MaterialReader {
  public:
    MaterialReader(File& file, Scene& scene, const Node& node) : file_(file), scene_(scene), node_(node) {}

    Material read() {
        Material material;
        PrincipledMaterial m;
        const auto double_sided = node_.find("doubleSided");
        m.double_sided = double_sided && double_sided->boolean();
        m.unlit = extension("KHR_materials_unlit").has_value();
        m.metalness = m.roughness = 1.0f;
        if (const auto old = extension("KHR_materials_pbrSpecularGlossiness")) {
            read_specular_glossiness(*old, m, material.opacity);
        } else {
            read_metallic_roughness(m, material.opacity);
        }
        if (!m.unlit) {
            read_surface(m);
            read_transmission(m);
            read_layers(m);
            read_emission(m);
            material.normal_map = normal_map(node_, "normalTexture");
        }
        read_alpha_mode(material.opacity);
        material.model = m;
        return material;
    }

  private:
    std::optional<Node> extension(std::string_view name) const { return extension_of(node_, name); }

    float number(const Node& object, std::string_view key, float lo, float hi, float otherwise) {
        return number_of(file_, object, key, lo, hi, otherwise);
    }
    float number(const Node& object, std::string_view key, Range range, float otherwise) {
        return number(object, key, range.min, range.max, otherwise);
    }

    std::optional<Texture> texture(const Node& object, std::string_view key, TextureEncoding encoding,
                                   uint32_t channel = RED) {
        const auto info = object.find(key);
        return info ? read_texture(file_, scene_, *info, encoding, channel) : std::nullopt;
    }

    // A factor and the channel of a texture.
    Textured<float> weight(const Node& object, std::string_view factor, float otherwise,
                           std::string_view image, uint32_t channel) {
        Textured<float> value = number(object, factor, 0.0f, 1.0f, otherwise);
        value.texture = texture(object, image, TextureEncoding::linear, channel);
        return value;
    }

    // A factor and the colour of a texture.
    Textured<vec3> color(const Node& object, std::string_view factor, vec3 otherwise,
                         std::string_view image) {
        Textured<vec3> value = color_of(file_, object, factor, 1.0f, otherwise);
        value.texture = texture(object, image, TextureEncoding::srgb);
        return value;
    }

    std::optional<NormalMap> normal_map(const Node& object, std::string_view key) {
        const auto map = texture(object, key, TextureEncoding::linear);
        if (!map) return std::nullopt;
        return NormalMap{*map,
                         number(object.require(key), "scale", -MAX_NORMAL_SCALE, MAX_NORMAL_SCALE, 1.0f)};
    }

    // A colour with alpha, and its texture.
    void read_base_color(const Node& object, std::string_view factor, std::string_view image,
                         PrincipledMaterial& m, Opacity& opacity) {
        m.base_color = vec3(1.0f);
        if (const auto node = object.find(factor)) {
            const std::vector<double> rgba = node->numbers(4);
            const bool in_range = std::ranges::all_of(rgba, [](double v) { return v >= 0.0 && v <= 1.0; });
            if (!in_range) file_.warn(*node, "a component is not between 0 and 1; it is clamped");
            const auto limited = [&](size_t i) { return std::clamp(float(rgba[i]), 0.0f, 1.0f); };
            m.base_color = vec3(limited(0), limited(1), limited(2));
            opacity.value = limited(3);
        }
        m.base_color.texture = texture(object, image, TextureEncoding::srgb);
        opacity.value.texture = m.base_color.texture;
        if (opacity.value.texture) opacity.value.texture->channel = ALPHA;
    }

    void read_metallic_roughness(PrincipledMaterial& m, Opacity& opacity) {
        m.base_color = vec3(1.0f);
        const auto pbr = node_.find("pbrMetallicRoughness");
        if (!pbr) return;
        read_base_color(*pbr, "baseColorFactor", "baseColorTexture", m, opacity);
        if (m.unlit) return;
        m.metalness = weight(*pbr, "metallicFactor", 1.0f, "metallicRoughnessTexture", BLUE);
        m.roughness = weight(*pbr, "roughnessFactor", 1.0f, "metallicRoughnessTexture", GREEN);
    }

    // As KHR_materials_ior says: an index of 0 means a reflectance of 1, and "specular" is its colour.
    void read_specular_glossiness(const Node& old, PrincipledMaterial& m, Opacity& opacity) {
        read_base_color(old, "diffuseFactor", "diffuseTexture", m, opacity);
        if (m.unlit) return;
        m.metalness = 0.0f;
        m.ior = 0.0f;
        m.specular_color = color(old, "specularFactor", vec3(1.0f), "specularGlossinessTexture");
        const float glossiness = number(old, "glossinessFactor", 0.0f, 1.0f, 1.0f);
        m.roughness = 1.0f - glossiness;
        if (!m.specular_color.texture) return;
        Texture roughness = *m.specular_color.texture;
        roughness.encoding = TextureEncoding::linear;
        roughness.image = roughness_image(roughness.image, glossiness);
        m.roughness = {1.0f, roughness};
    }

    // The copy of an image whose alpha, times `glossiness`, is glossiness.
    uint32_t roughness_image(uint32_t image, float glossiness) {
        ImageFile copy = scene_.images[image];
        copy.convert = [glossiness](const TexelImage& whole) { return roughness_of(whole, glossiness); };
        copy.real_path += concat("#roughness/", glossiness);
        return add_image_file(scene_, std::move(copy));
    }

    void read_surface(PrincipledMaterial& m) {
        if (const auto ior = extension("KHR_materials_ior"); ior && m.ior != 0.0f) {
            const auto value = ior->find("ior");
            const bool all = value && value->number() == 0.0;
            m.ior = all ? 0.0f : number(*ior, "ior", PRINCIPLED_RANGES.ior, 1.5f);
        }
        if (const auto e = extension("KHR_materials_specular")) {
            m.specular = weight(*e, "specularFactor", 1.0f, "specularTexture", ALPHA);
            constexpr float MAX = 1e6f;
            m.specular_color = color_of(file_, *e, "specularColorFactor", MAX, vec3(1.0f));
            m.specular_color.texture = texture(*e, "specularColorTexture", TextureEncoding::srgb);
        }
        if (const auto e = extension("KHR_materials_anisotropy")) {
            m.anisotropy = number(*e, "anisotropyStrength", PRINCIPLED_RANGES.anisotropy, 0.0f);
            const auto rotation = e->find("anisotropyRotation");
            m.anisotropy_rotation =
                rotation ? float(std::remainder(rotation->number(), 2.0 * double(PI))) : 0.0f;
            m.anisotropy_map = texture(*e, "anisotropyTexture", TextureEncoding::linear);
        }
    }

    void read_transmission(PrincipledMaterial& m) {
        if (const auto e = extension("KHR_materials_transmission"))
            m.transmission = weight(*e, "transmissionFactor", 0.0f, "transmissionTexture", RED);
        if (const auto e = extension("KHR_materials_diffuse_transmission")) {
            m.diffuse_transmission =
                weight(*e, "diffuseTransmissionFactor", 0.0f, "diffuseTransmissionTexture", ALPHA);
            m.diffuse_transmission_color =
                color(*e, "diffuseTransmissionColorFactor", vec3(1.0f), "diffuseTransmissionColorTexture");
        }
        const bool transmits = m.transmission.factor > 0.0f || m.diffuse_transmission.factor > 0.0f;
        if (const auto e = extension("KHR_materials_volume"); e && transmits && m.ior != 0.0f)
            read_volume(*e, m);
        if (const auto e = extension("KHR_materials_dispersion"); e && m.inside)
            m.dispersion = number(*e, "dispersion", PRINCIPLED_RANGES.dispersion, 0.0f);
        read_specular_above_one(m);
    }

    // With a thickness the body is solid, and light is absorbed along its true path inside; without one the
    // surface is a thin wall.
    void read_volume(const Node& volume, PrincipledMaterial& m) {
        const auto scatter = extension("KHR_materials_volume_scatter");
        if (number(volume, "thicknessFactor", 0.0f, FLOAT_MAX, 0.0f) == 0.0f) {
            if (scatter)
                file_.warn(
                    *scatter,
                    "the volume has no thickness: the surface is a thin wall, within which nothing scatters");
            return;
        }
        m.inside.emplace();
        const auto distance = volume.find("attenuationDistance");
        if (!distance) return;        // Infinite.
        constexpr float MIN = 1e-6f;  // Black would need infinite absorption.
        const vec3 left = color_of(file_, volume, "attenuationColor", 1.0f, vec3(1.0f));
        const double length = distance->number();
        if (!(length >= double(FLOAT_MIN))) {
            file_.warn(*distance, "the distance is not above 0, and is treated as infinite");
            return;
        }
        for (glm::length_t i = 0; i < 3; ++i) {
            const double fraction = std::clamp(double(left[i]), double(MIN), 1.0);
            m.inside->absorption[i] = float(std::min(-std::log(fraction) / length, double(FLOAT_MAX)));
        }
        if (scatter) read_scattering(*scatter, *m.inside);
    }

    // Some of what the medium takes out of a ray's way is scattered instead of absorbed. A draft of the
    // extension has a factor and a texture in place of the colour.
    void read_scattering(const Node& scatter, Medium& medium) {
        const char* name =
            scatter.find("multiscatterColorFactor") ? "multiscatterColorFactor" : "multiscatterColor";
        const dvec3 color(color_of(file_, scatter, name, 1.0f, vec3(0.0f)));
        if (const auto texture = scatter.find("multiscatterColorTexture"))
            file_.warn(*texture, "the medium is the same everywhere inside; its texture is ignored");
        const dvec3 extinction(medium.absorption), albedo = single_scattering_albedo(color, 0.0f);
        medium.absorption = vec3(extinction * (1.0 - albedo));
        medium.scattering = vec3(extinction * albedo);
        medium.g = number(scatter, "scatterAnisotropy", {-MAX_ANISOTROPY, MAX_ANISOTROPY}, 0.0f);
    }

    // A specular colour above 1 raises the reflectance of the index. If no light is refracted, another index
    // and colour give the same.
    void read_specular_above_one(PrincipledMaterial& m) {
        const vec3 c = m.specular_color.factor;
        const float max = std::max({c.x, c.y, c.z});
        if (max <= 1.0f) return;
        const float r = m.ior == 0.0f ? 1.0f : (m.ior - 1.0f) / (m.ior + 1.0f);
        // The greatest factor that leaves the reflection below 1.
        const float factor = m.inside || r == 0.0f ? 1.0f : std::min(max, 0.999f / (r * r));
        if (factor > 1.0f) {
            const float root = r * std::sqrt(factor);
            m.ior = (1.0f + root) / (1.0f - root);
        }
        m.specular_color.factor = min(c / std::max(factor, 1.0f), vec3(1.0f));
        if (m.inside) file_.warn(node_, "a specular colour above 1 on a refracting body is read as 1");
    }

    void read_layers(PrincipledMaterial& m) {
        if (const auto e = extension("KHR_materials_clearcoat")) {
            m.coat = weight(*e, "clearcoatFactor", 0.0f, "clearcoatTexture", RED);
            m.coat_roughness =
                weight(*e, "clearcoatRoughnessFactor", 0.0f, "clearcoatRoughnessTexture", GREEN);
            if (m.coat.factor > 0.0f) m.coat_normal_map = normal_map(*e, "clearcoatNormalTexture");
        }
        if (const auto e = extension("KHR_materials_sheen")) {
            m.sheen_color = color(*e, "sheenColorFactor", vec3(0.0f), "sheenColorTexture");
            m.sheen_roughness = weight(*e, "sheenRoughnessFactor", 0.0f, "sheenRoughnessTexture", ALPHA);
        }
        if (const auto e = extension("KHR_materials_iridescence")) {
            m.iridescence = weight(*e, "iridescenceFactor", 0.0f, "iridescenceTexture", RED);
            m.iridescence_ior = number(*e, "iridescenceIor", PRINCIPLED_RANGES.iridescence_ior, 1.3f);
            m.iridescence_thickness_min = number(*e, "iridescenceThicknessMinimum",
                                                 PRINCIPLED_RANGES.iridescence_thickness_min, 100.0f);
            m.iridescence_thickness =
                number(*e, "iridescenceThicknessMaximum", PRINCIPLED_RANGES.iridescence_thickness, 400.0f);
            m.iridescence_thickness.texture =
                texture(*e, "iridescenceThicknessTexture", TextureEncoding::linear, GREEN);
        }
    }

    void read_emission(PrincipledMaterial& m) {
        const vec3 factor = color_of(file_, node_, "emissiveFactor", MAX_LIGHT, vec3(0.0f));
        if (factor == vec3(0.0f)) return;
        const auto e = extension("KHR_materials_emissive_strength");
        float strength = e ? number(*e, "emissiveStrength", 0.0f, MAX_LIGHT, 1.0f) : 1.0f;
        if (const auto old = extension("VRMC_materials_hdr_emissiveMultiplier"); old && !e)
            strength = number(*old, "emissiveMultiplier", 0.0f, MAX_LIGHT, 1.0f);
        const dvec3 radiance = min(dvec3(factor) * double(strength), dvec3(double(MAX_LIGHT)));
        m.emission = vec3(radiance);
        m.emission.texture = texture(node_, "emissiveTexture", TextureEncoding::srgb);
    }

    void read_alpha_mode(Opacity& opacity) {
        const auto mode = node_.find("alphaMode");
        const std::string name = mode ? mode->string() : "OPAQUE";
        if (name == "MASK") {
            opacity.cutoff = number(node_, "alphaCutoff", 0.0f, FLOAT_MAX, 0.5f);
        } else if (name != "BLEND") {
            if (name != "OPAQUE") mode->fail_expected(R"("OPAQUE", "MASK" or "BLEND")");
            opacity = {};
        }
    }

    File& file_;
    Scene& scene_;
    Node node_;
};

}  // namespace

Material read_material(File& file, Scene& scene, const Node& material) {
    return MaterialReader(file, scene, material).read();
}

bool alpha_counts(const Node& material) {
    const auto mode = material.find("alphaMode");
    return mode && mode->string() != "OPAQUE";
}

Material default_material() {
    PrincipledMaterial m;
    m.base_color = vec3(1.0f);
    m.metalness = m.roughness = 1.0f;
    m.double_sided = false;
    return {"(default)", m};
}

}  // namespace candela::gltf
