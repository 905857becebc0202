// Between the frame of the scene and the space of an instance's mesh.
#ifndef SCENE_INSTANCE_GLSL
#define SCENE_INSTANCE_GLSL

#include "base/ray.glsl"
#include "scene/scene_data.glsl"
#include "shared/light.h"

// Some instances emit.
const bool HAS_LAMPS = (LIGHTS & 1u << LIGHT_LAMP) != 0u;

// Whether a hit in that instance, or in none, lies in the space of a mesh.
bool is_instanced(uint instance) {
    return INSTANCED && instance != NO_INSTANCE;
}

// A vector of the frame of the scene in the mesh's space: the same bits everywhere in the code, since the coordinates
// of a hit must match the ray that found it. (glslang 12 does not make a dot() precise.)
vec3 vector_to_mesh(Instance i, vec3 v) {
    precise vec3 x = i.to_mesh[0] * v, y = i.to_mesh[1] * v, z = i.to_mesh[2] * v;
    precise vec3 sum = vec3(x.x + x.y + x.z, y.x + y.y + y.z, z.x + z.y + z.z);
    return sum;
}

// The ray in the mesh's space, with the same t.
Ray ray_to_mesh(Instance i, Ray ray) {
    precise vec3 from_centre = ray.o - i.centre;
    return Ray(vector_to_mesh(i, from_centre), vector_to_mesh(i, ray.d));
}

// The determinant of to_mesh; negative if the instance is mirrored.
float instance_determinant(Instance i) {
    return dot(i.to_mesh[0], cross(i.to_mesh[1], i.to_mesh[2]));
}

// A vector of the mesh's space in the frame of the scene: by Cramer's rule, since there is no room for the inverse in
// the record. host/gpu_scene/instancing.cpp bounds its rounding.
vec3 vector_to_scene(Instance i, vec3 v) {
    return (v.x * cross(i.to_mesh[1], i.to_mesh[2]) + v.y * cross(i.to_mesh[2], i.to_mesh[0]) +
            v.z * cross(i.to_mesh[0], i.to_mesh[1])) /
           instance_determinant(i);
}

// A normal of the mesh's space in the frame of the scene, on the same side of the surface. A distance from the surface
// along the unit normal n, divided by the length of the result, is the distance there.
vec3 normal_to_scene(Instance i, vec3 n) {
    return n.x * i.to_mesh[0] + n.y * i.to_mesh[1] + n.z * i.to_mesh[2];
}

#endif
