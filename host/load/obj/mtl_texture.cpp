// One function per kind of option.
#include "load/obj/mtl_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "load/quote.h"
#include "load/text_lines.h"
#include "scene/principled.h"

namespace candela {
namespace {

constexpr std::array<std::string_view, 13> OPTIONS{"-s",      "-o",      "-clamp", "-imfchan", "-bm",
                                                   "-mm",     "-t",      "-boost", "-texres",  "-type",
                                                   "-blendu", "-blendv", "-cc"};

bool is_known(std::string_view word) {
    return std::ranges::find(OPTIONS, word) != OPTIONS.end();
}

// `-s` is an option; `-wall.png` is a file, and so is `-5`.
bool is_option(std::string_view word) {
    constexpr std::string_view LETTERS = "abcdefghijklmnopqrstuvwxyz";
    return word.size() > 1 && word[0] == '-' && word.find_first_not_of(LETTERS, 1) == std::string_view::npos;
}

class OptionReader {
  public:
    OptionReader(std::string_view command, std::string_view rest, const std::string& place)
        : command_(command), rest_(rest) {
        result_.place = place;
    }

    MtlTexture read() {
        read_options(is_option);
        read_name();
        read_options(is_known);  // Some programs write options after the name.
        std::ranges::replace(result_.file, '\\', '/');
        return std::move(result_);
    }

  private:
    void read_options(bool (*is_one)(std::string_view)) {
        for (std::string_view after = rest_;; after = rest_) {
            option_ = next_word(after);
            if (!is_one(option_)) return;
            rest_ = after;
            read_option();
        }
    }

    // Cuts off the text before the next known option.
    void read_name() {
        std::string_view after = rest_;
        size_t length = rest_.size();
        for (std::string_view word = next_word(after); !word.empty(); word = next_word(after)) {
            if (!is_known(word)) continue;
            length = size_t(word.data() - rest_.data());
            break;
        }
        result_.file = trimmed(rest_.substr(0, length));
        rest_.remove_prefix(length);
    }

    [[noreturn]] void fail(const std::string& cause) const { throw Error(result_.place + ": " + cause); }

    [[noreturn]] void fail_value(const std::string& needs, std::string_view found) const {
        fail("the option " + std::string(option_) + " of " + std::string(command_) + " needs " + needs +
             ", found " + shown(quote(found)));
    }

    void read_option() {
        Texture& texture = result_.texture;
        if (option_ == "-s") {
            const vec3 scale = up_to_three(1.0f);
            texture.rows[0].x = scale.x;
            texture.rows[1].y = scale.y;
        } else if (option_ == "-o") {
            const vec3 offset = up_to_three(0.0f);
            texture.rows[0].z = offset.x;
            texture.rows[1].z = offset.y;
        } else if (option_ == "-clamp") {
            texture.wrap_u = texture.wrap_v = is_on() ? Wrap::clamp : Wrap::repeat;
        } else if (option_ == "-bm") {
            result_.multiplier = number(double(MAX_NORMAL_SCALE));
        } else if (option_ == "-imfchan") {
            read_channel();
        } else {
            read_ignored();
        }
    }

    // Options without an equivalent, and whether they change the picture.
    void read_ignored() {
        bool changes = true;
        if (option_ == "-mm") {
            const float base = number(MAX_UV_TRANSFORM), gain = number(MAX_UV_TRANSFORM);
            changes = base != 0.0f || gain != 1.0f;
        } else if (option_ == "-t") {
            changes = up_to_three(0.0f) != vec3(0.0f);
        } else if (option_ == "-boost") {
            changes = number(MAX_UV_TRANSFORM) != 0.0f;
        } else if (option_ == "-texres") {
            number(MAX_UV_TRANSFORM);
        } else if (option_ == "-type") {
            next_word(rest_);
        } else if (option_ == "-blendu" || option_ == "-blendv") {
            changes = !is_on();
        } else if (option_ == "-cc") {
            changes = is_on();
        } else {
            for (std::string_view after = rest_; parse_number(next_word(after)); after = rest_)
                next_word(rest_);
        }
        if (changes) result_.ignored.emplace_back(option_);
    }

    std::optional<float> read_number(std::string_view word, double max) const {
        const std::optional<double> number = parse_finite(word);
        if (!number) return std::nullopt;
        if (std::abs(*number) > max) fail_value("numbers of at most " + number_text(max, 6), word);
        return float(*number);
    }

    float number(double max) {
        const std::string_view word = next_word(rest_);
        if (const auto value = read_number(word, max)) return *value;
        fail_value("a finite number", word);
    }

    // One to three numbers; those that are absent are `other`.
    vec3 up_to_three(float other) {
        vec3 numbers(number(MAX_UV_TRANSFORM), other, other);
        for (glm::length_t i = 1; i < 3; ++i) {
            std::string_view after = rest_;
            const auto value = read_number(next_word(after), MAX_UV_TRANSFORM);
            if (!value) break;
            numbers[i] = *value;
            rest_ = after;
        }
        return numbers;
    }

    bool is_on() {
        const std::string_view word = next_word(rest_);
        if (word != "on" && word != "off") fail_value("on or off", word);
        return word == "on";
    }

    void read_channel() {
        constexpr std::array<std::pair<std::string_view, uint32_t>, 5> CHANNELS{
            {{"r", 0}, {"g", 1}, {"b", 2}, {"m", 3}, {"l", 0}}};
        const std::string_view word = next_word(rest_);
        const auto* const known =
            std::ranges::find(CHANNELS, word, [](const auto& channel) { return channel.first; });
        if (known != CHANNELS.end()) {
            result_.channel = known->second;
        } else if (word == "z") {
            result_.ignored.emplace_back("-imfchan z");
        } else {
            fail_value("r, g, b, m, l or z", word);
        }
    }

    std::string_view command_;
    std::string_view rest_;
    std::string_view option_;
    MtlTexture result_;
};

}  // namespace

MtlTexture parse_mtl_texture(std::string_view command, std::string_view rest, const std::string& place) {
    return OptionReader(command, rest, place).read();
}

}  // namespace candela
