// One function per model.
#include "load/obj/mtl_material.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "load/quote.h"
#include "scene/images.h"
#include "scene/material_textures.h"

namespace candela {
namespace {

using Model = decltype(Material::model);

constexpr double GREY = 0.5;  // The reflectance where a file states no colour ...
constexpr double DULL = 0.5;  // ... and the roughness where it states none.

class Converter {
  public:
    Converter(const MtlStatements& statements, const std::string& file, MtlIgnored& ignored)
        : s_(statements), file_(file), ignored_(ignored) {
        ke_ = s_.ke.value_or(dvec3(find("map_Ke") ? 1.0 : 0.0));
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
    void warn(const std::string& what) {
        result_.warnings.push_back(concat(file_, ':', s_.line, ": material ", quote(s_.name), ": ", what));
    }

    const MtlTexture* find(std::string_view statement) const {
        const auto found = s_.textures.find(statement);
        return found == s_.textures.end() ? nullptr : &found->second;
    }

    // The texture of a statement, of which there is one.
    Texture use(const std::string& statement, TextureEncoding encoding) {
        const MtlTexture& stated = *find(statement);
        Texture texture = stated.texture;
        texture.image = uint32_t(result_.images.size());
        texture.encoding = encoding;
        texture.channel = stated.channel.value_or(0);
        result_.images.push_back({std::filesystem::path(file_).parent_path() / stated.file, stated.place});
        used_.insert(statement);
        return texture;
    }

    Textured<vec3> colour_of(dvec3 factor, const std::string& statement) {
        if (!find(statement) || factor == dvec3(0.0)) return vec3(factor);
        return {vec3(factor), use(statement, TextureEncoding::srgb)};
    }

    Textured<float> number_of(float factor, const std::string& statement) {
        if (!find(statement) || factor == 0.0f) return factor;
        return {factor, use(statement, TextureEncoding::linear)};
    }

    bool is_glass() const { return s_.illum == 4 || s_.illum == 6 || s_.illum == 7; }

    bool is_metal() const { return s_.pm ? *s_.pm >= 0.5 : find("map_Pm") != nullptr; }

    Model find_model() {
        if (is_glass()) return glass();
        if (s_.pm && *s_.pm > 0.0 && *s_.pm < 1.0) {
            warn("Pm " + number_text(*s_.pm, 6) + " is read as " +
                 (is_metal() ? "1, a metal" : "0, no metal"));
        }
        if (is_metal()) return metal();
        if (s_.pr) ignored_.add("Pr", NO_METAL);
        if (find("map_Pr")) ignored_.add("map_Pr", NO_METAL);
        if (s_.illum == 3 || s_.illum == 5) return mirror();
        if (s_.illum >= 8) {
            warn("illum " + std::to_string(s_.illum) + " is not supported; the material is read as illum 2");
        }
        return opaque();
    }

    Model glass() const {
        constexpr double COMMON_GLASS = 1.5;
        const auto ior = float(s_.ni.value_or(COMMON_GLASS));
        if (!(ior > 0.0f)) {
            throw Error(file_ + ':' + std::to_string(s_.ni_line) + ": Ni of the glass " + quote(s_.name) +
                        " must be above 0");
        }
        return DielectricMaterial{.ior = ior};
    }

    Model metal() {
        dvec3 none(0.0);
        dvec3 kd = s_.kd ? *s_.kd : default_kd(false);
        limit(none, kd, "Kd");
        const Textured<vec3> reflectance = colour_of(kd, "map_Kd");
        if (!s_.pr && !find("map_Pr"))
            warn("the metal has no roughness (Pr); " + number_text(DULL, 6) + " is taken");
        const double roughness = s_.pr.value_or(find("map_Pr") ? 1.0 : DULL);
        const auto alpha = float(roughness * roughness);
        if (alpha < MIN_ALPHA) {
            warn("Pr " + number_text(roughness, 6) + " is read as " +
                 number_text(std::sqrt(double(MIN_ALPHA)), 6) + ", the least roughness of a metal");
            return ConductorMaterial{reflectance, MIN_ALPHA};
        }
        if (find("map_Pr")) {
            warn(
                "map_Pr is taken for alpha, the square of roughness: the metal looks rougher than it should");
        }
        return ConductorMaterial{reflectance, number_of(alpha, "map_Pr")};
    }

    Model mirror() {
        dvec3 none(0.0);
        dvec3 ks = s_.ks.value_or(dvec3(1.0));
        limit(none, ks, "Ks");
        return MirrorMaterial{colour_of(ks, "map_Ks")};
    }

    Model opaque() {
        const dvec3 stated = s_.ks.value_or(dvec3(find("map_Ks") ? 1.0 : 0.0));
        const bool has_highlight = s_.illum >= 2 && stated != dvec3(0.0);
        dvec3 ks = has_highlight ? stated : dvec3(0.0);
        dvec3 kd = s_.kd ? *s_.kd : default_kd(has_highlight);
        limit(kd, ks, has_highlight ? "Kd + Ks" : "Kd");
        const Textured<vec3> diffuse = colour_of(kd, "map_Kd");
        if (!has_highlight) return DiffuseMaterial{diffuse};
        if (s_.ns > double(MAX_PHONG_EXPONENT)) {
            warn("Ns " + number_text(s_.ns, 6) + " is read as " + number_text(double(MAX_PHONG_EXPONENT), 6) +
                 ", the greatest exponent");
        }
        return PhongMaterial{diffuse, colour_of(ks, "map_Ks"),
                             number_of(std::min(float(s_.ns), MAX_PHONG_EXPONENT), "map_Ns")};
    }

    // A lamp or a shiny thing may well reflect nothing diffusely; anything else was meant to be seen.
    dvec3 default_kd(bool has_highlight) {
        if (find("map_Kd")) return dvec3(1.0);
        if (has_highlight || vec3(ke_) != vec3(0.0f)) return dvec3(0.0);
        warn("it has no colour (Kd); grey of " + number_text(GREY, 6) + " is taken");
        return dvec3(GREY);
    }

    // Scales kd and ks by one factor so that they add up to at most 1; `what` names the sum in messages.
    void limit(dvec3& kd, dvec3& ks, const char* what) {
        constexpr double ROUNDING = 2e-6;  // Of two numbers of six digits, as most programs write them.
        const dvec3 sum = kd + ks;
        const double largest = std::max({sum.x, sum.y, sum.z});
        if (largest <= 1.0) return;
        kd /= largest;
        ks /= largest;
        if (largest <= 1.0 + ROUNDING) return;
        warn(std::string(what) + " is " + number_text(largest, 6) + " in a channel; it is scaled to 1");
    }

    Textured<float> opacity() {
        // Where both are given, d counts: Tr is not in the specification.
        const double stated = s_.d ? *s_.d : 1.0 - s_.tr.value_or(0.0);
        const double d = is_glass() ? 1.0 : std::clamp(stated, 0.0, 1.0);
        if (d != stated && !is_glass()) {
            warn((s_.d ? "d " + number_text(*s_.d, 6) : "Tr " + number_text(*s_.tr, 6)) +
                 " is not from 0 to 1; the material is taken to be " + (d > 0.0 ? "opaque" : "transparent"));
        }
        if (d == 0.0) warn("nothing is seen of it: d is 0, or Tr is 1");
        Textured<float> result = number_of(float(d), "map_d");
        if (result.texture && !find("map_d")->channel) {
            // The name of the colours, once more, means their alpha, and no hole where they are red.
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
        if (find("map_Pm") && (!s_.pm || *s_.pm > 0.0))
            ignored_.add("map_Pm", "a material is a metal or none, as a whole");
        for (const auto& [statement, texture] : s_.textures) {
            if (used_.contains(statement) || statement.starts_with("map_P")) continue;
            ignored_.add(statement,
                         "their materials have no use for them: illum or Pm says so, or a factor of 0");
        }
    }

    static constexpr std::string_view NO_METAL = "the roughness of what is no metal is not supported";

    const MtlStatements& s_;
    const std::string& file_;
    MtlIgnored& ignored_;
    dvec3 ke_;
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
        if (!scene.reach.holds(image.file))
            throw Error(image.place + ": " + scene.reach.refusal(image.file.string()));
        indices.push_back(add_image(scene, image.file, image.place));
    }
    for_each_texture(material.material, [&](Texture& texture) { texture.image = indices[texture.image]; });
    if (material.emission.texture)
        material.emission.texture->image = indices[material.emission.texture->image];
    material.images.clear();
}

}  // namespace candela
