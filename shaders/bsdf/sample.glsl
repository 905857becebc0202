// The results of evaluating and sampling a BSDF.
//
// Conventions of all BSDFs: wo (towards the viewer) and wi (towards the light) are unit vectors that point away
// from the surface, in the local frame whose z is the shading normal on the viewer's side. `f` is the value
// without the cosine [1/sr], `pdf` the density over solid angle [1/sr]. Where scattering is ideal ("delta"), f and pdf
// are 0 everywhere, and a sample's pdf is the probability of its choice.
#ifndef BSDF_SAMPLE_GLSL
#define BSDF_SAMPLE_GLSL

// Facets up to this roughness are as good as a mirror for those who ask what is seen in it.
const float SHARP_ALPHA = 0.05;

// The value for a pair of directions.
struct BsdfValue {
    vec3 f;     // [1/sr]
    float pdf;  // Density of sampling wi [1/sr].
};

BsdfValue bsdf_zero() {
    return BsdfValue(vec3(0.0), 0.0);
}

struct BsdfSample {
    vec3 wi;
    vec3 weight;  // f |cos(theta_i)| / pdf, for radiance: refraction divides by eta^2. 0: nothing is scattered.
    float pdf;    // [1/sr]; 0 means that the sample failed.
    bool delta;   // Ideal scattering: light samples cannot find wi.
    float eta;    // Index of refraction on wi's side over that on wo's; 1 unless wi is refracted.
    bool above;   // Whether wi is meant to be on the viewer's side: wi.z > 0, except for layers with their own normal.
};

// A sample of scattering that is not ideal.
BsdfSample bsdf_sample(vec3 wi, vec3 weight, float pdf) {
    return BsdfSample(wi, weight, pdf, false, 1.0, wi.z > 0.0);
}

// A sample of ideal scattering, chosen with the probability pmf.
BsdfSample bsdf_sample_delta(vec3 wi, vec3 weight, float pmf, float eta) {
    return BsdfSample(wi, weight, pmf, true, eta, wi.z > 0.0);
}

// Nothing is scattered.
BsdfSample bsdf_sample_failed() {
    return bsdf_sample(vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0);
}

#endif
