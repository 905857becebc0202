// Local frames: z is the normal, so that cos(theta) = w.z.
#ifndef BASE_FRAME_GLSL
#define BASE_FRAME_GLSL

struct Frame {
    vec3 x;
    vec3 y;
    vec3 z;
};

// An orthonormal right-handed frame around the unit vector z, without branches.
// Ref: Duff et al. 2017, Building an Orthonormal Basis, Revisited, listing 3.
Frame frame_from_z(vec3 z) {
    float s = z.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + z.z);
    float b = z.x * z.y * a;
    return Frame(vec3(1.0 + s * z.x * z.x * a, s * b, -s * z.x), vec3(b, s + z.y * z.y * a, -z.y), z);
}

vec3 frame_to_local(Frame f, vec3 v) {
    return vec3(dot(v, f.x), dot(v, f.y), dot(v, f.z));
}

vec3 frame_to_world(Frame f, vec3 v) {
    return v.x * f.x + v.y * f.y + v.z * f.z;
}

#endif
