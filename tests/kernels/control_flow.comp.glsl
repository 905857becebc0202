// For vk/live_code_test.cpp: what control_flow.h makes of the numbers 0 to 63, for each of its 9 functions.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;

layout(constant_id = 0) const bool A = true;
layout(constant_id = 1) const bool B = true;
layout(constant_id = 2) const uint N = 1u;

layout(set = 0, binding = 0, std430) writeonly buffer Results {
    uint results[];
};

#include "control_flow.h"

void main() {
    uint i = gl_LocalInvocationIndex;
    for (uint which = 0u; which < 9u; ++which)
        results[64u * which + i] = control_flow(which, i);
}
