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

double color_number(const PlyProperty& property, size_t field, double number, const PlyPosition& position) {
    if (property.type == PlyType::uint8)
        return field == PLY_ALPHA ? number / 255.0 : double(decoded_byte(uint8_t(number)));
    if (property.type == PlyType::uint16)
        return field == PLY_ALPHA ? number / 65535.0 : double(srgb_decode(float(number / 65535.0)));
    if (number >= 0.0 && number <= 1.0) return number;
    position.fail("needs " + quote(property.name) + " from 0 to 1, found " + shown(number_text(number, 6)));
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

    NameList colors{"red", "green", "blue"};
    if (!has_all(vertex, colors)) return result;
    if (has_all(vertex, {"alpha"})) colors.emplace_back("alpha");
    const auto odd = std::ranges::find_if_not(
        colors, [&](std::string_view name) { return may_be_color(vertex.find(name)->type); });
    if (odd == colors.end()) {
        result.has_colors = take(colors, PLY_RED);
    } else {
        warnings.push_back(file + ": ignored the colours of vertices, because the property " + quote(*odd) +
                           " is neither uchar nor ushort, float or double");
    }
    return result;
}

double vertex_number(const PlyProperty& property, size_t field, double number, const PlyPosition& position) {
    if (field >= PLY_RED) return color_number(property, field, number, position);
    const bool is_uv = field >= PLY_U;
    if (std::abs(number) <= (is_uv ? MAX_UV : double(std::numeric_limits<float>::max()))) return number;
    const std::string range =
        is_uv ? quote(property.name) + " from -1e30 to 1e30" : "a finite " + property.name;
    position.fail("needs " + range + ", found " + shown(number_text(number, 6)));
}

}  // namespace candela
