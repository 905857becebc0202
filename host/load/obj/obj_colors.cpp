// See obj_colors.h.
#include "load/obj/obj_colors.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/color.h"
#include "base/text.h"
#include "load/quote.h"

namespace candela {
namespace {

constexpr float BYTE = 255.0f;
const vec3 NO_COLOR(std::numeric_limits<float>::quiet_NaN());

vec3 decode(vec3 code) {
    if (std::isnan(code.x)) return vec3(1.0f);
    for (glm::length_t i = 0; i < 3; ++i)
        code[i] = srgb_decode(std::clamp(code[i], 0.0f, 1.0f));
    return code;
}

}  // namespace

void ObjColors::add(size_t position, vec3 numbers) {
    codes_.resize(position, NO_COLOR);
    codes_.push_back(numbers);
    for (glm::length_t i = 0; i < 3; ++i) {
        min_ = std::min(min_, numbers[i]);
        greatest_ = std::max(greatest_, numbers[i]);
        whole_ = whole_ && std::trunc(numbers[i]) == numbers[i];
    }
}

void ObjColors::add_mrgb(std::string_view digits) {
    constexpr size_t DIGITS = 8;
    for (; digits.size() >= DIGITS; digits.remove_prefix(DIGITS)) {
        uint32_t word = 0;
        const auto [stop, error] = std::from_chars(digits.data(), digits.data() + DIGITS, word, 16);
        if (error != std::errc() || stop != digits.data() + DIGITS) return;
        mrgb_.push_back(vec3(word >> 16 & 0xFFu, word >> 8 & 0xFFu, word & 0xFFu) / BYTE);
    }
}

std::vector<vec3> ObjColors::linear(size_t count, std::optional<std::string>& warning) const {
    constexpr float ROUNDING = 1e-3f;
    std::vector<vec3> codes = codes_;
    if (codes.empty() && mrgb_.size() == count) codes = mrgb_;
    if (codes.empty()) {
        if (!mrgb_.empty()) {
            warning = concat("left out the colours (#MRGB): ", mrgb_.size(), " for ", count, " vertices");
        }
        return {};
    }
    const bool in_bytes = whole_ && min_ >= 0.0f && greatest_ > 1.0f && greatest_ <= BYTE;
    if (in_bytes) {
        warning = "the colours of vertices are read as numbers from 0 to 255";
        for (vec3& code : codes)
            code /= BYTE;
    } else if (min_ < -ROUNDING || greatest_ > 1.0f + ROUNDING) {
        warning = concat("left out the numbers after positions, from ", shown(number_text(double(min_), 6)),
                         " to ", shown(number_text(double(greatest_), 6)),
                         ": colours would be from 0 to 1, or whole numbers from 0 to 255");
        return {};
    }
    codes.resize(count, NO_COLOR);
    std::ranges::transform(codes, codes.begin(), decode);
    return codes;
}

}  // namespace candela
