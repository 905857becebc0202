// Tests the triangles of a tiny scene one by one.
//
// If all lanes run in step, as on software Vulkan, testing all of a few primitives is faster than finding the right
// ones in a tree, since no lane waits for another. The vertices are read once and stay in registers, or wherever the
// driver puts so many. A ray's values at a vertex are computed once for all primitives that share it.
#ifndef SCENE_LIST_GLSL
#define SCENE_LIST_GLSL
#extension GL_EXT_control_flow_attributes : require

#include "scene/primitive.glsl"
#include "scene/scene_data.glsl"

vec3 list_vertices[4u * LIST_MAX];

// Must run before an invocation's first ray.
void list_prepare() {
    [[unroll]] for (int i = 0; i < int(LIST); ++i) {
        Primitive p = scene_primitive(uint(i));
        list_vertices[4 * i] = p.a;
        list_vertices[4 * i + 1] = p.b;
        list_vertices[4 * i + 2] = p.c;
        list_vertices[4 * i + 3] = p.d;
    }
}

// Replaces `hit` with the nearest hit of all primitives if that is nearer.
void list_intersect(Ray ray, RayShear shear, inout Hit hit) {
    uint corners[LIST_MAX] =
        uint[](LIST_CORNERS_0, LIST_CORNERS_1, LIST_CORNERS_2, LIST_CORNERS_3, LIST_CORNERS_4, LIST_CORNERS_5,
               LIST_CORNERS_6, LIST_CORNERS_7, LIST_CORNERS_8, LIST_CORNERS_9, LIST_CORNERS_10, LIST_CORNERS_11,
               LIST_CORNERS_12, LIST_CORNERS_13, LIST_CORNERS_14, LIST_CORNERS_15);
    ShearedVertex v[4u * LIST_MAX];
    [[unroll]] for (int i = 0; i < int(LIST); ++i) {
        [[unroll]] for (int k = 0; k < 4; ++k) {
            int corner = 4 * i + k;
            int first = int(corners[i] >> 8 * k & 255u);
            if (first == corner) {
                v[corner] = shear_vertex(ray, shear, list_vertices[corner]);
            } else {
                v[corner] = v[first];
            }
        }
        TrianglesHit found = triangles_intersect(shear, v[4 * i], v[4 * i + 1], v[4 * i + 2], v[4 * i + 3]);
        if (found.t > 0.0 && found.t < hit.t) hit = triangles_hit(found, uint(i), NO_INSTANCE);
    }
}

#endif
