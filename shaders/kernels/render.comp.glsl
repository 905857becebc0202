// The renderer's kernel for scenes without principled materials.
#version 460
#extension GL_GOOGLE_include_directive : require

#define LAYERED 0
#include "kernels/render.glsl"

void main() {
    render_main();
}
