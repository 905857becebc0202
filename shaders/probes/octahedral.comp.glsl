// For selftest/records.h: decodes octahedral normals.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 1u
#define RESULT_WORDS 3u
#include "probes/items.glsl"
#include "shared/primitive.h"

void main() {
    if (past_end()) return;
    put(octahedral_unpack(item(0u).x));
}
