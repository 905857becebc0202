// Colours.
#ifndef BASE_COLOR_GLSL
#define BASE_COLOR_GLSL

// Weights of linear Rec.709 channels in luminance.
const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);

float luminance(vec3 rgb) {
    return dot(rgb, LUMINANCE);
}

#endif
