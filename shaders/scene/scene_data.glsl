// The only file that declares the buffers of a scene. Every record is read through one function here.
//
// Two ways to the same words of an array: a texel buffer, which old software drivers read four times faster, and a
// storage buffer, where it has more words than a device's texel buffers may hold.
#ifndef SCENE_SCENE_DATA_GLSL
#define SCENE_SCENE_DATA_GLSL

#include "shared/bvh_node.h"
#include "shared/constants.h"
#include "shared/kernel_constants.h"
#include "shared/light.h"
#include "shared/material.h"
#include "shared/parameters.h"
#include "shared/primitive.h"

layout(binding = BINDING_NODES) uniform usamplerBuffer node_texels;
layout(binding = BINDING_PRIMITIVES) uniform usamplerBuffer primitive_texels;
layout(binding = BINDING_TABLES) uniform usamplerBuffer table_texels;
layout(std430, binding = BINDING_STORAGE + BINDING_NODES) readonly buffer NodesBlock { uvec4 node_words[]; };
layout(std430, binding = BINDING_STORAGE + BINDING_PRIMITIVES) readonly buffer PrimitivesBlock {
    uvec4 primitive_words[];
};
layout(std430, binding = BINDING_STORAGE + BINDING_TABLES) readonly buffer TablesBlock { uvec4 table_words[]; };

// The words of an array from i on: one, or as many as there are names to read into. One branch for all of them, since
// not every driver removes the code of the other side before it compiles it.
#define IS_STORAGE(number) ((STORAGE_ARRAYS & (1u << number)) != 0u)

void nodes(uint i, out uvec4 a, out uvec4 b, out uvec4 c, out uvec4 d) {
    if (IS_STORAGE(BINDING_NODES)) {
        a = node_words[i], b = node_words[i + 1u], c = node_words[i + 2u], d = node_words[i + 3u];
    } else {
        a = texelFetch(node_texels, int(i)), b = texelFetch(node_texels, int(i + 1u));
        c = texelFetch(node_texels, int(i + 2u)), d = texelFetch(node_texels, int(i + 3u));
    }
}

void primitives(uint i, out uvec4 a, out uvec4 b, out uvec4 c) {
    if (IS_STORAGE(BINDING_PRIMITIVES)) {
        a = primitive_words[i], b = primitive_words[i + 1u], c = primitive_words[i + 2u];
    } else {
        a = texelFetch(primitive_texels, int(i)), b = texelFetch(primitive_texels, int(i + 1u));
        c = texelFetch(primitive_texels, int(i + 2u));
    }
}

uvec4 tables(uint i) {
    uvec4 a;
    if (IS_STORAGE(BINDING_TABLES)) {
        a = table_words[i];
    } else {
        a = texelFetch(table_texels, int(i));
    }
    return a;
}

void tables(uint i, out uvec4 a, out uvec4 b) {
    if (IS_STORAGE(BINDING_TABLES)) {
        a = table_words[i], b = table_words[i + 1u];
    } else {
        a = texelFetch(table_texels, int(i)), b = texelFetch(table_texels, int(i + 1u));
    }
}

void tables(uint i, out uvec4 a, out uvec4 b, out uvec4 c, out uvec4 d) {
    if (IS_STORAGE(BINDING_TABLES)) {
        a = table_words[i], b = table_words[i + 1u], c = table_words[i + 2u], d = table_words[i + 3u];
    } else {
        a = texelFetch(table_texels, int(i)), b = texelFetch(table_texels, int(i + 1u));
        c = texelFetch(table_texels, int(i + 2u)), d = texelFetch(table_texels, int(i + 3u));
    }
}

layout(std140, binding = BINDING_PARAMETERS) uniform ParametersBlock { uvec4 parameter_words[PARAMETERS_WORDS]; };

Parameters scene_parameters() {
    return parameters_unpack(parameter_words);
}

BvhNode scene_node(uint i) {
    uvec4 a, b, c, d;
    nodes(i * BVH_NODE_WORDS, a, b, c, d);
    return bvh_node_unpack(a, b, c, d);
}

// Primitive at that position in leaf order.
Primitive scene_primitive(uint i) {
    uvec4 a, b, c;
    primitives(i * PRIMITIVE_WORDS, a, b, c);
    return primitive_unpack(a, b, c);
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
    uvec4 a, b;
    tables(scene_parameters().tables.materials + i * MATERIAL_WORDS, a, b);
    return material_unpack(a, b);
}

Light scene_light(uint i) {
    uvec4 a, b, c, d;
    tables(scene_parameters().tables.lights + i * LIGHT_WORDS, a, b, c, d);
    return light_unpack(a, b, c, d);
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
