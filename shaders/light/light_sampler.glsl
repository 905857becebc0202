// A point on a light that is chosen for a lit point; one line per kind of light.
#ifndef LIGHT_LIGHT_SAMPLER_GLSL
#define LIGHT_LIGHT_SAMPLER_GLSL

#include "base/sampler.glsl"
#include "light/area.glsl"
#include "light/choice.glsl"
#include "light/directional.glsl"
#include "light/environment.glsl"
#include "light/point.glsl"
#include "light/sphere.glsl"
#include "light/spot.glsl"
#include "scene/material.glsl"

// The attributes of light i at surface coordinates b; on a sphere, at the unit normal n.
Attributes light_attributes(uint i, LightRecord l, vec2 b, vec3 n) {
    AttributePlace place = AttributePlace(scene_light_textures(i).primitive, false, b, is_sphere(l), n);
    if (is_light(l, LIGHT_PARALLELOGRAM)) {
        // Its triangles are a b c and a c d.
        place.second = b.y > b.x;
        place.b = place.second ? vec2(b.x, b.y - b.x) : vec2(b.x - b.y, b.y);
    }
    return attributes_at(place);
}

// Light i of a lamp, or of none (NO_LIGHT), as seen from that point in the frame of the scene.
LightRecord light_seen(uint i, uint lamp, LitPoint lit) {
    LightRecord l = light_at(i);
    return is_lamp(lamp) ? lamp_light_in_scene(l, scene_lamp(lamp), lit.p) : l;
}

// The attributes of the light's surface at a sample for that point; only if it has one.
Attributes light_sample_attributes(LightSample s, LitPoint lit) {
    LightRecord l = light_at(s.light);
    vec3 n = (lit.p + s.shadow - l.p) / l.e1.x;
    vec2 b = area_light_coordinates(l, s.u);
    if (is_lamp(s.lamp) && scene_lamp(s.lamp).mirrored != 0u) b = b.yx;
    return light_attributes(s.light, l, b, n);
}

// Cosine between the ray to the sample and the normal of the light's surface there, on the visible side; only if it has
// one.
float light_sample_cosine(LightSample s, LitPoint lit) {
    LightRecord l = light_seen(s.light, s.lamp, lit);
    vec3 n = is_sphere(l) ? lit.p + s.shadow - l.p : cross(l.e1, l.e2);
    return abs(dot(s.wi, normalize(n)));
}

// Multiplies a sample by the factors of its surface there.
void light_apply_textures(inout LightSample s, LitPoint lit) {
    Attributes at = light_sample_attributes(s, lit);
    s.Li *= light_texture(s.light, at);
    if ((TEXTURED & TEXTURED_OPACITY) != 0u) s.Li *= material_opacity(scene_light_textures(s.light).material, at);
}

// A sample of a point on one of the lights, from 3 x 32 random bits: u.xy chooses the point, u.z the light. The scene
// has at least one light; light_prepare comes first.
LightSample light_sample_li(LitPoint lit, uvec3 u) {
    uint more = LIGHT_SAMPLER == LIGHT_SAMPLER_TREE || HAS_LAMPS ? hash_pcg3d(u).x : 0u;
    LightChoice choice = light_choose(lit, uvec2(u.z, more));
    LightRecord l = light_seen(choice.i, choice.lamp, lit);
    LightSample s;
    if (is_light(l, LIGHT_ENVIRONMENT)) {
        s = environment_light_sample_li(u.xy);
    } else if (is_sphere(l)) {
        s = sphere_light_sample_li(l, lit.p, unit_float(u.xy));
    } else if (is_light(l, LIGHT_POINT)) {
        s = point_light_sample_li(l, lit.p);
    } else if (is_light(l, LIGHT_SPOT)) {
        s = spot_light_sample_li(l, lit.p);
    } else if (is_light(l, LIGHT_DIRECTIONAL)) {
        s = directional_light_sample_li(l);
    } else if (is_light(l, LIGHT_SUN)) {
        s = sun_light_sample_li(l, unit_float(u.xy));
    } else {
        s = area_light_sample_li(l, lit.p, unit_float(u.xy));
    }
    s.pdf *= choice.pmf;
    s.light = choice.i;
    s.lamp = choice.lamp;
    s.u = unit_float(u.xy);
    if ((TEXTURED & (TEXTURED_EMISSION | TEXTURED_OPACITY)) != 0u && light_has_surface(l)) {
        light_apply_textures(s, lit);
    }
    return s;
}

// Density [1/sr] with which light_sample_li finds, for a lit point, the point of light i, of a lamp or of none
// (NO_LIGHT), at that squared distance [m^2] whose normal has the cosine cos_light to the ray; only of lights with a
// surface.
float light_pdf_li(uint i, uint lamp, LitPoint lit, float distance_squared, float cos_light, bool front) {
    LightRecord l = light_at(i);
    if (is_lamp(lamp)) l.pdf_area /= scene_lamp(lamp).area;
    float pdf = is_sphere(l) ? sphere_light_pdf_li(l, lit.p, distance_squared, cos_light, front)
                             : area_light_pdf_li(l, distance_squared, cos_light);
    return light_pmf(i, lamp, lit) * pdf;
}

// Density [1/sr] with which light_sample_li finds a direction to that texel of the environment; 0 if the environment is
// not one of the lights.
float environment_pdf_li(EnvironmentTexel texel, LitPoint lit) {
    if (!SKY_IS_LIGHT) return 0.0;
    return sky_pmf(lit) * texel.pdf;
}

// The same of sun i, of that record, and one of its directions.
float sun_pdf_li(uint i, LightRecord l, LitPoint lit) {
    return sun_pmf(i, lit) * warp_cone_pdf(l.e2.x);
}

#endif
