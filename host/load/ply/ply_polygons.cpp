// See ply_polygons.h.
#include "load/ply/ply_polygons.h"

#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/text.h"
#include "load/quote.h"

namespace candela {
namespace {

class Finisher {
  public:
    Finisher(PlyPolygons& polygons, const std::string& file) : polygons_(polygons), file_(file) {}

    void finish(std::vector<std::string>& warnings) {
        constexpr uint32_t UNUSED = UINT32_MAX;
        std::vector<uint32_t> number(polygons_.positions.size(), UNUSED);
        for (const uint32_t corner : polygons_.corners)
            number[corner] = 0;
        uint32_t used = 0;
        for (uint32_t i = 0; i < number.size(); ++i) {
            if (number[i] == UNUSED) continue;
            finish_vertex(i);
            for_each_array([&](auto& values) { values[used] = values[i]; });
            number[i] = used++;
        }
        for_each_array([&](auto& values) { values.resize(used); });
        for (uint32_t& corner : polygons_.corners)
            corner = number[corner];
        if (odd_normals_ > 0) {
            warnings.push_back(concat(file_, ": ", odd_normals_,
                                      odd_normals_ == 1 ? " normal is" : " normals are",
                                      " not finite; those of the faces are used there"));
        }
        if (odd_uvs_ > 0) {
            warnings.push_back(concat(file_, ": the texture coordinates of ", odd_uvs_,
                                      odd_uvs_ == 1 ? " vertex are" : " vertices are",
                                      " not finite, or beyond 1e30; 0 is used there"));
        }
    }

  private:
    template <class Visit>
    void for_each_array(const Visit& visit) {
        visit(polygons_.positions);
        if (!polygons_.normals.empty()) visit(polygons_.normals);
        if (!polygons_.uvs.empty()) visit(polygons_.uvs);
        if (!polygons_.colors.empty()) visit(polygons_.colors);
    }

    void finish_vertex(uint32_t i) {
        check_position(i);
        if (!polygons_.normals.empty() && !is_finite(polygons_.normals[i])) {
            polygons_.normals[i] = vec3(0.0f);
            ++odd_normals_;
        }
        if (!polygons_.uvs.empty() && !is_finite(vec3(polygons_.uvs[i], 0.0f))) {
            polygons_.uvs[i] = vec2(0.0f);
            ++odd_uvs_;
        }
        if (!polygons_.colors.empty()) finish_color(i);
    }

    void check_position(uint32_t i) const {
        const glm::dvec3 p = polygons_.positions[i];
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            if (std::abs(p[axis]) <= double(std::numeric_limits<float>::max())) continue;
            fail(i, concat("a finite ", "xyz"[axis], ", found ", shown(number_text(p[axis], 6))));
        }
    }

    void finish_color(uint32_t i) {
        constexpr float ROUNDING = 1e-5f;  // Rounding of programs that convert colours.
        vec4& color = polygons_.colors[i];
        for (glm::length_t c = 0; c < 4; ++c) {
            if (!(color[c] >= -ROUNDING && color[c] <= 1.0f + ROUNDING)) {
                fail(i, concat("a colour from 0 to 1, found ", shown(number_text(color[c], 6)),
                               "; write numbers from 0 to 255 as uchar"));
            }
        }
        color = clamp(color, 0.0f, 1.0f);
    }

    [[noreturn]] void fail(uint32_t i, const std::string& needs) const {
        throw Error(concat(file_, ": vertex ", i, ", which a face uses, needs ", needs));
    }

    PlyPolygons& polygons_;
    const std::string& file_;
    size_t odd_normals_ = 0;
    size_t odd_uvs_ = 0;  // Vertices.
};

}  // namespace

void finish_vertices(PlyPolygons& polygons, const std::string& file, std::vector<std::string>& warnings) {
    Finisher(polygons, file).finish(warnings);
}

}  // namespace candela
