// See merge.h.
#include "render/merge.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include "base/error.h"
#include "render/identity.h"
#include "render/part_sum.h"
#include "render/sample_range.h"

namespace candela {
namespace {

constexpr const char* SAMPLES = "candela.samples";
constexpr const char* SPP = "samplesPerPixel";
constexpr const char* SECONDS = "renderTimeSeconds";
constexpr const char* COUNT_CHANNEL = "SampleCount.V";

// What a file says of itself, and its channels without their values.
struct Part {
    std::filesystem::path file;
    std::string name;
    Identity identity;
    Maker maker;
    std::vector<SampleRange> samples;  // Those that some pixel holds.
    float seconds = 0.0f;
    Image header;
};

float number_attribute(const Image& image, const char* attribute) {
    const auto found = image.attributes.find(attribute);
    const auto* const number = found == image.attributes.end() ? nullptr : std::get_if<float>(&found->second);
    return number == nullptr ? 0.0f : *number;
}

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
    throw Error(name + ": " + why);
}

// Samples of each pixel: as the image counts them or, where it does not, as its attributes say.
std::vector<uint32_t> sample_counts(const Image& image, const std::string& name,
                                    std::span<const SampleRange> samples) {
    const uint32_t most = total_count(samples);
    const Channel* const channel = image.find(COUNT_CHANNEL);
    if (channel == nullptr) {
        if (number_attribute(image, SPP) != float(most)) {
            refuse(
                name,
                "its pixels hold different numbers of samples, and it has no channel SampleCount.V to tell "
                "them; render such parts with --aov samples among others");
        }
        return std::vector<uint32_t>(image.pixel_count(), most);
    }
    std::vector<uint32_t> counts;
    counts.reserve(image.pixel_count());
    for (const float count : channel->values) {
        if (!(count >= 0.0f && count <= float(most)) || count != std::floor(count)) {
            refuse(name, "its channel SampleCount.V has the value " + std::to_string(count) +
                             ", but it says to hold " + std::to_string(most) +
                             " sample(s) per pixel at most; give files as candela wrote them");
        }
        counts.push_back(uint32_t(count));
    }
    return counts;
}

// Checks what one file alone can tell.
Part describe(const std::filesystem::path& file, Image image) {
    Part part{.file = file, .name = file.string(), .identity = {}, .maker = {}, .samples = {}, .header = {}};
    part.identity = identity_of(image, part.name);
    part.maker = maker_of(image, part.name);
    for (const char* colour : {"R", "G", "B", "A"}) {
        if (image.find(colour) == nullptr) {
            refuse(part.name, std::string("it has no channel ") + colour +
                                  "; give images (-o), no checkpoints or other files");
        }
    }
    if (image.attributes.contains(ADAPTIVE_ATTRIBUTE)) {
        refuse(
            part.name,
            "it was rendered with --adaptive: where its samples lie depends on what they found; render parts "
            "with --samples");
    }
    const std::string& samples = text_attribute(image, SAMPLES, part.name);
    const auto ranges = parse_ranges(samples);
    if (!ranges) {
        refuse(part.name, std::string("the attribute ") + SAMPLES + " is \"" + samples +
                              "\"; give a file that candela render wrote, unchanged");
    }
    part.samples = *ranges;
    sample_counts(image, part.name, part.samples);
    part.seconds = number_attribute(image, SECONDS);
    for (Channel& channel : image.channels)
        channel.values = {};
    part.header = std::move(image);
    return part;
}

// Throws Error if two parts hold the same sample.
void refuse_overlaps(const std::vector<Part>& parts) {
    std::vector<std::pair<SampleRange, const Part*>> all;
    for (const Part& part : parts) {
        for (const SampleRange& range : part.samples) {
            if (range.count() > 0) all.emplace_back(range, &part);
        }
    }
    std::ranges::sort(all, {},
                      [](const auto& entry) { return std::pair(entry.first.first, entry.first.end); });
    for (size_t i = 1; i < all.size(); ++i) {
        const auto& [before, earlier] = all[i - 1];
        const auto& [range, later] = all[i];
        if (range.first >= before.end) continue;
        const SampleRange twice{range.first, std::min(range.end, before.end)};
        refuse(later->name, "it holds samples " + to_text({&twice, 1}) + " as " + earlier->name +
                                " does; leave one of them out, or render other samples (--samples)");
    }
}

void warn_of_gaps(const std::vector<Part>& parts, std::vector<std::string>& warnings) {
    std::vector<SampleRange> all;
    for (const Part& part : parts)
        all.insert(all.end(), part.samples.begin(), part.samples.end());
    std::vector<SampleRange> gaps;
    uint32_t end = 0;
    for (const SampleRange& range : joined(all)) {
        if (range.first > end) gaps.push_back({end, range.first});
        end = range.end;
    }
    if (!gaps.empty())
        warnings.push_back("the samples " + to_text(gaps) + " are missing: no part holds them");
}

void warn_of_makers(const std::vector<Part>& parts, std::vector<std::string>& warnings) {
    for (const Part& part : parts) {
        if (part.maker == parts.front().maker) continue;
        warnings.push_back(part.name + " was made by " + to_text(part.maker) + ", but " + parts.front().name +
                           " by " + to_text(parts.front().maker));
    }
}

// The channels of all parts, in the order of the first; warns of those that some part lacks.
std::vector<std::string> common_channels(const std::vector<Part>& parts, std::vector<std::string>& warnings) {
    std::set<std::string> names;
    for (const Part& part : parts) {
        for (const Channel& channel : part.header.channels)
            names.insert(channel.name);
    }
    std::vector<std::string> common;
    for (const std::string& name : names) {
        const auto lacking =
            std::ranges::find_if(parts, [&](const Part& part) { return part.header.find(name) == nullptr; });
        if (!PartSum::knows(name)) {
            warnings.push_back("the channel " + name + " is left out: candela does not know how to merge it");
        } else if (lacking != parts.end()) {
            warnings.push_back("the channel " + name + " is left out: " + lacking->name +
                               " does not have it");
        } else {
            common.push_back(name);
        }
    }
    return common;
}

void warn_of_part(const Part& part, const std::vector<uint32_t>& counts, std::vector<std::string>& warnings) {
    const uint32_t least = std::ranges::min(counts);
    if (least < total_count(part.samples)) {
        warnings.push_back(part.name + " was interrupted: of the samples " + to_text(part.samples) +
                           " some pixels hold only " + std::to_string(least));
    }
    if (std::ranges::any_of(part.header.channels, &Channel::half)) {
        warnings.push_back(part.name +
                           " holds 16-bit floats: of its digits only three are right; render parts "
                           "without --half");
    }
}

// Positions depend on the scene alone, and differ between devices by rounding.
void check_positions(const Part& first, const Image& first_image, const Part& part, const Image& image,
                     const std::vector<std::string>& channels) {
    if (part.maker != first.maker) return;
    for (const char* name : {"P.X", "P.Y", "P.Z", "Z"}) {
        if (std::ranges::find(channels, name) == channels.end()) continue;
        const std::vector<float>& a = first_image.find(name)->values;
        const std::vector<float>& b = image.find(name)->values;
        if (std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) != 0) {
            refuse(part.name, std::string("its channel ") + name + " differs from that of " + first.name +
                                  "; give files as candela wrote them");
        }
    }
}

void set_attributes(Image& image, const std::vector<Part>& parts, uint64_t least) {
    image.attributes = parts.front().header.attributes;
    std::vector<SampleRange> samples;
    float seconds = 0.0f;
    const auto join = [](std::string& text, const std::string& word) {
        if (("; " + text + "; ").find("; " + word + "; ") == std::string::npos) text += "; " + word;
    };
    Maker maker = parts.front().maker;
    for (const Part& part : parts) {
        samples.insert(samples.end(), part.samples.begin(), part.samples.end());
        seconds += part.seconds;
        join(maker.device, part.maker.device);
        join(maker.driver, part.maker.driver);
        join(maker.version, part.maker.version);
    }
    samples = joined(samples);
    if (samples.empty()) samples.push_back({});
    set_maker(image, maker);
    image.attributes[SAMPLES] = to_text(samples);
    image.attributes[SPP] = float(least);
    image.attributes[SECONDS] = seconds;
}

}  // namespace

Merged merge_files(const std::vector<std::filesystem::path>& files,
                   const std::function<Image(const std::filesystem::path&)>& read) {
    std::vector<Part> parts;
    for (const std::filesystem::path& file : files)
        parts.push_back(describe(file, read(file)));
    std::ranges::sort(parts, {}, [](const Part& part) {
        return std::tuple(part.samples.front().first, part.samples.back().end, part.name);
    });
    const Part& first = parts.front();
    for (const Part& part : parts) {
        const std::string different = difference(part.identity, first.identity);
        if (!different.empty())
            refuse(part.name, "it does not belong with " + first.name + ": " + different +
                                  "; merge parts of one rendering");
    }
    refuse_overlaps(parts);

    Merged merged;
    warn_of_gaps(parts, merged.warnings);
    warn_of_makers(parts, merged.warnings);
    const std::vector<std::string> channels = common_channels(parts, merged.warnings);
    PartSum sum(first.header, channels);
    Image first_image;
    for (const Part& part : parts) {
        Image image = read(part.file);
        const std::vector<uint32_t> counts = sample_counts(image, part.name, part.samples);
        warn_of_part(part, counts, merged.warnings);
        sum.add(image, counts);
        if (&part == &first) {
            first_image = std::move(image);
        } else {
            check_positions(first, first_image, part, image, channels);
        }
    }
    merged.image = sum.image();
    set_attributes(merged.image, parts, std::ranges::min(sum.counts()));
    return merged;
}

}  // namespace candela
