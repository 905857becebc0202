// See rasterise.h.
#include "window/rasterise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <imgui.h>

namespace candela {
namespace {

struct Texture {
    const unsigned char* alpha;
    uvec2 size;

    // Alpha in [0, 1].
    float at(vec2 uv) const {
        const vec2 texel = clamp(uv * vec2(size), vec2(0.0f), vec2(size) - 1.0f);
        return float(alpha[size_t(texel.y) * size.x + size_t(texel.x)]) / 255.0f;
    }
};

struct Vertex {
    vec2 position;  // In the window [pixels].
    vec2 uv;
    vec4 colour;  // sRGB codes and alpha in [0, 1], not premultiplied.
};

// Whole pixels, x1 and y1 exclusive.
struct Bounds {
    int x0, y0, x1, y1;
};

Bounds intersection(Bounds a, Bounds b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

vec4 unpack(uint32_t word) {
    return vec4(word & 255u, word >> 8 & 255u, word >> 16 & 255u, word >> 24) / 255.0f;
}

uint32_t pack(vec4 colour) {
    const uvec4 codes(colour * 255.0f + 0.5f);
    return codes.x | codes.y << 8 | codes.z << 16 | codes.w << 24;
}

class Canvas {
  public:
    Canvas(Overlay& overlay, Texture texture)
        : overlay_(overlay),
          texture_(texture),
          bounds_{int(overlay.rect.x0), int(overlay.rect.y0), int(overlay.rect.x1), int(overlay.rect.y1)} {}

    void triangle(std::array<Vertex, 3> v, Bounds clip);

  private:
    void blend(int x, int y, vec4 colour);

    Overlay& overlay_;
    Texture texture_;
    Bounds bounds_;
};

float cross2(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}

// Blends a colour that is not premultiplied over a pixel.
void Canvas::blend(int x, int y, vec4 colour) {
    const size_t row = size_t(y - bounds_.y0);
    uint32_t& word = overlay_.pixels[row * size_t(bounds_.x1 - bounds_.x0) + size_t(x - bounds_.x0)];
    const vec4 above(vec3(colour.x, colour.y, colour.z) * colour.w, colour.w);
    word = pack(above + (1.0f - colour.w) * unpack(word));
}

// Colours the pixels whose centres lie inside. A centre on an edge that two triangles share belongs to only
// one of them, so that nothing translucent is blended over a pixel twice.
void Canvas::triangle(std::array<Vertex, 3> v, Bounds clip) {
    float area = cross2(v[1].position - v[0].position, v[2].position - v[0].position);
    if (area == 0.0f) return;
    if (area < 0.0f) {
        std::swap(v[1], v[2]);
        area = -area;
    }
    const vec2 lo = min(v[0].position, min(v[1].position, v[2].position));
    const vec2 hi = max(v[0].position, max(v[1].position, v[2].position));
    const Bounds box = intersection(
        intersection(clip, bounds_),
        {int(std::floor(lo.x)), int(std::floor(lo.y)), int(std::ceil(hi.x)), int(std::ceil(hi.y))});
    std::array<vec2, 3> edge;
    std::array<bool, 3> owns_edge;
    for (size_t i = 0; i < 3; ++i) {
        edge[i] = v[(i + 2) % 3].position - v[(i + 1) % 3].position;
        owns_edge[i] = edge[i].y < 0.0f || (edge[i].y == 0.0f && edge[i].x > 0.0f);
    }
    const bool plain =
        v[0].uv == v[1].uv && v[0].uv == v[2].uv && v[0].colour == v[1].colour && v[0].colour == v[2].colour;
    vec4 colour = v[0].colour;
    if (plain) colour.w *= texture_.at(v[0].uv);

    for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) {
            const vec2 p(float(x) + 0.5f, float(y) + 0.5f);
            std::array<float, 3> weight;
            bool inside = true;
            for (size_t i = 0; i < 3; ++i) {
                weight[i] = cross2(edge[i], p - v[(i + 1) % 3].position);
                inside = inside && (weight[i] > 0.0f || (weight[i] == 0.0f && owns_edge[i]));
            }
            if (!inside) continue;
            if (!plain) {
                vec2 uv(0.0f);
                colour = vec4(0.0f);
                for (size_t i = 0; i < 3; ++i) {
                    uv += weight[i] / area * v[i].uv;
                    colour += weight[i] / area * v[i].colour;
                }
                colour.w *= texture_.at(uv);
            }
            blend(x, y, colour);
        }
    }
}

// From Dear ImGui's coordinates to pixels of the window.
struct Place {
    vec2 origin;
    vec2 scale;

    vec2 operator()(float x, float y) const { return (vec2(x, y) - origin) * scale; }
};

Vertex vertex(const ImDrawVert& from, const Place& place) {
    return {place(from.pos.x, from.pos.y), vec2(from.uv.x, from.uv.y), unpack(from.col)};
}

// The smallest rectangle of the window that holds all vertices.
PixelRect covered(const ImDrawData& data, const Place& place, uvec2 size) {
    vec2 lo{size};
    vec2 hi(0.0f);
    for (int i = 0; i < data.CmdListsCount; ++i) {
        for (const ImDrawVert& v : data.CmdLists[i]->VtxBuffer) {
            lo = min(lo, place(v.pos.x, v.pos.y));
            hi = max(hi, place(v.pos.x, v.pos.y));
        }
    }
    const uvec2 first(clamp(floor(lo), vec2(0.0f), vec2(size)));
    const uvec2 last(clamp(ceil(hi), vec2(first), vec2(size)));
    return {first.x, first.y, last.x, last.y};
}

}  // namespace

void rasterise(const ImDrawData& data, const unsigned char* alpha, uvec2 texture_size, uvec2 size,
               Overlay& overlay) {
    const Place place{vec2(data.DisplayPos.x, data.DisplayPos.y),
                      vec2(data.FramebufferScale.x, data.FramebufferScale.y)};
    overlay.rect = covered(data, place, size);
    overlay.pixels.assign(size_t(overlay.rect.width()) * overlay.rect.height(), 0u);
    Canvas canvas(overlay, {alpha, texture_size});
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const vec2 lo = place(command.ClipRect.x, command.ClipRect.y);
            const vec2 hi = place(command.ClipRect.z, command.ClipRect.w);
            const Bounds clip{int(lo.x), int(lo.y), int(hi.x), int(hi.y)};
            for (unsigned at = command.IdxOffset; at < command.IdxOffset + command.ElemCount; at += 3) {
                std::array<Vertex, 3> corners;
                for (unsigned k = 0; k < 3; ++k) {
                    const int index = int(command.VtxOffset + list.IdxBuffer[int(at + k)]);
                    corners[k] = vertex(list.VtxBuffer[index], place);
                }
                canvas.triangle(corners, clip);
            }
        }
    }
}

}  // namespace candela
