// For math_test.cpp: the frame around z, and a vector transformed into it and back.
#version 460
#extension GL_GOOGLE_include_directive : require

#define ITEM_WORDS 2u
#define RESULT_WORDS 15u
#include "base/frame.glsl"
#include "probes/items.glsl"

void main() {
    if (past_end()) return;
    Frame frame = frame_from_z(item_floats(0u).xyz);
    vec3 local = frame_to_local(frame, item_floats(1u).xyz);
    put(frame.x);
    put(frame.y);
    put(frame.z);
    put(local);
    put(frame_to_world(frame, local));
}
