// Writes what each of the first FIRST_HITS samples of a pixel hits first: a word for each invocation of its work group,
// as shared/first_hits.h says.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "base/sampler.glsl"
#include "scene/camera.glsl"
#include "scene/traversal.glsl"
#include "shared/first_hits.h"

layout(local_size_x = WORKGROUP_SIZE, local_size_y = WORKGROUP_SIZE) in;

layout(std430, binding = BINDING_FIRST_HITS) writeonly buffer WordsBlock {
    uint words[];
};
layout(push_constant) uniform RunBlock {
    PixelRun run;
};

void main() {
    uint number = run.first + gl_WorkGroupID.x;
    Parameters parameters = scene_parameters();
    uvec2 pixel = parameters.crop + uvec2(number % run.width, number / run.width);
    Sampler random = sampler_make(pixel, gl_LocalInvocationIndex, parameters.seed);
    CameraSample view = camera_sample(parameters, pixel, random);
    Hit hit = bvh_seen(view.ray);
    uint word = 0u;
    if (view.sees && is_hit(hit))
        word = is_instanced(hit.instance) ? FIRST_HIT_INSTANCE | hit.instance : hit_id(hit) + 1u;
    words[gl_WorkGroupID.x * FIRST_HITS + gl_LocalInvocationIndex] = word;
}
