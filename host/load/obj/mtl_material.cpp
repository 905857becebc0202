// From statements to models, one function for each.
#include "load/obj/mtl_material.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/text.h"
#include "load/obj/named_file.h"
#include "load/quote.h"
#include "scene/images.h"
#include "scene/material_textures.h"

namespace candela {
namespace {

using Model = decltype(Material::model);

constexpr double GREY = 0.5;          // The reflectance if a file states no colour.
constexpr double DULL = 0.5;          // The roughness if it states none.
constexpr double COMMON_GLASS = 1.5;  // The index of refraction if it states none.
constexpr double SHEEN_ROUGHNESS = 0.5;
constexpr double MAX_NS = 1000.0;      // The greatest exponent that the format foresees: a mirror.
constexpr double SUM_ROUNDING = 2e-6;  // Rounding of a sum of two numbers of six digits, as most programs
                                       // write them.

double largest_of(dvec3 v) {
    return std::max({v.x, v.y, v.z});
}

double mean_of(dvec3 v) {
    return (v.x + v.y + v.z) / 3.0;
}

class Converter {
  public:
    Converter(const MtlStatements& statements, const std::string& file, MtlIgnored& ignored)
        : s_(statements), file_(file), ignored_(ignored) {
        ke_ = s_.ke.value_or(dvec3(find("map_Ke") ? 1.0 : 0.0));
        ks_ = s_.ks.value_or(dvec3(find("map_Ks") ? 1.0 : 0.0));
        kd_ = s_.kd.value_or(dvec3(find("map_Kd") ? 1.0 : 0.0));
        opacity_ = stated_opacity();
        is_glass_ = is_glass();
    }

    MtlMaterial convert() {
        result_.material = {.name = s_.name, .model = find_model()};
        result_.material.opacity.value = opacity();
        result_.material.normal_map = normal_map();
        result_.material.bump_map = bump_map();
        result_.emission = colour_of(ke_, "map_Ke");
        note_ignored();
        return std::move(result_);
    }

  private:
    void warn(const std::string& kind, const std::string& what) {
        result_.warnings.push_back(
            {kind, concat(file_, ':', s_.line, ": material ", quote(s_.name), ": ", what)});
    }

    const MtlTexture* find(std::string_view statement) const {
        const auto found = s_.textures.find(statement);
        return found == s_.textures.end() ? nullptr : &found->second;
    }

    // The texture of a statement, which must exist.
    Texture use(const std::string& statement, TextureEncoding encoding) {
        const MtlTexture& stated = *find(statement);
        Texture texture = stated.texture;
        texture.image = uint32_t(result_.images.size());
        texture.encoding = encoding;
        texture.channel = stated.channel.value_or(0);
        result_.images.push_back({std::filesystem::path(file_).parent_path(), stated.file, stated.place});
        used_.insert(statement);
        return texture;
    }

    Textured<vec3> colour_of(dvec3 factor, const std::string& statement) {
        if (!find(statement) || factor == dvec3(0.0)) return vec3(factor);
        return {vec3(factor), use(statement, TextureEncoding::srgb)};
    }

    Textured<float> number_of(double factor, const std::string& statement) {
        if (!find(statement) || factor == 0.0) return float(factor);
        return {float(factor), use(statement, TextureEncoding::linear)};
    }

    // Light is reflected as by a mirror.
    bool reflects() const { return s_.illum == 3 || s_.illum == 5 || s_.illum == 8; }

    // Light is refracted, in files that mean it: Maya writes 4 for all materials, and Blender 6 for metals
    // that are not opaque.
    bool is_glass() const {
        const bool is_metal = s_.pm.value_or(0.0) > 0.0;
        if (s_.by_blender || is_metal || (s_.illum != 4 && s_.illum != 6 && s_.illum != 7)) return false;
        const bool filters = s_.tf && *s_.tf != dvec3(0.0) && *s_.tf != max(*s_.tf, dvec3(1.0));
        const bool passes = kd_ == dvec3(0.0) || filters || opacity_ < 1.0;
        return s_.ni.value_or(COMMON_GLASS) > 1.0 && passes;
    }

    // Whether statements of the PBR extension decide.
    bool states_pbr() const { return s_.pr || s_.pm || s_.ps || s_.pc || find("map_Pr") || find("map_Pm"); }

    // A material that cannot be a sum of diffuse light and reflection is a metal, as Blender writes it.
    bool must_be_metal() const {
        return reflects() && kd_ != dvec3(0.0) && ks_ != dvec3(0.0) &&
               largest_of(kd_ + ks_) > 1.0 + SUM_ROUNDING;
    }

    Model find_model() {
        if (is_glass_) return glass();
        if (states_pbr() || s_.by_blender || must_be_metal()) return principled();
        if (s_.illum >= 9) {
            warn("illum",
                 "illum " + std::to_string(s_.illum) + " is not supported; the material is read as illum 2");
        }
        return opaque();
    }

    Model glass() {
        const bool is_black = s_.tf == dvec3(0.0);
        if (is_black) warn("black glass", "Tf 0 would let no light through the glass, and is ignored");
        const dvec3 tf = is_black ? dvec3(1.0) : min(s_.tf.value_or(dvec3(1.0)), dvec3(1.0));
        const bool is_rough = s_.pr.value_or(0.0) > 0.0 || find("map_Pr");
        if (tf == dvec3(1.0) && !is_rough)
            return DielectricMaterial{.ior = float(s_.ni.value_or(COMMON_GLASS))};
        PrincipledMaterial m{.base_color = vec3(tf), .ior = ior()};
        m.roughness = number_of(s_.pr.value_or(is_rough ? 1.0 : 0.0), "map_Pr");
        m.transmission = 1.0f;
        m.inside.emplace();
        return m;
    }

    float ior() const {
        const double ni = s_.ni.value_or(COMMON_GLASS);
        return float(ni > 1.0 ? std::min(ni, double(PRINCIPLED_RANGES.ior.max)) : COMMON_GLASS);
    }

    Model principled() {
        dvec3 none(0.0);
        dvec3 kd = s_.kd ? *s_.kd : default_kd(false);
        limit(none, kd, "Kd");
        PrincipledMaterial m{.base_color = colour_of(kd, "map_Kd"), .ior = ior()};
        m.metalness = metalness();
        m.roughness = roughness();
        // Blender writes half of the reflection's tint as Ks; other programs do not say what they mean by it.
        if (s_.ks && (s_.by_blender || !states_pbr())) m.specular = float(std::min(1.0, 2.0 * mean_of(ks_)));
        if (s_.ps) m.sheen_color = vec3(float(*s_.ps));
        m.sheen_roughness = float(SHEEN_ROUGHNESS);
        m.coat = float(s_.pc.value_or(0.0));
        m.coat_roughness = float(s_.pcr.value_or(0.0));
        m.transmission = transmission();
        if (m.transmission.factor > 0.0f) m.inside.emplace();
        return m;
    }

    // Without the PBR extension, Blender writes it as Ka.
    Textured<float> metalness() {
        if (s_.pm || find("map_Pm")) return number_of(s_.pm.value_or(1.0), "map_Pm");
        if (states_pbr() || !(reflects() || s_.illum == 6)) return 0.0f;
        const dvec3 ka = s_.ka.value_or(dvec3(0.0));
        const bool is_grey = ka == dvec3(ka.x) && ka.x > 0.0;
        return is_grey ? float(std::min(ka.x, 1.0)) : 1.0f;
    }

    Textured<float> roughness() {
        if (s_.pr || find("map_Pr")) return number_of(s_.pr.value_or(1.0), "map_Pr");
        if (s_.by_blender && find("map_Ns")) return number_of(1.0, "map_Ns");  // It holds roughness.
        if (states_pbr() && !s_.by_blender) {
            warn("no Pr", "it has no roughness (Pr); " + number_text(DULL, 6) + " is used");
            return float(DULL);
        }
        const double ns = s_.ns.value_or(reflects() ? MAX_NS : 0.0);
        return float(1.0 - std::sqrt(std::min(ns, MAX_NS) / MAX_NS));  // As Blender converts it.
    }

    // With the PBR extension, Blender writes it as Tf. 3ds Max, which writes a Tf of 1 for all materials,
    // writes Tr beside it.
    float transmission() {
        if (!states_pbr() || !s_.tf || s_.tr || s_.illum > 2 || s_.ni.value_or(1.0) <= 1.0) return 0.0f;
        const double fraction = std::min(1.0, mean_of(*s_.tf));
        if (fraction > 0.0 && !s_.by_blender) {
            warn("Tf", "Tf beside Pr or Pm is read as a fraction " + number_text(fraction, 6) +
                           " of the light that passes, as through glass");
        }
        return float(fraction);
    }

    Model opaque() {
        const bool has_highlight = s_.illum >= 2 && ks_ != dvec3(0.0);
        dvec3 ks = has_highlight ? ks_ : dvec3(0.0);
        dvec3 kd = s_.kd ? *s_.kd : default_kd(has_highlight);
        limit(kd, ks, !has_highlight ? "Kd" : kd == dvec3(0.0) ? "Ks" : "Kd + Ks");
        if (has_highlight && reflects() && kd == dvec3(0.0)) return MirrorMaterial{colour_of(ks, "map_Ks")};
        const Textured<vec3> diffuse = colour_of(kd, "map_Kd");
        if (!has_highlight) return DiffuseMaterial{diffuse};
        return PhongMaterial{diffuse, colour_of(ks, "map_Ks"), number_of(exponent(), "map_Ns")};
    }

    double exponent() {
        constexpr auto MAX = double(MAX_PHONG_EXPONENT);
        if (reflects() && s_.ns.value_or(MAX_NS) >= MAX_NS) return MAX;
        const double ns = s_.ns.value_or(1.0);
        if (ns <= MAX) return ns;
        warn("Ns",
             "Ns " + number_text(ns, 6) + " is read as " + number_text(MAX, 6) + ", the greatest exponent");
        return MAX;
    }

    // A lamp or a shiny object may reflect nothing diffusely; anything else was meant to be visible.
    dvec3 default_kd(bool has_highlight) {
        if (find("map_Kd")) return dvec3(1.0);
        if (has_highlight || vec3(ke_) != vec3(0.0f)) return dvec3(0.0);
        warn("no Kd", "it has no colour (Kd); grey of " + number_text(GREY, 6) + " is used");
        return dvec3(GREY);
    }

    // Scales kd and ks by one factor so that they add up to at most 1; `what` names the sum in messages.
    void limit(dvec3& kd, dvec3& ks, const char* what) {
        const double largest = largest_of(kd + ks);
        if (largest <= 1.0) return;
        kd /= largest;
        ks /= largest;
        if (largest <= 1.0 + SUM_ROUNDING) return;
        warn("above 1",
             std::string(what) + " is " + number_text(largest, 6) + " in a channel; it is scaled to 1");
    }

    // May be out of range.
    double stated_opacity() const {
        // If both are given, d is used: Tr is not in the specification.
        if (s_.d || s_.tr) return s_.d ? *s_.d : 1.0 - *s_.tr;
        return is_opacity_of_maya() ? mean_of(*s_.tf) : 1.0;
    }

    // Maya writes no d, but Tf, 1 for what is opaque.
    bool is_opacity_of_maya() const {
        return s_.illum == 4 && s_.tf && largest_of(*s_.tf) <= 1.0 && *s_.tf != dvec3(1.0) &&
               s_.ni.value_or(COMMON_GLASS) <= 1.0;
    }

    Textured<float> opacity() {
        const double d = is_glass_ ? 1.0 : std::clamp(opacity_, 0.0, 1.0);
        if (d != opacity_ && !is_glass_) {
            warn("opacity", (s_.d ? "d " + number_text(*s_.d, 6) : "Tr " + number_text(*s_.tr, 6)) +
                                " is not from 0 to 1; the material is read as " +
                                (d > 0.0 ? "opaque" : "transparent"));
        } else if (!s_.d && !s_.tr && d < 1.0) {
            warn("Maya", "Tf is read as an opacity of " + number_text(d, 6) + ", since Ni is not above 1");
        }
        if (d == 0.0) warn("invisible", "it is invisible: d is 0, or Tr is 1");
        Textured<float> result = number_of(d, "map_d");
        if (result.texture && !find("map_d")->channel) {
            // If the colour's image is named again, its alpha is meant, not its red channel.
            const MtlTexture* colours = find("map_Kd");
            const bool is_alpha = colours && colours->file == find("map_d")->file;
            result.texture->channel = is_alpha ? ALPHA : ALPHA_OR_RED;
        }
        return result;
    }

    std::optional<NormalMap> normal_map() {
        if (!find("norm")) return std::nullopt;
        return NormalMap{use("norm", TextureEncoding::linear), find("norm")->multiplier};
    }

    std::optional<BumpMap> bump_map() {
        if (!find("bump") || find("bump")->multiplier == 0.0f) return std::nullopt;
        if (find("norm")) {
            ignored_.add("bump", "their materials have normal maps");
            used_.insert("bump");
            return std::nullopt;
        }
        const float multiplier = find("bump")->multiplier;
        return BumpMap{use("bump", TextureEncoding::linear), multiplier, multiplier};
    }

    void note_ignored() {
        for (const auto& [statement, texture] : s_.textures) {
            if (used_.contains(statement)) continue;
            ignored_.add(statement, "their materials do not use them, because of illum, Pm or a factor of 0");
        }
    }

    const MtlStatements& s_;
    const std::string& file_;
    MtlIgnored& ignored_;
    dvec3 kd_, ks_, ke_;  // As stated; 1 if there is only a texture.
    double opacity_ = 1.0;
    bool is_glass_ = false;
    std::set<std::string, std::less<>> used_;  // Statements that name textures.
    MtlMaterial result_{};
};

}  // namespace

MtlMaterial mtl_material(const MtlStatements& statements, const std::string& file, MtlIgnored& ignored) {
    return Converter(statements, file, ignored).convert();
}

void add_images(MtlMaterial& material, Scene& scene) {
    std::vector<uint32_t> indices;
    for (const MtlImage& image : material.images) {
        const NamedFile named = find_named_file(image.folder, image.file, scene.reach);
        indices.push_back(add_image(scene, named.path, image.place, IfMissing::white));
    }
    for_each_texture(material.material, [&](Texture& texture) { texture.image = indices[texture.image]; });
    if (material.emission.texture)
        material.emission.texture->image = indices[material.emission.texture->image];
    material.images.clear();
}

}  // namespace candela
