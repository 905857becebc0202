// What sampling a BSDF returns.
//
// Conventions of all BSDFs: wo (towards the viewer) and wi (towards the light) are unit vectors that point away
// from the surface, in the local frame whose z is the shading normal on the viewer's side. `f` is the value
// without the cosine [1/sr], `pdf` the density over solid angle [1/sr].
#ifndef BSDF_SAMPLE_GLSL
#define BSDF_SAMPLE_GLSL

struct BsdfSample {
    vec3 wi;
    vec3 weight;  // f |cos(theta_i)| / pdf; 0 where nothing is scattered.
    float pdf;    // [1/sr]; 0 says that the sample failed.
};

#endif
