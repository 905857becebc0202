// For vk_test.cpp: reads every kind of resource and writes a known function of them, so that a wrong binding
// shows.
#version 450
layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint FACTOR = 0;
layout(constant_id = 1) const uint SUMMAND = 0;

layout(set = 0, binding = 0) uniform usamplerBuffer texels;  // One per pixel, row-major.
layout(set = 0, binding = 1, std430) readonly buffer Weights {
    float weights[];
};  // One per column.
layout(set = 0, binding = 2, std140) uniform Tint {
    vec4 tint;
};
layout(set = 0, binding = 3, rgba32f) uniform image2DArray pixels;
layout(set = 0, binding = 4, std430) buffer Count {
    uint count;
};  // Pixels written so far.

layout(push_constant) uniform Push {
    uint layer;
    float gain;
};

// Adds ((texel * FACTOR + SUMMAND) * gain * weight + tint) to each pixel of the layer.
void main() {
    ivec2 size = imageSize(pixels).xy;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size))) return;
    uvec4 texel = texelFetch(texels, pixel.y * size.x + pixel.x);
    ivec3 place = ivec3(pixel, layer);
    vec4 value = vec4(texel * FACTOR + SUMMAND) * gain * weights[pixel.x] + tint;
    imageStore(pixels, place, imageLoad(pixels, place) + value);
    atomicAdd(count, 1);
}
