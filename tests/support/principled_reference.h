// The principled material in double precision, from its definition and not from the shaders: a metal or a
// dielectric over a diffuse or transmissive base, under sheen, coat and fuzz. What facets lose by shadowing
// each other is given back diffusely. Shares of light are found by quadrature, not by fits.
//
// Local frame: z is the shading normal on the viewer's side, x the (rotated) tangent. wo, the viewer, has z >
// 0; wi, the light, may lie on either side.
#pragma once

#include <vector>

#include "base/math.h"
#include "support/ggx_reference.h"

namespace candela {

// After textures. Colours and weights in [0, 1]. The order and meaning are those of PrincipledMaterial.
struct PrincipledParameters {
    dvec3 base_color{0.8};
    double metalness = 0;
    double roughness = 0.5;
    double diffuse_roughness = 0;
    double ior = 1.5;  // 0: it reflects all light.
    double specular = 1;
    dvec3 specular_color{1};
    double anisotropy = 0;
    double transmission = 0;
    bool thin = true;     // No medium inside: the surface does not refract.
    bool inside = false;  // The viewer is in the volume; not if thin.
    double dispersion = 0;
    double diffuse_transmission = 0;
    dvec3 diffuse_transmission_color{1};
    double coat = 0;
    double coat_roughness = 0;
    double coat_ior = 1.5;
    double coat_darkening = 0;
    dvec3 coat_normal{0, 0, 1};
    dvec3 sheen_color{0};
    double sheen_roughness = 0;
    double fuzz = 0;
    dvec3 fuzz_color{1};
    double fuzz_roughness = 0.5;
    double iridescence = 0;
    double iridescence_ior = 1.3;
    double iridescence_thickness = 400;  // [nm]
};

// A value for each lobe: of the BSDF [1/sr], or a share of light. They add up to the whole. The last two are
// the light that facets scatter more than once, on the viewer's side and on the other.
struct PrincipledLobes {
    dvec3 fuzz{0}, coat{0}, sheen{0}, reflection{0}, transmission{0}, diffuse_reflection{0},
        diffuse_transmission{0};
    dvec3 multiscatter_up{0}, multiscatter_down{0};
    dvec3 sum() const {
        return fuzz + coat + sheen + reflection + transmission + diffuse_reflection + diffuse_transmission +
               multiscatter_up + multiscatter_down;
    }
};

class PrincipledReference {
  public:
    PrincipledReference(const PrincipledParameters& parameters, dvec3 wo);

    // The value without ideal parts, without the cosine, for radiance [1/sr]; 0 for wi in the surface.
    dvec3 f(dvec3 wi) const { return lobes(wi).sum(); }
    // The same by lobes, each as the layers above it leave it.
    PrincipledLobes lobes(dvec3 wi) const;
    dvec3 coat(dvec3 wi) const { return lobes(wi).coat; }
    dvec3 sheen(dvec3 wi) const { return lobes(wi).sheen; }
    dvec3 reflection(dvec3 wi) const { return lobes(wi).reflection; }
    dvec3 transmission(dvec3 wi) const { return lobes(wi).transmission; }
    dvec3 diffuse_reflection(dvec3 wi) const { return lobes(wi).diffuse_reflection; }
    dvec3 diffuse_transmission(dvec3 wi) const { return lobes(wi).diffuse_transmission; }
    dvec3 multiscatter_up(dvec3 wi) const { return lobes(wi).multiscatter_up; }
    dvec3 multiscatter_down(dvec3 wi) const { return lobes(wi).multiscatter_down; }

    // Share of energy that ideal parts send into their one direction; 0 where a lobe is rough.
    PrincipledLobes ideal() const;
    // By quadrature of the value: share of the energy of an even sky, of all lobes and ideal parts.
    PrincipledLobes albedos() const;
    dvec3 albedo() const { return albedos().sum(); }

    // What the layers leave of light that the surface emits towards wo.
    double emission_factor() const { return under_layers(); }

    // Whether specular reflection and transmission, and the coat's reflection, are ideal. (Those of a volume
    // whose index is the air's are, at any roughness.)
    bool is_ideal() const { return ideal_; }
    bool is_coat_ideal() const { return coat_ideal_; }

    // The quadratures, of the green index if there is dispersion. Those that the parameters have no use for
    // are 0: of glass without transmission, of sheen or coat without any.
    struct Fractions {
        double metal_lost = 0;            // By facets that reflect everything, to shadowing.
        double glass_lost = 0;            // By clear glass, of the dielectric's reflectance.
        double dielectric_lost = 0;       // By the dielectric's reflection, over an opaque base.
        double dielectric_reflected = 0;  // By its facets, with what is lost: it does not reach the base.
        double es = 0, rc = 0;            // Reflected by the sheen; by the coat, at weight 1.
    };
    const Fractions& fractions() const { return fractions_; }

  private:
    void find_optics();
    void find_fractions();
    void find_diffuse_parts();
    void find_layers();

    dvec3 dielectric_fresnel(double cosine) const;
    dvec3 film_or_dielectric_fresnel(double cosine) const;
    dvec3 transmitting_fresnel(double cosine) const;
    dvec3 specular_fresnel(double cosine) const;
    double greatest_fresnel(double cosine) const;
    double greatest_transmitting_fresnel(double cosine) const;
    dvec3 transmittance(double cosine) const;
    double coat_fresnel(double cosine) const;
    dvec3 reflection_value(dvec3 wi) const;
    dvec3 transmission_value(dvec3 wi) const;
    double coat_value(dvec3 wi) const;
    double under_layers() const { return fuzz_transmittance_ * coat_transmittance_ * sheen_transmittance_; }
    dvec3 to_coat(dvec3 w) const;
    dvec3 from_coat(dvec3 w) const;

    PrincipledParameters p_;
    dvec3 wo_;
    Facets facets_{}, coat_facets_{};
    bool ideal_ = false, coat_ideal_ = false, has_coat_ = false, has_sheen_ = false;
    bool has_fuzz_ = false;
    double film_ = 0;  // Weight of iridescence.
    double eta_ = 1, alpha_g_ = 1, fuzz_roughness_ = 1;
    dvec3 f0_{0};  // Reflectance of the dielectric at normal incidence, before `specular`.
    dvec3 film_metal_{0}, film_dielectric_{0};  // Reflectance of the film on either.
    dvec3 metal_f0_{0}, dielectric_f0_{0};      // With the film.
    Fractions fractions_{};
    dvec3 multiscatter_up_{0}, multiscatter_down_{0};  // Shares of light, before the layers.
    double diffuse_ = 0;                               // What reaches the opaque base.
    double fuzz_transmittance_ = 1, coat_transmittance_ = 1, sheen_transmittance_ = 1, sheen_scale_ = 1;
    dvec3 darkening_{1};
    dvec3 coat_x_{1, 0, 0}, coat_y_{0, 1, 0};
    std::vector<PrincipledReference> channels_;  // Under dispersion: the material for each one's index.
};

}  // namespace candela
