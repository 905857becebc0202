// The renderer's kernel for scenes with principled materials: drivers take twice as long over it, even where constants
// remove the code.
#version 460
#extension GL_GOOGLE_include_directive : require

#define LAYERED 1
#include "kernels/render.glsl"

void main() {
    render_main();
}
