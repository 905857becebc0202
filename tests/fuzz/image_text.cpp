// See image_text.h.
#include "fuzz/image_text.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>

namespace candela::fuzz {
namespace {

constexpr uint32_t MAX_EDGE = 16;

void read_size(std::istream& words, Image& image) {
    uint32_t width = 1, height = 1, x0 = 0, y0 = 0, x1 = MAX_EDGE, y1 = MAX_EDGE;
    words >> width >> height >> x0 >> y0 >> x1 >> y1;
    image.full = {std::clamp(width, 1u, MAX_EDGE), std::clamp(height, 1u, MAX_EDGE)};
    image.data.x0 = std::min(x0, image.full.x - 1);
    image.data.y0 = std::min(y0, image.full.y - 1);
    image.data.x1 = std::clamp(x1, image.data.x0 + 1, image.full.x);
    image.data.y1 = std::clamp(y1, image.data.y0 + 1, image.full.y);
}

// operator>> would accept neither "nan" nor "inf".
float read_float(std::istream& words) {
    std::string word;
    words >> word;
    return std::strtof(word.c_str(), nullptr);
}

void read_channel(std::istream& words, bool half, Image& image) {
    std::string name;
    words >> name;
    if (image.find(name) != nullptr) return;
    std::vector<float> values;
    while (words >> std::ws && words.peek() != std::istream::traits_type::eof())
        values.push_back(read_float(words));
    Channel& channel = image.add(name);
    channel.half = half;
    for (size_t i = 0; i < channel.values.size() && !values.empty(); ++i)
        channel.values[i] = values[i % values.size()];
}

}  // namespace

std::vector<Image> parse_images(std::string_view text) {
    std::vector<Image> images;
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string kind, name;
        words >> kind;
        if (kind == "size") {
            read_size(words, images.emplace_back());
        } else if (images.empty()) {
            continue;
        } else if (kind == "channel" || kind == "half") {
            read_channel(words, kind == "half", images.back());
        } else if (kind == "text") {
            words >> name >> std::ws;
            images.back().attributes[name] = std::string(std::istreambuf_iterator<char>(words), {});
        } else if (kind == "float") {
            words >> name;
            images.back().attributes[name] = read_float(words);
        }
    }
    return images;
}

}  // namespace candela::fuzz
