// See checkpoint.h.
#include "film/checkpoint.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "base/parse_float.h"
#include "base/printable.h"
#include "film/sample_range.h"
#include "image/image_io.h"

namespace candela {
namespace {

constexpr const char* COMPONENTS[] = {"R", "G", "B", "A"};
constexpr const char* CHECKSUM_ATTRIBUTE = "candela.checksum";
constexpr const char* PLANNED_ATTRIBUTE = "candela.planned";
constexpr const char* SECONDS_ATTRIBUTE = "candela.renderSeconds";
constexpr const char* FORMAT_ATTRIBUTE = "candela.checkpoint";
constexpr const char* STATES_ATTRIBUTE = "candela.states";
constexpr const char* GUIDES_ATTRIBUTE = "candela.denoisingLayer";  // Accumulation::denoising_layer

// Version of the file format; it increases when older programs cannot read newer checkpoints. Files that need
// no guides are of the first.
constexpr uint32_t FORMAT = 2, FORMAT_WITHOUT_GUIDES = 1;

// Numbers of states of a plain and of an adaptive rendering; see adaptive.h.
constexpr size_t PLAIN_STATES = 1, ADAPTIVE_STATES = 4;

// The prefix of the names of a state's channels and attributes; the first state has none.
std::string prefix_of(size_t state) {
    return state == 0 ? "" : "State" + std::to_string(state) + ".";
}

std::string channel_name(size_t state, uint32_t layer, size_t component) {
    return prefix_of(state) + "Layer" + std::to_string(layer) + "." + COMPONENTS[component];
}

// Checksum of everything that is read back. OpenEXR's own checks miss many flipped bits.
uint64_t checksum(const Image& header, std::span<const Accumulation> states) {
    uint64_t hash = FNV1A64_BASIS;
    for (const Accumulation& state : states)
        hash = hash_words(std::as_bytes(std::span(state.values)), hash);
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

std::from_chars_result parse(const char* begin, const char* end, double& number) {
    return parse_float(begin, end, number);
}

template <class Integer>
std::from_chars_result parse(const char* begin, const char* end, Integer& number) {
    return std::from_chars(begin, end, number);
}

template <class Number>
Number number_attribute(const Image& image, const std::string& attribute, const std::string& name) {
    const std::string text = text_attribute(image, attribute, name);
    Number number{};
    const auto [end, error] = parse(text.data(), text.data() + text.size(), number);
    if (error == std::errc{} && end == text.data() + text.size()) return number;
    throw Error(name + ": the attribute " + attribute + " is \"" + printable(text, MAX_NAME_BYTES) +
                "\"; give a file that candela render wrote, unchanged");
}

// Calls each(attribute, number) for every integer of a state.
template <class State, class Each>
void for_each_number(State& state, const std::string& prefix, const Each& each) {
    each("candela." + prefix + "firstSample", state.first_sample);
    each("candela." + prefix + "seed", state.seed);
    each("candela." + prefix + "rays", state.counters.rays);
    each("candela." + prefix + "nonfiniteSamples", state.counters.nonfinite_samples);
    each("candela." + prefix + "depthLimitHits", state.counters.depth_limit_hits);
}

// How many states the image holds.
size_t count_states(const Image& image) {
    size_t states = 1;
    while (image.find(channel_name(states, 0, 0)) != nullptr)
        ++states;
    return states;
}

void add_layers(Image& image, size_t index, const Accumulation& state) {
    for (uint32_t layer = 0; layer < state.layer_count; ++layer) {
        for (size_t c = 0; c < 4; ++c) {
            Channel& channel = image.add(channel_name(index, layer, c));
            for (size_t i = 0; i < state.pixel_count(); ++i)
                channel.values[i] = state.at(layer, i)[c];
        }
    }
}

[[noreturn]] void fail_damaged(const std::string& name, const std::string& what) {
    throw Error(name + ": the checkpoint is damaged: " + what +
                "; use an undamaged copy, or remove the file to start over");
}

Accumulation read_layers(const Image& image, size_t index, const std::string& name) {
    Accumulation state{.full = image.full, .rect = image.data, .values = {}};
    if (image.attributes.contains(GUIDES_ATTRIBUTE)) {
        state.denoising_layer = number_attribute<uint32_t>(image, GUIDES_ATTRIBUTE, name);
        constexpr uint32_t BEFORE[] = {LAYER_COUNT_COLOUR, LAYER_COUNT_AOVS, LAYER_COUNT_CATCHERS};
        if (std::ranges::find(BEFORE, state.denoising_layer) == std::end(BEFORE))
            fail_damaged(name, "it says that the layers of guides begin with " +
                                   std::to_string(state.denoising_layer));
        state.layer_count = state.denoising_layer + LAYER_COUNT_GUIDES;
    } else if (image.find(channel_name(index, LAYER_WITH, 0)) != nullptr) {
        state.layer_count = LAYER_COUNT_CATCHERS;
    } else if (image.find(channel_name(index, LAYER_ALBEDO, 0)) != nullptr) {
        state.layer_count = LAYER_COUNT_AOVS;
    }
    state.values.resize(state.layer_count * state.pixel_count() * 4);
    for (uint32_t layer = 0; layer < state.layer_count; ++layer) {
        for (size_t c = 0; c < 4; ++c) {
            const Channel* const channel = image.find(channel_name(index, layer, c));
            if (channel == nullptr) {
                throw Error(name + ": the channel " + channel_name(index, layer, c) +
                            " is missing; give a checkpoint that candela render wrote, unchanged");
            }
            for (size_t i = 0; i < state.pixel_count(); ++i)
                state.values[(layer * state.pixel_count() + i) * 4 + c] = channel->values[i];
        }
    }
    return state;
}

// Throws Error if a newer version wrote the file, or if it does not hold as many states as it says.
void check_format(const Image& image, const std::string& name) {
    const auto format = number_attribute<uint32_t>(image, FORMAT_ATTRIBUTE, name);
    if (format > FORMAT) {
        throw Error(name + ": the checkpoint was made by a newer version of candela (its format is " +
                    std::to_string(format) + ", and " + std::to_string(FORMAT) +
                    " is the newest known here); continue with that version");
    }
    const auto states = number_attribute<size_t>(image, STATES_ATTRIBUTE, name);
    if (states != PLAIN_STATES && states != ADAPTIVE_STATES)
        fail_damaged(name, "it says that it holds " + std::to_string(states) + " states, not 1 or 4");
    if (states != count_states(image)) fail_damaged(name, "it does not hold as many states as it says");
}

bool is_count(float value, float max) {
    return value >= 0.0f && value <= max && value == std::floor(value);
}

// Checks what a renderer relies on. The checksum does not ensure it, since a forger can compute one.
void check_state(const Accumulation& state, const std::string& name) {
    for (size_t i = 0; i < state.pixel_count(); ++i) {
        const float samples = state.at(LAYER_L_COMPENSATION, i)[3];
        const auto expect = [&](bool holds, const char* what) {
            if (!holds)
                fail_damaged(name,
                             "pixel " + std::to_string(i) + " of a state has no whole number of " + what);
        };
        expect(is_count(samples, MAX_SPP), "samples");
        expect(is_count(state.at(LAYER_L, i)[3], samples), "visible samples");
        expect(is_count(state.at(LAYER_SQUARE, i)[3], MAX_SPP), "samples as its limit");
        expect(is_count(state.at(LAYER_SQUARE_COMPENSATION, i)[3], MAX_RAYS), "rays");
        if (state.layers_before_guides() != LAYER_COUNT_CATCHERS) continue;
        expect(is_count(state.at(LAYER_WITH, i)[3], samples), "samples of catchers");
        expect(is_count(state.at(LAYER_WITHOUT, i)[3], state.at(LAYER_WITH, i)[3]), "samples of reflections");
    }
}

// The states of one rendering differ in their seeds as in adaptive_states().
void check_together(const Checkpoint& checkpoint, const std::string& name) {
    const Accumulation& first = checkpoint.states.front();
    for (size_t i = 0; i < checkpoint.states.size(); ++i) {
        const Accumulation& state = checkpoint.states[i];
        if (state.seed != (first.seed ^ uint32_t(i) << 30) || state.first_sample != first.first_sample ||
            state.layer_count != first.layer_count || state.denoising_layer != first.denoising_layer)
            fail_damaged(name, "its states are not those of one rendering");
    }
    const CheckpointHeader& header = checkpoint.header;
    if (!(header.render_seconds >= 0.0 && std::isfinite(header.render_seconds)))
        fail_damaged(name, "its rendering time is not valid");
    if (header.planned > MAX_SPP) fail_damaged(name, "it plans more samples than a pixel can hold");
}

}  // namespace

void save_checkpoint(const std::filesystem::path& path, const CheckpointHeader& header,
                     std::span<const Accumulation> states, FileWriter write) {
    const Accumulation& first = states.front();
    Image image{.full = first.full, .data = first.rect, .channels = {}, .attributes = {}};
    for (size_t index = 0; index < states.size(); ++index) {
        for_each_number(states[index], prefix_of(index), [&](const std::string& attribute, auto number) {
            image.attributes[attribute] = std::to_string(number);
        });
        add_layers(image, index, states[index]);
    }
    const bool has_guides = first.denoising_layer != 0;
    image.attributes[FORMAT_ATTRIBUTE] = std::to_string(has_guides ? FORMAT : FORMAT_WITHOUT_GUIDES);
    if (has_guides) image.attributes[GUIDES_ATTRIBUTE] = std::to_string(first.denoising_layer);
    image.attributes[STATES_ATTRIBUTE] = std::to_string(states.size());
    image.attributes[PLANNED_ATTRIBUTE] = std::to_string(header.planned);
    image.attributes[SECONDS_ATTRIBUTE] = std::to_string(header.render_seconds);
    set_identity(image, header.identity);
    set_maker(image, header.maker);
    image.attributes[CHECKSUM_ATTRIBUTE] = hexadecimal(checksum(image, states));
    write_exr(path, image, write);
}

Checkpoint load_checkpoint(const std::filesystem::path& path) {
    return checkpoint_of(read_exr(path), path.string());
}

Checkpoint checkpoint_of(const Image& image, const std::string& name, bool with_checksum) {
    const std::string expected = text_attribute(image, CHECKSUM_ATTRIBUTE, name);
    check_format(image, name);
    Checkpoint checkpoint;
    for (size_t index = 0; index < count_states(image); ++index)
        checkpoint.states.push_back(read_layers(image, index, name));
    if (with_checksum && hexadecimal(checksum(image, checkpoint.states)) != expected)
        fail_damaged(name, "its contents do not match its checksum");
    for (size_t index = 0; index < checkpoint.states.size(); ++index) {
        for_each_number(checkpoint.states[index], prefix_of(index),
                        [&]<class Number>(const std::string& attribute, Number& number) {
                            number = number_attribute<Number>(image, attribute, name);
                        });
        check_state(checkpoint.states[index], name);
    }
    checkpoint.header = {.identity = identity_of(image, name),
                         .maker = maker_of(image, name),
                         .render_seconds = number_attribute<double>(image, SECONDS_ATTRIBUTE, name),
                         .planned = number_attribute<uint32_t>(image, PLANNED_ATTRIBUTE, name)};
    check_together(checkpoint, name);
    return checkpoint;
}

}  // namespace candela
