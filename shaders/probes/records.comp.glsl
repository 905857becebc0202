// For selftest/records.h: reads the second record of every kind and writes its fields, in the order of the struct.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 1u
#define RESULT_WORDS 269u
#include "probes/items.glsl"
#include "scene/scene_data.glsl"

void put_parameters(Parameters p) {
    put(p.position);
    put(p.right);
    put(p.up);
    put(p.forward);
    put(p.full_size);
    put(p.principal_point);
    put(p.crop);
    put(p.seed);
    put(p.max_depth);
    put(p.rr_depth);
    put(p.lights.placed);
    put(p.lights.suns);
    put(p.lights.sun_fraction);
    put(p.lights.sky_fraction);
    put(p.lights.sun_flux);
    put(p.lights.sky_flux);
    put(p.environment_size);
    put(p.environment_turn);
    put(p.lens_x);
    put(p.lens_y);
    put(p.focal_distance);
    put(p.blades);
    put(p.first_sample);
    put(p.camera_media);
    put(p.fisheye_edge);
}

void put_node(uint i) {
    NodeWords w = scene_node_words(i);
    BvhNode node = bvh_node_unpack(w.a, w.b, w.c, w.d);
    put(node.origin);
    put(node.scale);
    put(node.q_lo[0]);
    put(node.q_lo[1]);
    put(node.q_hi[0]);
    put(node.q_hi[1]);
    put(node.children);
}

void put_primitive(Primitive p) {
    put(p.kind);
    put(p.a);
    put(p.b);
    put(p.c);
    if (p.kind == PRIMITIVE_TRIANGLES) put(p.d);
}

void put_surface(Surface s) {
    put(s.id);
    put(s.material);
    put(s.has_normals);
    put(s.light);
    put(s.error);
    put(s.passable);
}

void put_material(MaterialRecord m) {
    put(m.model);
    put(m.medium);
    put(m.base);
    put(m.specular);
    put(m.parameter);
}

void put_medium(MediumRecord m) {
    put(m.absorption);
    put(m.ior);
    put(m.scattering);
    put(m.g);
}

void put_light(LightRecord l) {
    put(l.kind);
    put(l.p);
    put(l.e1);
    put(l.e2);
    put(l.radiance);
    put(l.spread);
    put(l.two_sided);
    put(l.pdf_area);
    put(l.pmf);
    put(l.error);
}

void put_lamp(LampRecord l) {
    put(l.node);
    put(l.root);
    put(l.first);
    put(l.count);
    put(l.alias);
    put(l.mirrored);
    put(l.area);
    put(l.pmf);
}

void put_alias_entry(AliasEntry e) {
    put(e.threshold);
    put(e.alias);
}

void put_cdf_entry(CdfEntry e) {
    put(e.last_word);
    put(e.range);
}

void put_light_tree(LightTreeChild c) {
    put(c.centre);
    put(c.radius);
    put(c.strength);
    put(c.axis);
    put(c.cone);
    put(c.at);
}

void put_texel(EnvironmentTexel t) {
    put(t.radiance);
    put(t.pdf);
}

void put_material_textures(MaterialTextures t) {
    put(t.base);
    put(t.specular);
    put(t.parameter);
    put(t.normal);
    put(t.bump);
    put(t.normal_scale);
    put(t.opacity_texture);
    put(t.opacity);
    put(t.cutoff);
    put(t.vertex_colors);
    put(t.culled);
    put(t.catcher);
    put(t.hidden);
}

void put_principled(PrincipledRecord p) {
#define FLOAT(name, word, place) put(p.name);
#define VEC2(name, word) put(p.name);
#define VEC3(name, word) put(p.name);
#define UINT(name, word, place) put(p.name);
#include "shared/principled_record.inc"
}

void put_texture(TextureRecord t) {
    put(t.first);
    put(t.size);
    put(t.traits);
    put(t.row_u);
    put(t.row_v);
}

void put_attributes(uint primitive, const uint first) {
    uvec4 ab, cd;
    scene_attributes(primitive, first, ab, cd);
    put(ab);
    put(cd);
}

void main() {
    if (past_end()) return;
    put_parameters(scene_parameters());
    put_node(1u);
    put_primitive(scene_primitive(1u));
    put_primitive(scene_primitive(2u));
    put_surface(scene_surface(1u));
    put(scene_normals(1u));
    put_material(scene_material(1u));
    put_medium(scene_medium(1u));
    put_light(scene_light(1u));
    put_lamp(scene_lamp(2u));
    put_alias_entry(scene_light_alias(2u));
    put_alias_entry(scene_light_alias(3u));
    put_light_tree(scene_light_tree(0u, 1u));
    for (uint i = 4u; i < 8u; ++i)
        put(scene_light_trail(i));
    put_texel(scene_environment_texel(1u));
    put_cdf_entry(scene_environment_cdf(2u));
    put_cdf_entry(scene_environment_cdf(3u));
    put_material_textures(scene_material_textures(1u));
    LightTextures light_textures = scene_light_textures(1u);
    put(uvec3(light_textures.primitive, light_textures.emission, light_textures.material));
    put_texture(scene_texture(1u));
    put(scene_texels(1u));
    put_attributes(1u, 0u);
    put_attributes(1u, UV1_WORD);
    put_attributes(1u, COLOR_WORD);
    put(scene_tangents(1u));
    // Behind two records of materials, the second record and its image.
    const uint first = 2u * MATERIAL_WORDS + PRINCIPLED_WORDS;
    put_principled(scene_principled(first));
    PrincipledImage image = scene_principled_image(first + PRINCIPLED_WORDS);
    put(image.texture);
    put(image.values);
    put(image.channels);
}
