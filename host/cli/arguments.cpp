// Reads values of the command line.
#include "cli/arguments.h"

#include <charconv>
#include <cmath>
#include <locale>
#include <sstream>
#include <vector>

namespace candela {

std::string shell_quoted(const std::string& word) {
    std::string quoted = "'";
    for (const char c : word)
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + '\'';
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    size_t begin = 0;
    for (size_t end = text.find(separator); end != std::string::npos; end = text.find(separator, begin)) {
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    parts.push_back(text.substr(begin));
    return parts;
}

std::optional<uint32_t> parse_uint(const std::string& text, uint32_t min, uint32_t max) {
    uint32_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || stop != end || value < min || value > max) return std::nullopt;
    return value;
}

// Through a stream, since not every standard library has std::from_chars for double.
std::optional<double> parse_number(const std::string& text) {
    std::istringstream stream(text);
    stream.imbue(std::locale::classic());
    double value = 0.0;
    stream >> std::noskipws >> value;
    if (!stream || stream.peek() != std::istringstream::traits_type::eof()) return std::nullopt;
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<uvec2> parse_size(const std::string& text) {
    const std::vector<std::string> parts = split(text, 'x');
    if (parts.size() != 2) return std::nullopt;
    const auto width = parse_uint(parts[0], 1, MAX_PICTURE_SIZE);
    const auto height = parse_uint(parts[1], 1, MAX_PICTURE_SIZE);
    if (!width || !height) return std::nullopt;
    return uvec2(*width, *height);
}

std::optional<PixelRect> parse_crop(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() != 4) return std::nullopt;
    uint32_t values[4];
    for (size_t i = 0; i < 4; ++i) {
        const auto value = parse_uint(parts[i], 0, MAX_PICTURE_SIZE);
        if (!value) return std::nullopt;
        values[i] = *value;
    }
    const PixelRect rect{values[0], values[1], values[2], values[3]};
    return rect.x0 < rect.x1 && rect.y0 < rect.y1 ? std::optional(rect) : std::nullopt;
}

std::optional<double> parse_duration(const std::string& text) {
    const char unit = text.empty() ? '\0' : text.back();
    double scale = 1.0;
    if (unit == 'm') scale = 60.0;
    if (unit == 'h') scale = 3600.0;
    const bool has_unit = unit == 's' || unit == 'm' || unit == 'h';
    const auto number = parse_number(has_unit ? text.substr(0, text.size() - 1) : text);
    return number && *number > 0.0 ? std::optional(*number * scale) : std::nullopt;
}

std::optional<SampleRange> parse_samples(const std::string& text) {
    const auto ranges = parse_ranges(text);
    return ranges && ranges->size() == 1 && ranges->front().count() > 0 ? std::optional(ranges->front())
                                                                        : std::nullopt;
}

std::optional<AovSelection> parse_aovs(const std::string& text) {
    if (text == "none") return AovSelection{};
    AovSelection aovs;
    for (const std::string& name : split(text == "all" ? AOV_NAMES : text, ',')) {
        if (name == "albedo") {
            aovs.albedo = true;
        } else if (name == "n") {
            aovs.normal = true;
        } else if (name == "p") {
            aovs.position = true;
        } else if (name == "z") {
            aovs.depth = true;
        } else if (name == "variance") {
            aovs.variance = true;
        } else if (name == "samples") {
            aovs.sample_count = true;
        } else if (name == "depth") {
            aovs.distance = true;
        } else if (name == "ids") {
            aovs.ids = true;
        } else if (name == "cryptomatte") {
            aovs.cryptomatte = true;
        } else if (name == "denoising") {
            aovs.denoising = true;
        } else if (name == "motion") {
            aovs.motion = true;
        } else {
            return std::nullopt;
        }
    }
    return aovs;
}

void PictureOptions::add_to(CLI::App& app) {
    add_value(app, "--size", size, parse_size,
              "WIDTHxHEIGHT in pixels, each from 1 to " + std::to_string(MAX_PICTURE_SIZE),
              "Whole picture in pixels (default: the scene's)")
        ->type_name("WxH");
    add_value(app, "--crop", crop, parse_crop,
              "x0,y0,x1,y1 in pixels from the top left, with x0 < x1 and y0 < y1",
              "Only these pixels; x1 and y1 exclusive (default: all)")
        ->type_name("x0,y0,x1,y1");
}

PixelRect PictureOptions::crop_within(uvec2 full) const {
    if (!crop) return {0, 0, full.x, full.y};
    if (crop->x1 > full.x || crop->y1 > full.y) {
        throw Error("--crop: " + std::to_string(crop->x0) + ',' + std::to_string(crop->y0) + ',' +
                        std::to_string(crop->x1) + ',' + std::to_string(crop->y1) +
                        " reaches beyond the picture of " + std::to_string(full.x) + 'x' +
                        std::to_string(full.y) + " pixels; x1 is at most the width, y1 at most the height",
                    ErrorKind::request);
    }
    return *crop;
}

}  // namespace candela
