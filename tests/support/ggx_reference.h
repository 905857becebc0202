// Rough surfaces of GGX facets in double precision: their functions, and how much light one scattering by
// them sends out of the surface, by quadrature over the visible normals. Written from the papers, not from
// the shaders.
//
// Local frame: z is the normal on the viewer's side; wo, the viewer, has z > 0. eta is the index of
// refraction behind the surface over that on the viewer's side.
#pragma once

#include <functional>
#include <numbers>

#include "base/math.h"

namespace candela {

inline constexpr double PI_D = std::numbers::pi;

inline double square(double x) {
    return x * x;
}

// The roughness along x and y, above 0.
struct Facets {
    double alpha_x, alpha_y;
};

// Density of facets' area over their normals' solid angle [1/sr], per area of surface.
double facet_distribution(const Facets& facets, dvec3 h);
// Smith's Lambda of a direction on either side, and the share 1 / (1 + Lambda) of facets that it sees.
double smith_lambda(const Facets& facets, dvec3 w);
double smith_g1(const Facets& facets, dvec3 w);
// D_wo, the density of the normals that wo sees [1/sr].
double visible_normals_pdf(const Facets& facets, dvec3 wo, dvec3 h);

// Fresnel's reflectance of unpolarised light at a smooth surface, cosine in [0, 1]; 1 beyond the critical
// angle.
double fresnel_exact(double cosine, double eta);
// The same at normal incidence.
double fresnel_normal(double eta);
// t, how far reflectance is on its way from that at normal incidence to 1: (F - f0) / (1 - f0), at least 0.
// (Above eta = 2 + sqrt(3), F itself is less than f0 at some angles.)
double fresnel_edge(double cosine, double eta);
// 2 int F(mu) mu dmu: what a smooth surface reflects of an even sky.
double fresnel_average(double eta);

dvec3 reflect(dvec3 wo, dvec3 h);
// The square of the refracted direction's cosine; negative beyond the critical angle.
double refracted_cosine_squared(double cosine, double eta);
// Valid where the above is at least 0.
dvec3 refract(dvec3 wo, dvec3 h, double eta);

// The mean of g(h) over the normals that wo sees, to 2e-5 for functions that are smooth but where light
// reflected or refracted, for eta, lies in the surface or reaches the critical angle.
dvec3 mean_over_visible_normals(const Facets& facets, dvec3 wo, double eta,
                                const std::function<dvec3(dvec3)>& g);

// The fraction of the light reflected or refracted by a facet of normal h, seen by wo, that no other facet
// shadows ("s_R", "s_T"); 0 where it goes to the wrong side of the surface or, refracted, nowhere.
double reflected_fraction(const Facets& facets, dvec3 wo, dvec3 h);
double refracted_fraction(const Facets& facets, dvec3 wo, dvec3 h, double eta);

// Share of light that leaves the surface after one reflection by facets that reflect everything.
double ggx_albedo(double alpha_x, double alpha_y, dvec3 wo);
// Of what they lose of an even sky, the share that comes back if each reflection leaves f_0 + edge S, S being
// Schlick's power: fits to the mean of S and to how often light leaves, as PrincipledReferenceWalk finds it.
dvec3 ggx_multiscatter(double alpha, dvec3 f_0, dvec3 edge);

}  // namespace candela
