// The only file that declares the buffers of a scene. Every record is read through one function here.
//
// Two ways to the same words: texel buffers, which old software drivers read four times faster, and storage
// buffers, where a scene has more words than a device's texel buffers may hold.
#ifndef SCENE_SCENE_DATA_GLSL
#define SCENE_SCENE_DATA_GLSL

#include "shared/bvh_node.h"
#include "shared/constants.h"
#include "shared/light.h"
#include "shared/material.h"
#include "shared/parameters.h"
#include "shared/primitive.h"

#if SCENE_ACCESS_STORAGE
layout(std430, binding = BINDING_NODES) readonly buffer NodesBlock { uvec4 nodes[]; };
layout(std430, binding = BINDING_PRIMITIVES) readonly buffer PrimitivesBlock { uvec4 primitives[]; };
layout(std430, binding = BINDING_TABLES) readonly buffer TablesBlock { uvec4 tables[]; };
#define FETCH(buffer, i) buffer[i]
#else
layout(binding = BINDING_NODES) uniform usamplerBuffer nodes;
layout(binding = BINDING_PRIMITIVES) uniform usamplerBuffer primitives;
layout(binding = BINDING_TABLES) uniform usamplerBuffer tables;
#define FETCH(buffer, i) texelFetch(buffer, int(i))
#endif

layout(std140, binding = BINDING_PARAMETERS) uniform ParametersBlock { uvec4 parameter_words[PARAMETERS_WORDS]; };

Parameters scene_parameters() {
    return parameters_unpack(parameter_words);
}

BvhNode scene_node(uint i) {
    i *= BVH_NODE_WORDS;
    return bvh_node_unpack(FETCH(nodes, i), FETCH(nodes, i + 1u), FETCH(nodes, i + 2u), FETCH(nodes, i + 3u));
}

// Primitive at that position in leaf order.
Primitive scene_primitive(uint i) {
    i *= PRIMITIVE_WORDS;
    return primitive_unpack(FETCH(primitives, i), FETCH(primitives, i + 1u), FETCH(primitives, i + 2u));
}

// Surface of the primitive at that position in leaf order.
Surface scene_surface(uint i) {
    return surface_unpack(FETCH(tables, scene_parameters().tables.surfaces + i * SURFACE_WORDS));
}

// Shading normals of the triangles at that position in leaf order, at each vertex; zeros unless they are smooth.
uvec4 scene_normals(uint i) {
    return FETCH(tables, scene_parameters().tables.normals + i * NORMALS_WORDS);
}

MaterialRecord scene_material(uint i) {
    i = scene_parameters().tables.materials + i * MATERIAL_WORDS;
    return material_unpack(FETCH(tables, i), FETCH(tables, i + 1u));
}

Light scene_light(uint i) {
    i = scene_parameters().tables.lights + i * LIGHT_WORDS;
    return light_unpack(FETCH(tables, i), FETCH(tables, i + 1u), FETCH(tables, i + 2u), FETCH(tables, i + 3u));
}

// Entry of the alias table that chooses lights.
AliasEntry scene_light_alias(uint i) {
    return alias_unpack(FETCH(tables, scene_parameters().tables.light_alias + i / 2u), i);
}

// Texel of the environment, row-major from the top.
EnvironmentTexel scene_environment_texel(uint i) {
    return environment_texel_unpack(FETCH(tables, scene_parameters().tables.environment + i * ENVIRONMENT_TEXEL_WORDS));
}

// Entry of the alias table that chooses texels of the environment.
AliasEntry scene_environment_alias(uint i) {
    return alias_unpack(FETCH(tables, scene_parameters().tables.environment_alias + i / 2u), i);
}

#endif
