// NameList and ranges.
#include "load/ply/ply_vertex.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "base/color.h"
#include "base/text.h"
#include "load/quote.h"
#include "scene/texture.h"

namespace candela {
namespace {

using NameList = std::vector<std::string_view>;

// Whether all these properties are numbers.
bool has_all(const PlyElement& vertex, const NameList& names) {
    return std::ranges::all_of(names, [&](std::string_view name) {
        const PlyProperty* property = vertex.find(name);
        return property && !property->length;
    });
}

bool may_be_color(PlyType type) {
    return type == PlyType::uint8 || type == PlyType::uint16 || !is_integer(type);
}

// The linear value of each byte in sRGB.
float decoded_byte(uint8_t code) {
    static const std::array<float, 256> decoded = [] {
        std::array<float, 256> values{};
        for (size_t i = 0; i < values.size(); ++i)
            values[i] = srgb_decode(float(i) / 255.0f);
        return values;
    }();
    return decoded[code];
}

double color_number(PlyType type, bool alpha, double number) {
    if (type == PlyType::uint8) return alpha ? number / 255.0 : double(decoded_byte(uint8_t(number)));
    if (type == PlyType::uint16)
        return alpha ? number / 65535.0 : double(srgb_decode(float(number / 65535.0)));
    return number;
}

}  // namespace

PlyVertexFields find_vertex_fields(const PlyElement& vertex, bool with_normals, const std::string& file,
                                   std::vector<std::string>& warnings) {
    PlyVertexFields result{.fields = std::vector(vertex.properties.size(), PLY_SKIPPED)};
    const auto take = [&](const NameList& names, size_t first) {
        if (!has_all(vertex, names)) return false;
        for (size_t i = 0; i < names.size(); ++i)
            result.fields[size_t(vertex.find(names[i]) - vertex.properties.data())] = first + i;
        return true;
    };
    take({"x", "y", "z"}, PLY_X);
    result.has_normals = with_normals && take({"nx", "ny", "nz"}, PLY_NX);
    for (const NameList& names : {NameList{"u", "v"}, NameList{"s", "t"}, NameList{"texture_u", "texture_v"},
                                  NameList{"texture_s", "texture_t"}})
        result.has_uvs = result.has_uvs || take(names, PLY_U);

    // In files of older programs, "diffuse_red".
    for (const std::string prefix : {"", "diffuse_"}) {
        const std::array names{prefix + "red", prefix + "green", prefix + "blue", prefix + "alpha"};
        NameList colors(names.begin(), names.begin() + 3);
        if (!has_all(vertex, colors)) continue;
        if (has_all(vertex, {names[3]})) colors.emplace_back(names[3]);
        const auto odd = std::ranges::find_if_not(
            colors, [&](std::string_view name) { return may_be_color(vertex.find(name)->type); });
        if (odd == colors.end()) {
            result.has_colors = take(colors, PLY_RED);
        } else {
            warnings.push_back(file + ": ignored the colours of vertices, because the property " +
                               quote(*odd) + " is neither uchar nor ushort, float or double");
        }
        break;
    }
    return result;
}

double vertex_number(PlyType type, size_t field, double number) {
    if (field >= PLY_RED) return color_number(type, field == PLY_ALPHA, number);
    const double max = field >= PLY_U ? MAX_UV : double(std::numeric_limits<float>::max());
    return field < PLY_NX || std::abs(number) <= max ? number : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace candela
