// Colours.
#ifndef BASE_COLOR_GLSL
#define BASE_COLOR_GLSL

// Luminance of a linear Rec.709 colour.
float luminance(vec3 rgb) {
    return dot(rgb, vec3(0.2126, 0.7152, 0.0722));
}

#endif
