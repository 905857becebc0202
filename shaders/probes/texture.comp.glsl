// For selftest/textures.h: item (texture; uv). The texture there, and the number from its channel.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 1u
#define RESULT_WORDS 5u
#include "probes/items.glsl"
#include "scene/texture.glsl"

void main() {
    if (past_end()) return;
    TextureRecord t = scene_texture(item(0u).x);
    vec4 value = texture_at(t, item_floats(0u).yz);
    put(value.rgb);
    put(value.a);
    put(texture_number(t, item_floats(0u).yz));
}
