// The only file that declares the buffers of a scene. Every record is read through one function here.
//
// Each buffer holds one array or several. It is a texel buffer, which old software drivers read four times faster, or
// lies in a storage buffer if it has more words than a device's texel buffers may hold. shared/scene_arrays.h has the
// arrays and says which of the two a kernel reads.
#ifndef SCENE_SCENE_DATA_GLSL
#define SCENE_SCENE_DATA_GLSL

#include "shared/instance.h"
#include "shared/kernel_constants.h"
#include "shared/parameters.h"

const bool HAS_CATCHERS = CATCHERS == CATCHERS_SEEN;

#define BUFFER(number, name) layout(binding = number) uniform usamplerBuffer texels_##name;
#include "shared/scene_buffers.inc"
#undef BUFFER

// clang-format off
layout(std430, binding = BINDING_STORAGE) readonly buffer StorageBlock { uvec4 words[]; } storage[STORAGE_BUFFERS];
// clang-format on
layout(std140, binding = BINDING_PARAMETERS) uniform ParametersBlock {
    uvec4 parameter_words[PARAMETERS_WORDS];
    uvec4 array_starts[(ARRAY_COUNT + 3u) / 4u];  // First word of each array in its texel or storage buffer.
};

// READ_n reads n words of an array in a buffer, from word i on. There is one branch for all of them, since not every
// driver removes the dead side before it compiles. (An index must be valid even if it is never used.) The start of a
// buffer's first array, which has its name, is known unless the buffer shares its storage buffer with others.
#define TEXEL(buffer, i) texelFetch(texels_##buffer, int(i))
#define STORED(buffer, i) storage[SLOT_##buffer < STORAGE_BUFFERS ? SLOT_##buffer : 0u].words[i]
#define START(array) array_starts[ARRAY_##array / 4u][ARRAY_##array % 4u]
#define TEXEL_START(buffer, array) (ARRAY_##array == ARRAY_##buffer ? 0u : START(array))
#define STORED_START(buffer, array) \
    (ARRAY_##array == ARRAY_##buffer && SLOT_##buffer != SHARED_SLOT ? 0u : START(array))

#define READ_1(buffer, array, i, a)                \
    if (SLOT_##buffer == NO_SLOT) {                \
        uint at = TEXEL_START(buffer, array) + i;  \
        a = TEXEL(buffer, at);                     \
    } else {                                       \
        uint at = STORED_START(buffer, array) + i; \
        a = STORED(buffer, at);                    \
    }

#define READ_2(buffer, array, i, a, b)                       \
    if (SLOT_##buffer == NO_SLOT) {                          \
        uint at = TEXEL_START(buffer, array) + i;            \
        a = TEXEL(buffer, at), b = TEXEL(buffer, at + 1u);   \
    } else {                                                 \
        uint at = STORED_START(buffer, array) + i;           \
        a = STORED(buffer, at), b = STORED(buffer, at + 1u); \
    }

#define READ_3(buffer, array, i, a, b, c)                                                 \
    if (SLOT_##buffer == NO_SLOT) {                                                       \
        uint at = TEXEL_START(buffer, array) + i;                                         \
        a = TEXEL(buffer, at), b = TEXEL(buffer, at + 1u), c = TEXEL(buffer, at + 2u);    \
    } else {                                                                              \
        uint at = STORED_START(buffer, array) + i;                                        \
        a = STORED(buffer, at), b = STORED(buffer, at + 1u), c = STORED(buffer, at + 2u); \
    }

#define READ_4(buffer, array, i, a, b, c, d)                      \
    if (SLOT_##buffer == NO_SLOT) {                               \
        uint at = TEXEL_START(buffer, array) + i;                 \
        a = TEXEL(buffer, at), b = TEXEL(buffer, at + 1u);        \
        c = TEXEL(buffer, at + 2u), d = TEXEL(buffer, at + 3u);   \
    } else {                                                      \
        uint at = STORED_START(buffer, array) + i;                \
        a = STORED(buffer, at), b = STORED(buffer, at + 1u);      \
        c = STORED(buffer, at + 2u), d = STORED(buffer, at + 3u); \
    }

Parameters scene_parameters() {
    return parameters_unpack(parameter_words);
}

// The record of a node, or of an instance in its place.
struct NodeWords {
    uvec4 a, b, c, d;
};

NodeWords scene_node_words(uint i) {
    NodeWords w;
    READ_4(NODES, NODES, i * BVH_NODE_WORDS, w.a, w.b, w.c, w.d);
    return w;
}

// Instance whose record is in the place of that node.
Instance scene_instance(uint i) {
    NodeWords w = scene_node_words(i);
    return instance_unpack(w.a, w.b, w.c, w.d);
}

// Primitive at that position in leaf order.
Primitive scene_primitive(uint i) {
    uvec4 a, b, c;
    READ_3(PRIMITIVES, PRIMITIVES, i * PRIMITIVE_WORDS, a, b, c);
    return primitive_unpack(a, b, c);
}

// Surface of the primitive at that position in leaf order.
Surface scene_surface(uint i) {
    uvec4 a;
    READ_1(SURFACES, SURFACES, i * SURFACE_WORDS, a);
    return surface_unpack(a);
}

// Shading normals of the triangles at that position in leaf order, at each vertex; zeros unless they are smooth.
uvec4 scene_normals(uint i) {
    uvec4 a;
    READ_1(NORMALS, NORMALS, i * NORMALS_WORDS, a);
    return a;
}

MaterialRecord scene_material(uint i) {
    uvec4 a, b;
    READ_2(MATERIALS, MATERIALS, i * MATERIAL_WORDS, a, b);
    return material_unpack(a, b);
}

// The principled material whose record begins at that word of the materials.
PrincipledRecord scene_principled(uint first) {
    uvec4 w[PRINCIPLED_WORDS];
    READ_4(MATERIALS, MATERIALS, first, w[0], w[1], w[2], w[3]);
    READ_4(MATERIALS, MATERIALS, first + 4u, w[4], w[5], w[6], w[7]);
    READ_2(MATERIALS, MATERIALS, first + 8u, w[8], w[9]);
    return principled_unpack(w);
}

// The image at that word of the materials.
PrincipledImage scene_principled_image(uint word) {
    uvec4 a;
    READ_1(MATERIALS, MATERIALS, word, a);
    return principled_image_unpack(a);
}

MediumRecord scene_medium(uint i) {
    uvec4 a, b;
    READ_2(MATERIALS, MEDIA, (i & MAX_MEDIA - 1u) * MEDIUM_WORDS, a, b);
    return medium_unpack(a, b);
}

// Whether some light has a spread other than 0.
bool lights_spread() {
    return (LIGHTS & 1u << LIGHT_SPREAD) != 0u;
}

LightRecord scene_light(uint i) {
    uvec4 a, b, c, d;
    READ_4(LIGHTS, LIGHTS, i * LIGHT_WORDS, a, b, c, d);
    return light_unpack(a, b, c, d, lights_spread());
}

// The lamp at that place in the table of lights.
LampRecord scene_lamp(uint i) {
    uvec4 a, b, c;
    READ_3(LIGHTS, LIGHTS, i * LIGHT_WORDS, a, b, c);
    return lamp_unpack(a, b, c);
}

// Entry of the alias tables that choose lights.
AliasEntry scene_light_alias(uint i) {
    uvec4 a;
    READ_1(LIGHTS, LIGHT_ALIAS, i / 2u, a);
    return alias_unpack(a, i);
}

// Child c of a node of the trees over lights.
LightTreeChild scene_light_tree(uint node, uint c) {
    uvec4 a, b;
    READ_2(LIGHTS, LIGHT_TREE, (node * LIGHT_TREE_WIDTH + c) * LIGHT_TREE_WORDS, a, b);
    return light_tree_unpack(a, b);
}

// The strengths of its children.
vec4 scene_light_tree_strengths(uint node) {
    uvec4 a, b, c, d;
    uint first = node * LIGHT_TREE_WIDTH * LIGHT_TREE_WORDS + 1u;
    READ_1(LIGHTS, LIGHT_TREE, first, a);
    READ_1(LIGHTS, LIGHT_TREE, first + LIGHT_TREE_WORDS, b);
    READ_1(LIGHTS, LIGHT_TREE, first + 2u * LIGHT_TREE_WORDS, c);
    READ_1(LIGHTS, LIGHT_TREE, first + 3u * LIGHT_TREE_WORDS, d);
    return uintBitsToFloat(uvec4(a.x, b.x, c.x, d.x));
}

// The trail of the light at that place.
uint scene_light_trail(uint i) {
    uvec4 a;
    READ_1(LIGHTS, LIGHT_TRAILS, i / 4u, a);
    uvec2 pair = (i & 2u) == 0u ? a.xy : a.zw;
    return (i & 1u) == 0u ? pair.x : pair.y;
}

// Texel of the environment, row-major from the top.
EnvironmentTexel scene_environment_texel(uint i) {
    uvec4 a;
    READ_1(ENVIRONMENT, ENVIRONMENT, i * ENVIRONMENT_TEXEL_WORDS, a);
    return environment_texel_unpack(a);
}

// Entry of the tables that choose texels of the environment: of columns, row after row, and of rows.
CdfEntry scene_environment_cdf(uint i) {
    uvec4 a;
    READ_1(ENVIRONMENT, ENVIRONMENT_CDF, i / 2u, a);
    return cdf_unpack(a, i);
}

// The textures of the material at that place.
MaterialTextures scene_material_textures(uint i) {
    uvec4 a, b;
    READ_2(MATERIALS, MATERIAL_TEXTURES, i * MATERIAL_TEXTURES_WORDS, a, b);
    return material_textures_unpack(a, b, CATCHERS != CATCHERS_NONE, (TEXTURED & TEXTURED_HIDDEN) != 0u);
}

// The textures of the light at that place.
LightTextures scene_light_textures(uint i) {
    uvec4 a;
    READ_1(LIGHTS, LIGHT_TEXTURES, i * LIGHT_TEXTURES_WORDS, a);
    return light_textures_unpack(a);
}

TextureRecord scene_texture(uint i) {
    uvec4 a, b, c;
    READ_3(MATERIALS, TEXTURES, i * TEXTURE_WORDS, a, b, c);
    return texture_unpack(a, b, c);
}

// A word of the images' tiles.
uvec4 scene_texels(uint i) {
    uvec4 a;
    READ_1(TEXELS, TEXELS, i, a);
    return a;
}

// The number of words of a primitive in the array of attributes, and the offsets of each attribute.
const uint UV1_WORD = (ATTRIBUTES & ATTRIBUTE_UV0) != 0u ? 2u : 0u;
const uint COLOR_WORD = UV1_WORD + ((ATTRIBUTES & ATTRIBUTE_UV1) != 0u ? 2u : 0u);
const uint TANGENT_WORD = COLOR_WORD + ((ATTRIBUTES & ATTRIBUTE_COLOR) != 0u ? 2u : 0u);
const uint PRIMITIVE_ATTRIBUTE_WORDS = TANGENT_WORD + ((ATTRIBUTES & ATTRIBUTE_TANGENT) != 0u ? 1u : 0u);

// Two words of the attributes of the primitive at that position in leaf order, from word `first` on.
void scene_attributes(uint primitive, const uint first, out uvec4 ab, out uvec4 cd) {
    READ_2(ATTRIBUTES, ATTRIBUTES, primitive * PRIMITIVE_ATTRIBUTE_WORDS + first, ab, cd);
}

// The tangents of the primitive at that position in leaf order.
uvec4 scene_tangents(uint primitive) {
    uvec4 a;
    READ_1(ATTRIBUTES, ATTRIBUTES, primitive * PRIMITIVE_ATTRIBUTE_WORDS + TANGENT_WORD, a);
    return a;
}

#endif
