// Values on the command line: how they are read, and options whose errors name flag, value and what is
// expected.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "base/limits.h"
#include "film/accumulation.h"
#include "film/sample_range.h"
#include "image/image.h"
#include "scene/names.h"

namespace candela {

// The images that --aov can name, but for "motion", which needs frames and is not among "all".
inline constexpr const char* AOV_NAMES = "albedo,n,p,z,variance,samples,depth,ids,cryptomatte,denoising";

// The word in single quotes, as sh, bash and zsh read it.
std::string shell_quoted(const std::string& word);

// The parts of `text` between separators, including empty ones.
std::vector<std::string> split(const std::string& text, char separator);

// Each parses all of `text`; returns nothing if it does not have the form described.

// A whole decimal number in [least, most].
std::optional<uint32_t> parse_uint(const std::string& text, uint32_t min, uint32_t max);
// A finite decimal number.
std::optional<double> parse_number(const std::string& text);
// "WxH": width and height in pixels, each from 1 to MAX_PICTURE_SIZE.
std::optional<uvec2> parse_size(const std::string& text);
// "x0,y0,x1,y1": pixels, at least one of them, each number at most MAX_PICTURE_SIZE.
std::optional<PixelRect> parse_crop(const std::string& text);
// "90", "90s", "1.5m" or "2h": more than 0, in seconds.
std::optional<double> parse_duration(const std::string& text);
// "A..B": the samples A to B-1, at least one of them.
std::optional<SampleRange> parse_samples(const std::string& text);
inline constexpr const char* SAMPLES_EXPECTED = "A..B: samples A to B-1, with A < B, each at most 16777216";
static_assert(MAX_SPP == 16777216);
// "all", "none" or names of images with commas between, as AOV_NAMES lists them, and "motion".
std::optional<AovSelection> parse_aovs(const std::string& text);

// Adds an option that stores parse(value) in `target` (a T or std::optional<T>) if there is one, and
// otherwise throws an Error (usage) such as `--size: cannot use "12"; expected WIDTHxHEIGHT`. `names` as in
// CLI11, e.g. "-o,--output".
template <class Target, class Parse>
CLI::Option* add_value(CLI::App& app, const std::string& names, Target& target, const Parse& parse,
                       const std::string& expected, const std::string& description) {
    const std::string flag = names.substr(names.rfind(',') + 1);
    const auto store = [&target, parse, expected, flag](const std::string& text) {
        const auto value = parse(text);
        if (!value)
            throw Error(flag + ": cannot use \"" + text + "\"; expected " + expected, ErrorKind::request);
        target = *value;
    };
    return app.add_option_function<std::string>(names, store, description);
}

// Adds an option whose value is one of a few words; `choices` must live as long as `app`.
template <class Target, class T, size_t N>
CLI::Option* add_choice(CLI::App& app, const std::string& names, Target& target, const Choices<T, N>& choices,
                        const std::string& description) {
    std::string words;
    for (const auto& [word, value] : choices)
        words += (words.empty() ? "" : "|") + std::string(word);
    const auto parse = [&choices](const std::string& text) -> std::optional<T> {
        for (const auto& [word, value] : choices) {
            if (text == word) return value;
        }
        return std::nullopt;
    };
    return add_value(app, names, target, parse, words, description)->type_name(words);
}

// The options for the size of the picture and the part of it to render.
struct PictureOptions {
    std::optional<uvec2> size;
    std::optional<PixelRect> crop;

    // Adds --size and --crop.
    void add_to(CLI::App& app);
    // The crop within a picture of `full` pixels; by default the whole picture. Throws Error (usage) if the
    // crop exceeds it.
    PixelRect crop_within(uvec2 full) const;
};

}  // namespace candela
