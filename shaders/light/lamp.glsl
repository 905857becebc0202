// Lamps: instances of a mesh that emits. What they share lies in the mesh's space, so the lit point goes there to
// choose one of their lights, and the light chosen comes to the frame of the scene.
#ifndef LIGHT_LAMP_GLSL
#define LIGHT_LAMP_GLSL

#include "light/lit_point.glsl"
#include "scene/instance.glsl"

// Whether that is a lamp's place in the table of lights, and not NO_LIGHT.
bool is_lamp(uint lamp) {
    return HAS_LAMPS && lamp != NO_LIGHT;
}

// The lit point in the space of the lamp's mesh.
LitPoint lit_in_lamp(LitPoint lit, LampRecord lamp) {
    Instance i = scene_instance(lamp.node);
    lit.p = vector_to_mesh(i, lit.p - i.centre);
    if (!lit.any_normal) lit.n = normalize(vector_to_mesh(i, lit.n));
    return lit;
}

// One of the lamp's lights, as seen from p_lit in the frame of the scene. It is in the frame of the scene, except for
// its pmf. If the lamp is mirrored, e1 and e2 have changed places, so that the front stays the front.
LightRecord lamp_light_in_scene(LightRecord l, LampRecord lamp, vec3 p_lit) {
    Instance i = scene_instance(lamp.node);
    l.p = i.centre + vector_to_scene(i, l.p);
    vec3 e1 = vector_to_scene(i, l.e1), e2 = vector_to_scene(i, l.e2);
    l.e1 = lamp.mirrored != 0u ? e2 : e1;
    l.e2 = lamp.mirrored != 0u ? e1 : e2;
    l.error = sqrt(lamp.area) * l.error + i.error + INSTANCE_RAY_ERROR * distance(p_lit, i.centre);
    l.pdf_area /= lamp.area;
    return l;
}

#endif
