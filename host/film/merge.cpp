// See merge.h.
#include "film/merge.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/printable.h"
#include "film/catcher_layers.h"
#include "film/id_layers.h"
#include "film/identity.h"
#include "film/part_sum.h"
#include "film/sample_range.h"

namespace candela {
namespace {

constexpr const char* SAMPLES = "candela.samples";
constexpr const char* SPP = "samplesPerPixel";
constexpr const char* SECONDS = "renderTimeSeconds";
constexpr const char* COUNT_CHANNEL = "SampleCount.V";
constexpr const char* DENOISED_LAYER = "Denoised.";

// The header of a file: the description of the part, and its channels without their values.
struct Part {
    std::filesystem::path file;
    std::string name;
    Identity identity;
    Maker maker;
    std::vector<SampleRange> samples;  // The samples that some pixel has.
    float seconds = 0.0f;
    Image header;
};

float number_attribute(const Image& image, const char* attribute) {
    const auto found = image.attributes.find(attribute);
    const auto* const number = found == image.attributes.end() ? nullptr : std::get_if<float>(&found->second);
    return number == nullptr ? 0.0f : *number;
}

std::string ranges_text(std::span<const SampleRange> samples) {
    return printable(to_text(samples), MAX_NAME_BYTES);
}

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
    throw Error(name + ": " + why);
}

// Samples of each pixel, by the channel SampleCount.V or, without that, by the attributes.
std::vector<uint32_t> sample_counts(const Image& image, const std::string& name,
                                    std::span<const SampleRange> samples) {
    const uint32_t max = total_count(samples);
    const Channel* const channel = image.find(COUNT_CHANNEL);
    if (channel == nullptr) {
        if (number_attribute(image, SPP) != float(max)) {
            refuse(
                name,
                "its pixels hold different numbers of samples, and it has no channel SampleCount.V to tell "
                "them; render such parts with --aov samples among others");
        }
        return std::vector<uint32_t>(image.pixel_count(), max);
    }
    std::vector<uint32_t> counts;
    counts.reserve(image.pixel_count());
    for (const float count : channel->values) {
        if (!(count >= 0.0f && count <= float(max)) || count != std::floor(count)) {
            refuse(name, "its channel SampleCount.V has the value " + std::to_string(count) +
                             ", but it says to hold " + std::to_string(max) +
                             " sample(s) per pixel at most; give files as candela wrote them");
        }
        counts.push_back(uint32_t(count));
    }
    return counts;
}

// Describes one file by its header. Throws Error if anything is wrong with the header.
Part describe(const std::filesystem::path& file, Image image) {
    Part part{.file = file, .name = file.string(), .identity = {}, .maker = {}, .samples = {}, .header = {}};
    part.identity = identity_of(image, part.name);
    part.maker = maker_of(image, part.name);
    for (const char* colour : {"R", "G", "B", "A"}) {
        if (image.find(colour) == nullptr) {
            refuse(part.name, std::string("it has no channel ") + colour +
                                  "; give images (-o), not checkpoints or other files");
        }
    }
    if (image.attributes.contains(ADAPTIVE_ATTRIBUTE)) {
        refuse(part.name,
               "it was rendered with --adaptive: its sample counts depend on the samples themselves; render "
               "parts "
               "with --samples");
    }
    const std::string samples = text_attribute(image, SAMPLES, part.name);
    const auto ranges = parse_ranges(samples);
    if (!ranges) {
        refuse(part.name, std::string("the attribute ") + SAMPLES + " is \"" +
                              printable(samples, MAX_NAME_BYTES) +
                              "\"; give a file that candela render wrote, unchanged");
    }
    part.samples = *ranges;
    part.seconds = number_attribute(image, SECONDS);
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

std::vector<SampleRange> samples_of(const std::vector<Part>& parts) {
    std::vector<SampleRange> all;
    for (const Part& part : parts)
        all.insert(all.end(), part.samples.begin(), part.samples.end());
    return joined(all);
}

void warn_of_makers(const std::vector<Part>& parts, std::vector<std::string>& warnings) {
    for (const Part& part : parts) {
        if (part.maker == parts.front().maker) continue;
        warnings.push_back(part.name + " was made by " + to_text(part.maker) + ", but " + parts.front().name +
                           " by " + to_text(parts.front().maker));
    }
}

// Whether the means without which a variance cannot be merged are there.
bool has_means(const std::string& name, const std::vector<std::string>& channels) {
    return std::ranges::all_of(PartSum::means_of(name), [&](const std::string& mean) {
        return std::ranges::find(channels, mean) != channels.end();
    });
}

// The channels that all parts have, sorted by name, so that means are before their variances; warns of
// channels that are left out.
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
        const std::string quoted_name = '"' + printable(name, MAX_NAME_BYTES) + '"';
        if (name.starts_with(DENOISED_LAYER)) continue;
        if (!PartSum::knows(name)) {
            warnings.push_back("the channel " + quoted_name +
                               " is left out: candela does not know how to merge it");
        } else if (lacking != parts.end()) {
            warnings.push_back("the channel " + quoted_name + " is left out: " + lacking->name +
                               " does not have it");
        } else if (!has_means(name, common)) {
            warnings.push_back("the channel " + quoted_name +
                               " is left out: the channels whose variance it is are missing");
        } else {
            common.push_back(name);
        }
    }
    return common;
}

// `min`: the samples of the pixel that has fewest.
void warn_of_interruption(const Part& part, uint32_t min, std::vector<std::string>& warnings) {
    if (min < total_count(part.samples)) {
        warnings.push_back(part.name + " was interrupted: of the samples " + ranges_text(part.samples) +
                           " some pixels hold only " + std::to_string(min));
    }
}

void warn_of_halves(const Part& part, std::vector<std::string>& warnings) {
    if (std::ranges::any_of(part.header.channels, &Channel::half)) {
        warnings.push_back(part.name +
                           " holds 16-bit floats: only three of its digits are right; render parts "
                           "without --half");
    }
}

// What depends on no sample depends on the scene and the seed alone; between devices it differs by rounding.
void check_constants(const Part& first, const Image& first_image, const Part& part, const Image& image) {
    if (part.maker != first.maker) return;
    for (const Channel& a : first_image.channels) {
        const Channel* const b = image.find(a.name);
        if (b == nullptr || a.values.empty() || b->values.empty()) continue;
        if (std::memcmp(a.values.data(), b->values.data(), a.values.size() * sizeof(float)) != 0) {
            refuse(part.name, "its channel " + a.name + " differs from that of " + first.name +
                                  "; give files as candela wrote them");
        }
    }
}

// Throws Error if the parts call things by other names or numbers.
void check_labels(const Part& first, const Part& part) {
    for (const auto& [name, labels] : first.header.attributes) {
        if (!is_label_attribute(name)) continue;
        const auto found = part.header.attributes.find(name);
        if (found == part.header.attributes.end() || found->second == labels) continue;
        refuse(part.name, "it calls objects or materials by other names or numbers than " + first.name +
                              " (the attribute " + name + "); merge parts of one rendering");
    }
}

// Reads a part's values of those channels, and its sample counts.
Image read_values(const Part& part, const std::vector<std::string>& channels, const PartReader& read) {
    ImageLimits limits{.channels = {COUNT_CHANNEL}};
    limits.channels.insert(limits.channels.end(), channels.begin(), channels.end());
    Image image = read.image(part.file, limits);
    if (!difference(identity_of(image, part.name), part.identity).empty() ||
        text_attribute(image, SAMPLES, part.name) != text_attribute(part.header, SAMPLES, part.name) ||
        !std::ranges::equal(image.channels, part.header.channels, {}, &Channel::name, &Channel::name))
        refuse(part.name, "it was changed while it was merged; merge again");
    return image;
}

void set_attributes(Image& image, const std::vector<Part>& parts, uint64_t min) {
    image.attributes = parts.front().header.attributes;
    std::vector<SampleRange> samples = samples_of(parts);
    float seconds = 0.0f;
    const auto join = [](std::string& text, const std::string& word) {
        if (("; " + text + "; ").find("; " + word + "; ") == std::string::npos) text += "; " + word;
    };
    Maker maker = parts.front().maker;
    for (const Part& part : parts) {
        seconds += part.seconds;
        join(maker.device, part.maker.device);
        join(maker.driver, part.maker.driver);
        join(maker.version, part.maker.version);
    }
    if (samples.empty()) samples.push_back({});
    set_maker(image, maker);
    image.attributes[SAMPLES] = to_text(samples);
    image.attributes[SPP] = float(min);
    image.attributes[SECONDS] = seconds;
}

// Describes all files, sorted by their samples. Throws Error if they do not belong together.
std::vector<Part> describe_all(const std::vector<std::filesystem::path>& files, const PartReader& read) {
    std::vector<Part> parts;
    for (const std::filesystem::path& file : files)
        parts.push_back(describe(file, read.header(file)));
    std::ranges::sort(parts, {}, [](const Part& part) {
        return std::tuple(part.samples.front().first, part.samples.back().end, part.name);
    });
    for (const Part& part : parts) {
        const std::string different = difference(part.identity, parts.front().identity);
        if (!different.empty())
            refuse(part.name, "it does not belong with " + parts.front().name + ": " + different +
                                  "; merge parts of one rendering");
    }
    refuse_overlaps(parts);
    for (const Part& part : parts)
        check_labels(parts.front(), part);
    return parts;
}

}  // namespace

Merged merge_files(const std::vector<std::filesystem::path>& files, const PartReader& read) {
    const std::vector<Part> parts = describe_all(files, read);
    const Part& first = parts.front();
    Merged merged;
    const std::vector<SampleRange> samples = samples_of(parts);
    const std::vector<SampleRange> missing = gaps(samples, {0, samples.empty() ? 0 : samples.back().end});
    if (!missing.empty())
        merged.warnings.push_back("the samples " + ranges_text(missing) + " are missing: no part holds them");
    warn_of_makers(parts, merged.warnings);
    const std::vector<std::string> channels = common_channels(parts, merged.warnings);
    merged.had_denoised = std::ranges::any_of(parts, [](const Part& part) {
        return std::ranges::any_of(part.header.channels, [](const Channel& channel) {
            return channel.name.starts_with(DENOISED_LAYER);
        });
    });
    PartSum sum(first.header, channels);
    Image first_image;  // Only what is the same in all parts.
    for (const Part& part : parts) {
        Image image = read_values(part, channels, read);
        const std::vector<uint32_t> counts = sample_counts(image, part.name, part.samples);
        warn_of_interruption(part, std::ranges::min(counts), merged.warnings);
        warn_of_halves(part, merged.warnings);
        sum.add(image, counts);
        check_constants(first, first_image, part, image);
        if (&part == &first) {
            std::erase_if(image.channels,
                          [](const Channel& channel) { return !PartSum::is_constant(channel.name); });
            first_image = std::move(image);
        }
    }
    merged.image = sum.image();
    set_catcher_alpha(merged.image);
    set_attributes(merged.image, parts, std::ranges::min(sum.counts()));
    drop_stray_label_attributes(merged.image);
    return merged;
}

Missing missing_samples(const std::vector<std::filesystem::path>& files, SampleRange wanted,
                        const PartReader& read) {
    Missing missing;
    std::vector<std::filesystem::path> readable;
    for (const std::filesystem::path& file : files) {
        try {
            // A damaged file may have an intact header, so everything is decoded, although few values are
            // kept.
            read.image(file, {.channels = {COUNT_CHANNEL}});
            readable.push_back(file);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::other) throw;
            missing.warnings.push_back(std::string("a part is left out: ") + error.what());
        }
    }
    const std::vector<Part> parts = describe_all(readable, read);
    std::vector<SampleRange> complete;
    for (const Part& part : parts) {
        const float number = number_attribute(part.header, SPP);
        const uint32_t min = number >= 0.0f && number <= float(MAX_SPP) ? uint32_t(number) : 0;
        warn_of_interruption(part, min, missing.warnings);
        if (min >= total_count(part.samples)) {
            complete.insert(complete.end(), part.samples.begin(), part.samples.end());
        } else if (part.samples.size() == 1) {
            complete.push_back({part.samples[0].first, part.samples[0].first + min});
        }  // With several ranges, nothing says which samples are missing.
    }
    missing.samples = gaps(complete, wanted);
    return missing;
}

}  // namespace candela
