// Integer hashes.
#ifndef BASE_HASH_GLSL
#define BASE_HASH_GLSL

// Three and four words of random bits from as many words of input.
// Ref: Jarzynski and Olano 2020, Hash Functions for GPU Rendering, pcg3d and pcg4d.
uvec3 hash_pcg3d(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

uvec4 hash_pcg4d(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Permutes 32-bit words so that bit k of the result depends on the bits 0..k of x alone: an Owen scramble of the
// bit-reversed number. Ref: Laine and Karras 2011, Stratified Sampling for Stochastic Transparency, section 3.1;
// Burley 2020, Practical Hash-based Owen Scrambling, section 3; constants by Vegdahl 2021, Building a Better LK Hash.
uint hash_laine_karras(uint x, uint seed) {
    x ^= x * 0x3D20ADEAu;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526C56u;
    x ^= x * 0x53A22864u;
    return x;
}

#endif
