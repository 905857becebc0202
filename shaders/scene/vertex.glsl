// A vertex of a path: on a surface, or at a point within a medium, which has no normal.
#ifndef SCENE_VERTEX_GLSL
#define SCENE_VERTEX_GLSL

#include "scene/smooth.glsl"

// In the frame of the scene.
struct Vertex {
    vec3 p;
    vec3 n;       // Geometric normal on the viewer's side, unit; 0 if there is none.
    float error;  // Distance from p, along n, at which rays must begin.
    vec3 lift;    // From p to where light that stays on the viewer's side begins: see scene/smooth.glsl.
};

// The origin of a ray that leaves the vertex on the viewer's side, or on the other.
vec3 vertex_spawn_origin(Vertex v, bool viewers_side) {
    if (SMOOTH && viewers_side) return (v.p + v.lift) + v.error * v.n;
    return v.p + (viewers_side ? v.error : -v.error) * v.n;
}

#endif
