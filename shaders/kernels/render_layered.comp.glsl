// The renderer's kernel for scenes with principled materials: drivers need twice as long to compile it, even if
// constants remove the code.
#version 460
#extension GL_GOOGLE_include_directive : require

#define LAYERED 1
#include "kernels/render.glsl"

void main() {
    render_main();
}
