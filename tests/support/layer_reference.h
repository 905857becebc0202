// What a layered material has besides its facets, in double precision and from the papers and extensions of
// glTF themselves, not from the shaders: sheen, fuzz, rough diffuse reflection, thin films, coats,
// dispersion.
//
// Local frame: z is the normal on the viewer's side. Values are BRDFs, without the cosine [1/sr].
#pragma once

#include <functional>

#include "base/math.h"

namespace candela {

// The integral of f(wi) cos over the directions above the surface; f is symmetric about the plane of wo.
dvec3 integrate_over_cosine(dvec3 wo, const std::function<dvec3(dvec3)>& f);

// Sheen of white fibres; 0 unless both directions are above the surface. alpha_g above 0.
double sheen_f(double alpha_g, dvec3 wo, dvec3 wi);
// The light that they reflect ("Es").
double sheen_albedo(double alpha_g, double cosine);

// Fuzz of white fibres; 0 unless both directions are above the surface. Roughness in [0.01, 1].
double fuzz_f(double roughness, dvec3 wo, dvec3 wi);
// The light that it reflects, as its model states it.
double fuzz_albedo(double roughness, double cosine);

// Rough diffuse reflection; sigma = 0 is Lambert's. Both directions above the surface.
dvec3 eon_f(dvec3 color, double sigma, dvec3 wo, dvec3 wi);
// Its directional albedo for a white colour, without the compensation of multiple scattering.
double fon_albedo(double sigma, double cosine);

// Reflectance of a film of this thickness [nm] and index on a base of reflectance base_f0 in air, in [0, 1].
dvec3 iridescent_fresnel(double film_ior, dvec3 base_f0, double thickness, double cosine);

// What a coat leaves of the light that the base under it sends back: what is reflected into the base again
// is partly absorbed there. The base is given by its reflectance at normal incidence, in [0, 1], and its
// roughness.
dvec3 coat_darkening(double coat_ior, double cosine, dvec3 base_albedo, double base_roughness);

// Indices of refraction for red, green and blue.
dvec3 dispersed_ior(double ior, double dispersion);

}  // namespace candela
