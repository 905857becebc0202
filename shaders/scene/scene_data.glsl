// The only file that declares the buffers of a scene. Every record is read through one function here.
//
// Two ways to the same words of an array: a texel buffer, which old software drivers read four times faster, and a
// storage buffer, where it has more words than a device's texel buffers may hold.
#ifndef SCENE_SCENE_DATA_GLSL
#define SCENE_SCENE_DATA_GLSL

#include "shared/bvh_node.h"
#include "shared/constants.h"
#include "shared/light.h"
#include "shared/material.h"
#include "shared/parameters.h"
#include "shared/primitive.h"

layout(constant_id = CONSTANT_STORAGE_ARRAYS) const uint STORAGE_ARRAYS = 0u;

layout(binding = BINDING_NODES) uniform usamplerBuffer node_texels;
layout(binding = BINDING_PRIMITIVES) uniform usamplerBuffer primitive_texels;
layout(binding = BINDING_TABLES) uniform usamplerBuffer table_texels;
layout(std430, binding = BINDING_STORAGE + BINDING_NODES) readonly buffer NodesBlock { uvec4 node_words[]; };
layout(std430, binding = BINDING_STORAGE + BINDING_PRIMITIVES) readonly buffer PrimitivesBlock {
    uvec4 primitive_words[];
};
layout(std430, binding = BINDING_STORAGE + BINDING_TABLES) readonly buffer TablesBlock { uvec4 table_words[]; };

// Word i of an array.
#define SCENE_ARRAY(name, number, texels, words)                      \
    uvec4 name(uint i) {                                              \
        if ((STORAGE_ARRAYS & (1u << number)) != 0u) return words[i]; \
        return texelFetch(texels, int(i));                            \
    }
SCENE_ARRAY(nodes, BINDING_NODES, node_texels, node_words)
SCENE_ARRAY(primitives, BINDING_PRIMITIVES, primitive_texels, primitive_words)
SCENE_ARRAY(tables, BINDING_TABLES, table_texels, table_words)

layout(std140, binding = BINDING_PARAMETERS) uniform ParametersBlock { uvec4 parameter_words[PARAMETERS_WORDS]; };

Parameters scene_parameters() {
    return parameters_unpack(parameter_words);
}

BvhNode scene_node(uint i) {
    i *= BVH_NODE_WORDS;
    return bvh_node_unpack(nodes(i), nodes(i + 1u), nodes(i + 2u), nodes(i + 3u));
}

// Primitive at that position in leaf order.
Primitive scene_primitive(uint i) {
    i *= PRIMITIVE_WORDS;
    return primitive_unpack(primitives(i), primitives(i + 1u), primitives(i + 2u));
}

// Surface of the primitive at that position in leaf order.
Surface scene_surface(uint i) {
    return surface_unpack(tables(scene_parameters().tables.surfaces + i * SURFACE_WORDS));
}

// Shading normals of the triangles at that position in leaf order, at each vertex; zeros unless they are smooth.
uvec4 scene_normals(uint i) {
    return tables(scene_parameters().tables.normals + i * NORMALS_WORDS);
}

MaterialRecord scene_material(uint i) {
    i = scene_parameters().tables.materials + i * MATERIAL_WORDS;
    return material_unpack(tables(i), tables(i + 1u));
}

Light scene_light(uint i) {
    i = scene_parameters().tables.lights + i * LIGHT_WORDS;
    return light_unpack(tables(i), tables(i + 1u), tables(i + 2u), tables(i + 3u));
}

// Entry of the alias table that chooses lights.
AliasEntry scene_light_alias(uint i) {
    return alias_unpack(tables(scene_parameters().tables.light_alias + i / 2u), i);
}

// Texel of the environment, row-major from the top.
EnvironmentTexel scene_environment_texel(uint i) {
    return environment_texel_unpack(tables(scene_parameters().tables.environment + i * ENVIRONMENT_TEXEL_WORDS));
}

// Entry of the alias table that chooses texels of the environment.
AliasEntry scene_environment_alias(uint i) {
    return alias_unpack(tables(scene_parameters().tables.environment_alias + i / 2u), i);
}

#endif
