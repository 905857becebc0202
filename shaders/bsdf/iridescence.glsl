// Reflectance of a thin film on a base: light that the two boundaries reflect interferes.
// Ref: Belcour and Barla 2017, A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence, in
// the approximation of KHR_materials_iridescence, which has these numbers.
#ifndef BSDF_IRIDESCENCE_GLSL
#define BSDF_IRIDESCENCE_GLSL

#include "base/exponential.glsl"
#include "base/math.glsl"
#include "bsdf/fresnel.glsl"

// Reflectance at normal incidence of a boundary between two indices of refraction.
vec3 fresnel_normal(vec3 n1, vec3 n2) {
    vec3 root = (n2 - n1) / (n2 + n1);
    return root * root;
}

// cos(x), x of any size.
float cos_of_phase(float x) {
    float turns = x * (0.5 * INV_PI);
    return cos_sin_turn(turns - floor(turns)).x;
}

// The mean of cos(2 pi path / wavelength + shift) under the eye's sensitivity curves for red, green and blue, by their
// Fourier transforms; path [nm], wavelengths in vacuum.
vec3 interference(float path, vec3 shift) {
    // Gaussians in XYZ: height [m], mean [1/m], variance [1/m^2] of each; X has a second one.
    const vec4 HEIGHT = vec4(5.4856e-13, 4.4201e-13, 5.2481e-13, 9.7470e-14);
    const vec4 MEAN = vec4(1.6810e6, 1.7953e6, 2.2084e6, 2.2399e6);
    const vec4 VARIANCE = vec4(4.3278e9, 9.3046e9, 6.6121e9, 4.5282e9);
    const float UNIT = 1.0685e-7;
    const mat3 XYZ_TO_REC709 =
        mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560, 1.0572252);
    float phase = 2.0 * PI * 1e-9 * path;
    vec4 shifts = vec4(shift, shift.x);
    vec4 part;
    for (int i = 0; i < 4; ++i) {
        part[i] = HEIGHT[i] / UNIT * sqrt(2.0 * PI * VARIANCE[i]) * cos_of_phase(MEAN[i] * phase + shifts[i]) *
                  exp_nonpositive(-VARIANCE[i] * square(phase));
    }
    return XYZ_TO_REC709 * vec3(part.x + part.w, part.yz);
}

// Reflectance of a film of that index and thickness [nm] in air, on a base that reflects f0 in air at normal incidence;
// cos_o in [0, 1] in air. In [0, 1].
vec3 fresnel_film(float cos_o, float film_ior, float thickness, vec3 f0) {
    float cos_film = refracted_cosine(1.0 - square(cos_o), film_ior);
    float outer = mix(square((film_ior - 1.0) / (film_ior + 1.0)), 1.0, schlick_weight(cos_o));
    float through = 1.0 - outer;
    vec3 root = sqrt(min(f0 + 1e-4, vec3(0.9999)));
    vec3 base_ior = (1.0 + root) / (1.0 - root);
    vec3 inner = fresnel_conductor_schlick(fresnel_normal(vec3(film_ior), base_ior), cos_film);
    vec3 shift = mix(vec3(PI), vec3(2.0 * PI), lessThan(base_ior, vec3(film_ior)));
    float path = 2.0 * film_ior * thickness * cos_film;

    vec3 product = clamp(outer * inner, 1e-5, 0.9999);
    vec3 rest = square(through) * inner / (1.0 - product);
    vec3 sum = outer + rest;
    vec3 order = rest - through;
    for (int m = 1; m <= 2; ++m) {
        order *= sqrt(product);
        sum += 2.0 * order * interference(float(m) * path, float(m) * shift);
    }
    return clamp(sum, 0.0, 1.0);
}

#endif
