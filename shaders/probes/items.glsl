// Shared by the probes: invocation i reads item i, ITEM_WORDS words of uvec4, and writes result i, RESULT_WORDS words,
// value after value. A kernel defines both numbers before it includes this.
#ifndef PROBES_ITEMS_GLSL
#define PROBES_ITEMS_GLSL

#include "shared/constants.h"

layout(local_size_x = 64) in;

layout(binding = BINDING_ITEMS) uniform usamplerBuffer items;
layout(std430, binding = BINDING_RESULTS) writeonly buffer ResultsBlock {
    uint results[];
};
layout(push_constant) uniform CountsBlock {
    uint item_count;
    uint primitive_count;  // Primitives of the scene, for kernels that read a scene.
};

// True for invocations without an item.
bool past_end() {
    return gl_GlobalInvocationID.x >= item_count;
}

uvec4 item(uint word) {
    return texelFetch(items, int(gl_GlobalInvocationID.x * ITEM_WORDS + word));
}

vec4 item_floats(uint word) {
    return uintBitsToFloat(item(word));
}

uint values_put = 0u;

void put(uint value) {
    results[gl_GlobalInvocationID.x * RESULT_WORDS + values_put] = value;
    ++values_put;
}

void put(uvec2 v) {
    put(v.x);
    put(v.y);
}

void put(uvec3 v) {
    put(v.xy);
    put(v.z);
}

void put(uvec4 v) {
    put(v.xyz);
    put(v.w);
}

void put(float value) {
    put(floatBitsToUint(value));
}

void put(vec2 v) {
    put(floatBitsToUint(v));
}

void put(vec3 v) {
    put(floatBitsToUint(v));
}

void put(vec4 v) {
    put(floatBitsToUint(v));
}

#endif
