// See checkpoint.h.
#include "render/checkpoint.h"

#include <charconv>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "base/image_io.h"

namespace candela {
namespace {

constexpr const char* COMPONENTS[] = {"R", "G", "B", "A"};
constexpr const char* CHECKSUM_ATTRIBUTE = "candela.checksum";
constexpr const char* SECONDS_ATTRIBUTE = "candela.renderSeconds";

std::string layer_channel(uint32_t layer, size_t component) {
    return "Layer" + std::to_string(layer) + "." + COMPONENTS[component];
}

// Of all that is read back. OpenEXR's own checks miss many a flipped bit.
uint64_t checksum(const Image& header, const std::vector<float>& values) {
    uint64_t hash = hash_words(std::as_bytes(std::span(values)));
    for (const auto& [name, attribute] : header.attributes) {
        const auto* const text = std::get_if<std::string>(&attribute);
        if (text == nullptr || !name.starts_with("candela.") || name == CHECKSUM_ATTRIBUTE) continue;
        const std::string line = name + '=' + *text + '\n';
        hash = fnv1a64(std::as_bytes(std::span(line)), hash);
    }
    const std::array<uint32_t, 6> place = {header.full.x,  header.full.y,  header.data.x0,
                                           header.data.y0, header.data.x1, header.data.y1};
    return fnv1a64(std::as_bytes(std::span(place)), hash);
}

template <class Number>
Number number_attribute(const Image& image, const std::string& attribute, const std::string& name) {
    const std::string& text = text_attribute(image, attribute, name);
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc{} && end == text.data() + text.size()) return number;
    throw Error(name + ": the attribute " + attribute + " is \"" + text +
                "\"; give a file that candela render wrote, unchanged");
}

// The whole numbers of a state, and the attributes that hold them.
template <class State, class Each>
void for_each_number(State& state, const Each& each) {
    each("candela.firstSample", state.first_sample);
    each("candela.seed", state.seed);
    each("candela.rays", state.counters.rays);
    each("candela.nonfiniteSamples", state.counters.nonfinite_samples);
    each("candela.depthLimitHits", state.counters.depth_limit_hits);
}

}  // namespace

void save_checkpoint(const std::filesystem::path& path, const Identity& identity, const Maker& maker,
                     double render_seconds, const Accumulation& state) {
    Image image{.full = state.full, .data = state.rect, .channels = {}, .attributes = {}};
    for_each_number(state, [&](const char* attribute, auto number) {
        image.attributes[attribute] = std::to_string(number);
    });
    image.attributes[SECONDS_ATTRIBUTE] = std::to_string(render_seconds);
    set_identity(image, identity);
    set_maker(image, maker);
    image.attributes[CHECKSUM_ATTRIBUTE] = hexadecimal(checksum(image, state.values));
    for (uint32_t layer = 0; layer < state.layer_count; ++layer) {
        for (size_t c = 0; c < 4; ++c) {
            Channel& channel = image.add(layer_channel(layer, c));
            for (size_t i = 0; i < state.pixel_count(); ++i)
                channel.values[i] = state.at(layer, i)[c];
        }
    }
    write_exr(path, image);
}

Checkpoint load_checkpoint(const std::filesystem::path& path) {
    const Image image = read_exr(path);
    const std::string name = path.string();
    Checkpoint checkpoint;
    Accumulation& state = checkpoint.state;
    state.full = image.full;
    state.rect = image.data;
    const std::string& expected = text_attribute(image, CHECKSUM_ATTRIBUTE, name);
    if (image.find(layer_channel(LAYER_ALBEDO, 0)) != nullptr) state.layer_count = LAYER_COUNT_AOVS;
    state.values.resize(state.layer_count * state.pixel_count() * 4);
    for (uint32_t layer = 0; layer < state.layer_count; ++layer) {
        for (size_t c = 0; c < 4; ++c) {
            const Channel* const channel = image.find(layer_channel(layer, c));
            if (channel == nullptr) {
                throw Error(name + ": the channel " + layer_channel(layer, c) +
                            " is missing; give a checkpoint that candela render wrote, unchanged");
            }
            for (size_t i = 0; i < state.pixel_count(); ++i)
                state.values[(layer * state.pixel_count() + i) * 4 + c] = channel->values[i];
        }
    }
    if (hexadecimal(checksum(image, state.values)) != expected) {
        throw Error(
            name +
            ": the checkpoint is damaged: its contents do not have its checksum; use an undamaged copy, "
            "or remove the file to start anew");
    }
    for_each_number(state, [&]<class Number>(const char* attribute, Number& number) {
        number = number_attribute<Number>(image, attribute, name);
    });
    checkpoint.render_seconds = number_attribute<double>(image, SECONDS_ATTRIBUTE, name);
    checkpoint.identity = identity_of(image, name);
    checkpoint.maker = maker_of(image, name);
    return checkpoint;
}

}  // namespace candela
