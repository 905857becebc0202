// One function per model.
#include "load/obj/mtl_material.h"

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "load/quote.h"

namespace candela {
namespace {

using Model = decltype(Material::model);

constexpr double GREY = 0.5;  // The reflectance where a file states no colour.

class Converter {
  public:
    Converter(const MtlStatements& statements, const std::string& file) : s_(statements), file_(file) {}

    MtlMaterial convert() {
        Model model = find_model();
        return {{s_.name, model}, s_.ke, std::move(warnings_)};
    }

  private:
    void warn(const std::string& what) {
        warnings_.push_back(file_ + ':' + std::to_string(s_.line) + ": material " + quote(s_.name) + ": " +
                            what);
    }

    Model find_model() {
        if (s_.illum == 4 || s_.illum == 6 || s_.illum == 7) return glass();
        // Where both are given, d counts: Tr is not in the specification.
        const bool is_transparent = s_.d ? *s_.d < 1.0 : s_.tr.value_or(0.0) > 0.0;
        if (is_transparent) warn("transparency (d, Tr) is ignored; illum 4, 6 or 7 would make it glass");
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

    Model mirror() {
        dvec3 none(0.0);
        dvec3 ks = s_.ks.value_or(dvec3(1.0));
        limit(none, ks, "Ks");
        return MirrorMaterial{vec3(ks)};
    }

    Model opaque() {
        const bool has_highlight = s_.illum >= 2 && s_.ks && *s_.ks != dvec3(0.0);
        dvec3 ks = has_highlight ? *s_.ks : dvec3(0.0);
        dvec3 kd = s_.kd ? *s_.kd : default_kd(has_highlight);
        limit(kd, ks, has_highlight ? "Kd + Ks" : "Kd");
        if (!has_highlight) return DiffuseMaterial{vec3(kd)};
        if (s_.ns > double(MAX_PHONG_EXPONENT)) {
            warn("Ns " + number_text(s_.ns, 6) + " is read as " + number_text(double(MAX_PHONG_EXPONENT), 6) +
                 ", the greatest exponent");
        }
        return PhongMaterial{vec3(kd), vec3(ks), std::min(float(s_.ns), MAX_PHONG_EXPONENT)};
    }

    // A lamp or a metal may well reflect nothing diffusely; anything else was meant to be seen.
    dvec3 default_kd(bool has_highlight) {
        if (!s_.has_texture && (has_highlight || s_.ke != vec3(0.0f))) return dvec3(0.0);
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

    const MtlStatements& s_;
    const std::string& file_;
    std::vector<std::string> warnings_;
};

}  // namespace

MtlMaterial mtl_material(const MtlStatements& statements, const std::string& file) {
    return Converter(statements, file).convert();
}

}  // namespace candela
