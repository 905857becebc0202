// Writes which point of which surface the sharp ray through the centre of each pixel hits, as shared/first_points.h
// says; zeros if it misses.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/camera.glsl"
#include "scene/interaction.glsl"
#include "shared/first_hits.h"
#include "shared/first_points.h"

layout(local_size_x = WORKGROUP_SIZE, local_size_y = WORKGROUP_SIZE) in;

layout(std430, binding = BINDING_FIRST_POINTS) writeonly buffer WordsBlock {
    uvec4 words[];
};
layout(push_constant) uniform TileBlock {
    Tile tile;
};

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, tile.size))) return;
    Parameters parameters = scene_parameters();
    vec2 film = vec2(parameters.crop + tile.origin + at) + 0.5;
    Ray ray = camera_ray_sharp(parameters, film);
    Hit hit = bvh_seen(ray);
    uvec4 surface = uvec4(0u), point = uvec4(0u);
    if (is_hit(hit) && camera_sees(parameters, film)) {
        Ray inside = ray;
        if (is_instanced(hit.instance)) inside = ray_to_mesh(scene_instance(hit.instance), ray);
        uvec2 coordinates = floatBitsToUint(hit_coordinates(inside, scene_primitive(hit_primitive(hit)), hit));
        uint id = hit_id(hit);
        uint word = is_instanced(hit.instance) ? FIRST_HIT_INSTANCE | hit.instance : id + 1u;
        surface = uvec4(word, id, coordinates);
        point = uvec4(floatBitsToUint(interaction_at(ray, hit).p), 0u);
    }
    uint first = FIRST_POINT_WORDS * (at.y * tile.size.x + at.x);
    words[first] = surface;
    words[first + 1u] = point;
}
