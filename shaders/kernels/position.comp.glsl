// Writes where the sharp ray through the centre of each pixel hits: position and distance along the camera's axis, or,
// of a panorama, from the camera, in the frame of the scene. A pixel whose ray misses gets 0 0 0 and infinity.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/camera.glsl"
#include "scene/interaction.glsl"

layout(local_size_x = WORKGROUP_SIZE, local_size_y = WORKGROUP_SIZE) in;

layout(binding = BINDING_IMAGE, rgba32f) uniform writeonly image2DArray position;
layout(push_constant) uniform TileBlock {
    Tile tile;
};

void main() {
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, tile.size))) return;
    uvec2 at = tile.origin + gl_GlobalInvocationID.xy;
    Parameters parameters = scene_parameters();
    vec2 film = vec2(parameters.crop + at) + 0.5;
    Ray ray = camera_ray_sharp(parameters, film);
    Hit hit = bvh_seen(ray);
    vec4 value = vec4(vec3(0.0), uintBitsToFloat(0x7F800000u));
    if (is_hit(hit) && camera_sees(parameters, film)) {
        vec3 p = interaction_at(ray, hit).p;
        vec3 away = p - parameters.position;
        value = vec4(p, IS_PANORAMA ? length(away) : dot(away, parameters.forward));
    }
    imageStore(position, ivec3(at, 0), value);
}
