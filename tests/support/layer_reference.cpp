// See layer_reference.h.
#include "support/layer_reference.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/ggx_reference.h"
#include "support/quadrature.h"

namespace candela {
namespace {

// Ref: KHR_materials_sheen, "Sheen visibility" (Conty and Kulla 2017, "Production friendly microfacet sheen
// BRDF").
double sheen_l(double x, double alpha_g) {
    const double k = square(1 - alpha_g);
    const double a = std::lerp(21.5473, 25.3245, k);
    const double b = std::lerp(3.82987, 3.32435, k);
    const double c = std::lerp(0.19823, 0.16801, k);
    const double d = std::lerp(-1.97760, -1.27393, k);
    const double e = std::lerp(-4.32054, -4.85967, k);
    return a / (1 + b * std::pow(x, c)) + d * x + e;
}

double sheen_lambda(double cosine, double alpha_g) {
    return cosine < 0.5 ? std::exp(sheen_l(cosine, alpha_g))
                        : std::exp(2 * sheen_l(0.5, alpha_g) - sheen_l(1 - cosine, alpha_g));
}

// Ref: the same, "Sheen distribution".
double sheen_distribution(double cosine, double alpha_g) {
    const double sine_squared = std::max(0.0, 1 - cosine * cosine);
    return (2 + 1 / alpha_g) * std::pow(sine_squared, 0.5 / alpha_g) / (2 * PI_D);
}

// The map from the directions of fuzz to those of Lambert's law, for wo in the half-plane of x > 0.
// Ref: Zeltner, Burley and Chiang 2022, "Practical multiple-scattering sheen using linearly transformed
// cosines", with the fits of its two numbers that MaterialX 1.39 has (mx_microfacet_sheen.glsl).
glm::dmat3 fuzz_to_lambert(double roughness, double cosine) {
    const double x = cosine, y = roughness;
    const double a = (2.58126 * x + 0.813703 * y) * y / (1 + 0.310327 * x * x + 2.60994 * x * y);
    const double b = std::sqrt(1 - x) * (y - 1) * std::pow(y, 3) /
                     (0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y);
    return {dvec3(a, 0, 0), dvec3(0, a, 0), dvec3(b, 0, 1)};  // Columns.
}

// Coefficients of Fujii's form of Oren and Nayar's model.
// Ref: Portsmouth, Kutz and Hill 2024, "EON: A practical energy-preserving rough diffuse BRDF", section 2.
double fon_a(double sigma) {
    return 1 / (1 + (0.5 - 2 / (3 * PI_D)) * sigma);
}

// Ref: the same; the average of fon_albedo() over an even sky.
double fon_average(double sigma) {
    return fon_a(sigma) * (1 + (2.0 / 3 - 28 / (15 * PI_D)) * sigma);
}

double schlick(double f0, double cosine) {
    return f0 + (1 - f0) * std::pow(1 - cosine, 5);
}

// Ref: KHR_materials_iridescence, "Analytic spectral integration"; path difference in nm.
dvec3 eval_sensitivity(double path, dvec3 shift) {
    const double phase = 2 * PI_D * path * 1e-9;
    const dvec3 value(5.4856e-13, 4.4201e-13, 5.2481e-13);
    const dvec3 position(1.6810e+06, 1.7953e+06, 2.2084e+06);
    const dvec3 variance(4.3278e+09, 9.3046e+09, 6.6121e+09);
    dvec3 xyz(0);
    for (int k = 0; k < 3; ++k)
        xyz[k] = value[k] * std::sqrt(2 * PI_D * variance[k]) * std::cos(position[k] * phase + shift[k]) *
                 std::exp(-square(phase) * variance[k]);
    xyz.x += 9.7470e-14 * std::sqrt(2 * PI_D * 4.5282e+09) * std::cos(2.2399e+06 * phase + shift.x) *
             std::exp(-4.5282e+09 * square(phase));
    xyz /= 1.0685e-7;
    return dvec3(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                 -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                 0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
}

double normal_reflectance(double behind, double before) {
    return square((behind - before) / (behind + before));
}

}  // namespace

// In spherical coordinates about the normal, azimuth from that of wo. The models have kinks at wo's
// elevation, at a right angle to its azimuth, and, for sheen, at 60 degrees.
dvec3 integrate_over_cosine(dvec3 wo, const std::function<dvec3(dvec3)>& f) {
    constexpr int ORDER = 40;
    const double polar_o = std::acos(std::clamp(wo.z, 0.0, 1.0)), azimuth_o = std::atan2(wo.y, wo.x);
    std::vector<double> breaks{0, PI_D / 3, polar_o, PI_D / 2};
    std::sort(breaks.begin(), breaks.end());
    dvec3 sum(0);
    visit_pieces({0, PI_D / 2, PI_D}, ORDER, [&](double azimuth, double azimuth_weight) {
        visit_pieces(breaks, ORDER, [&](double polar, double weight) {
            const dvec3 wi(std::sin(polar) * std::cos(azimuth_o + azimuth),
                           std::sin(polar) * std::sin(azimuth_o + azimuth), std::cos(polar));
            sum += 2 * azimuth_weight * weight * std::sin(polar) * std::cos(polar) * f(wi);
        });
    });
    return sum;
}

// Ref: KHR_materials_sheen, "Implementation notes".
double sheen_f(double alpha_g, dvec3 wo, dvec3 wi) {
    if (wo.z <= 0 || wi.z <= 0) return 0;
    const double cosine_h = normalize(wo + wi).z;
    const double shadowing = 1 / (1 + sheen_lambda(wo.z, alpha_g) + sheen_lambda(wi.z, alpha_g));
    return sheen_distribution(cosine_h, alpha_g) * shadowing / (4 * wo.z * wi.z);
}

double sheen_albedo(double alpha_g, double cosine) {
    const dvec3 wo(std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, cosine);
    return integrate_over_cosine(wo, [&](dvec3 wi) { return dvec3(sheen_f(alpha_g, wo, wi)); }).x;
}

// Ref: Heitz, Dupuy, Hill and Neubelt 2016, "Real-time polygonal-light shading with linearly transformed
// cosines", equation 1, of the matrix above, whose x is the azimuth of wo; Zeltner, Burley and Chiang 2022,
// equation 1.
double fuzz_f(double roughness, dvec3 wo, dvec3 wi) {
    if (wo.z <= 0 || wi.z <= 0) return 0;
    const double azimuth = std::atan2(wi.y, wi.x) - std::atan2(wo.y, wo.x), sine = std::hypot(wi.x, wi.y);
    const glm::dmat3 to_lambert = fuzz_to_lambert(roughness, wo.z);
    const dvec3 original = to_lambert * dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), wi.z);
    const double density =
        normalize(original).z / PI_D * glm::determinant(to_lambert) / std::pow(length(original), 3);
    return fuzz_albedo(roughness, wo.z) * density / wi.z;
}

// Ref: MaterialX 1.39, as above: a Gaussian in the cosine, on an offset, which rounds below 0.
double fuzz_albedo(double roughness, double cosine) {
    const double y = roughness;
    const double width = y * (0.0206607 + 1.58491 * y) / (0.0379424 + 1.32227 * y + y * y);
    const double mean =
        y * (-0.193854 - 1.14885 * y + 1.7932 * y * y - 0.95943 * std::pow(y, 4)) / (0.046391 + y);
    const double offset =
        y * (0.000654023 - 0.0207818 * y + 0.119681 * y * y) / (1.26264 - 1.92021 * y + y * y);
    const double gaussian = std::exp(-0.5 * square((cosine - mean) / width)) / (width * std::sqrt(2 * PI_D));
    return std::max(gaussian + offset, 0.0);
}

// Ref: Portsmouth, Kutz and Hill 2024, section 2, the exact form.
double fon_albedo(double sigma, double cosine) {
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double g = sine * (std::acos(std::clamp(cosine, -1.0, 1.0)) - sine * cosine) +
                     2.0 / 3 * ((sine / cosine) * (1 - sine * sine * sine) - sine);
    return fon_a(sigma) * (1 + sigma * g / PI_D);
}

// Ref: the same, section 3; OpenPBR 1.1, "Glossy-diffuse slab" (whose rho_ms has one 1 / pi too many).
dvec3 eon_f(dvec3 color, double sigma, dvec3 wo, dvec3 wi) {
    const double s = dot(wo, wi) - wo.z * wi.z;
    const double s_over_t = s > 0 ? s / std::max(wo.z, wi.z) : s;
    const dvec3 single = color / PI_D * fon_a(sigma) * (1 + sigma * s_over_t);
    if (sigma == 0) return single;
    const double average = fon_average(sigma);
    const dvec3 color_multiple = color * color * average / (dvec3(1) - color * (1 - average));
    const dvec3 multiple =
        color_multiple / PI_D * (1 - fon_albedo(sigma, wo.z)) * (1 - fon_albedo(sigma, wi.z)) / (1 - average);
    return single + multiple;
}

// Ref: KHR_materials_iridescence, "Iridescence Fresnel" (Belcour and Barla 2017, simplified). Its guard
// against a base that reflects everything, base_f0 + 0.0001, does not hold from 0.9999 on: such a base is
// taken for 0.9999.
dvec3 iridescent_fresnel(double film_ior, dvec3 base_f0, double thickness, double cosine) {
    const double cosine2_squared = 1 - (1 - cosine * cosine) / square(film_ior);
    if (cosine2_squared < 0) return dvec3(1);
    const double cosine2 = std::sqrt(cosine2_squared);

    const double r12 = schlick(normal_reflectance(film_ior, 1), cosine);
    const double t121 = 1 - r12;
    const double phi21 = film_ior < 1 ? 0.0 : PI_D;
    dvec3 r23(0), phi(0);
    for (int k = 0; k < 3; ++k) {
        const double root = std::sqrt(std::min(base_f0[k] + 0.0001, 0.9999));
        const double base_ior = (1 + root) / (1 - root);
        r23[k] = schlick(normal_reflectance(base_ior, film_ior), cosine2);
        phi[k] = phi21 + (base_ior < film_ior ? PI_D : 0.0);
    }

    const dvec3 r123 = clamp(r12 * r23, 1e-5, 0.9999);
    const dvec3 rs = square(t121) * r23 / (dvec3(1) - r123);
    dvec3 sum = r12 + rs;
    dvec3 amplitude = rs - t121;
    for (int m = 1; m <= 2; ++m) {
        amplitude *= sqrt(r123);
        const double path = 2 * film_ior * thickness * cosine2;
        sum += amplitude * 2.0 * eval_sensitivity(m * path, double(m) * phi);
    }
    return clamp(sum, 0.0, 1.0);
}

// Ref: OpenPBR 1.1, "Darkening": equations for Delta, K_r, K_s and K.
dvec3 coat_darkening(double coat_ior, double cosine, dvec3 base_albedo, double base_roughness) {
    const double rough = 1 - (1 - fresnel_average(coat_ior)) / square(coat_ior);
    const double smooth = fresnel_exact(cosine, coat_ior);
    const double returned = std::lerp(smooth, rough, base_roughness);
    return (1 - returned) / (dvec3(1) - base_albedo * returned);
}

// Ref: KHR_materials_dispersion, "Implementation", where the limit is 1.
dvec3 dispersed_ior(double ior, double dispersion) {
    const double half_spread = (ior - 1) * 0.025 * dispersion;
    return dvec3(std::max(std::min(ior, 1.001), ior - half_spread), ior, ior + half_spread);
}

}  // namespace candela
