// A lit point: the inputs of the choice of a light.
#ifndef LIGHT_LIT_POINT_GLSL
#define LIGHT_LIT_POINT_GLSL

// In the frame of the scene.
struct LitPoint {
    vec3 p;           // Where rays to the lights begin.
    vec3 n;           // Unit normal on the viewer's side: lights below its horizon do not light that side.
    bool both_sides;  // Light from either side of n is scattered.
    bool any_normal;  // Light from all directions is scattered equally, and n is 0.
    uint groups;      // How the choice is divided between the tree and the lights far away: light_set_groups.
};

// A point on a surface with that horizon.
LitPoint lit_on_surface(vec3 p, vec3 horizon, bool both_sides) {
    return LitPoint(p, horizon, both_sides, false, 0u);
}

// A point without a normal, as within a medium.
LitPoint lit_anywhere(vec3 p) {
    return LitPoint(p, vec3(0.0), true, true, 0u);
}

#endif
