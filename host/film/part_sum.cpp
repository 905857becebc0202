// See part_sum.h.
#include "film/part_sum.h"

#include <algorithm>
#include <cassert>
#include <string_view>
#include <utility>

#include "film/accumulation.h"
#include "film/catcher_layers.h"
#include "film/id_layers.h"

namespace candela {

static constexpr std::string_view VARIANCE = "Variance.";
static constexpr std::string_view MEANS[] = {"R",
                                             "G",
                                             "B",
                                             "A",
                                             "Albedo.R",
                                             "Albedo.G",
                                             "Albedo.B",
                                             "N.X",
                                             "N.Y",
                                             "N.Z",
                                             DENOISING_ALBEDO[0],
                                             DENOISING_ALBEDO[1],
                                             DENOISING_ALBEDO[2],
                                             DENOISING_NORMAL[0],
                                             DENOISING_NORMAL[1],
                                             DENOISING_NORMAL[2],
                                             FIRST_HIT_ALPHA,
                                             CATCHER_ALPHA,
                                             FOREGROUND_ALPHA,
                                             CATCHER_WITH[0],
                                             CATCHER_WITH[1],
                                             CATCHER_WITH[2],
                                             CATCHER_WITHOUT[0],
                                             CATCHER_WITHOUT[1],
                                             CATCHER_WITHOUT[2]};
static constexpr std::string_view VARIANCES[] = {"Variance.R", "Variance.G", "Variance.B",
                                                 DENOISING_ALBEDO_VARIANCE};
static constexpr std::string_view CONSTANTS[] = {"P.X", "P.Y", "P.Z", "Z", "Depth.V", "Motion.X", "Motion.Y"};
static constexpr std::string_view COUNT = "SampleCount.V";

template <size_t N>
static bool contains(const std::string_view (&names)[N], const std::string& name) {
    return std::ranges::find(names, name) != std::end(names);
}

bool PartSum::knows(const std::string& channel) {
    return contains(MEANS, channel) || contains(VARIANCES, channel) || is_constant(channel) ||
           channel == COUNT;
}

bool PartSum::is_constant(const std::string& channel) {
    return contains(CONSTANTS, channel) || is_id_channel(channel);
}

std::vector<std::string> PartSum::means_of(const std::string& variance) {
    if (variance == DENOISING_ALBEDO_VARIANCE) return {DENOISING_ALBEDO.begin(), DENOISING_ALBEDO.end()};
    if (contains(VARIANCES, variance)) return {variance.substr(VARIANCE.size())};
    return {};
}

PartSum::Kind PartSum::kind_of(const std::string& channel) {
    assert(knows(channel));
    if (contains(MEANS, channel)) return Kind::mean;
    if (contains(VARIANCES, channel)) return Kind::variance;
    return channel == COUNT ? Kind::count : Kind::constant;
}

PartSum::PartSum(const Image& like, std::vector<std::string> channels)
    : full_(like.full), data_(like.data), counts_(like.pixel_count()) {
    for (std::string& name : channels) {
        const Kind kind = kind_of(name);
        Sum sum{.name = std::move(name), .kind = kind, .values = {}, .samples = {}};
        if (kind != Kind::count) sum.values.resize(like.pixel_count());
        if (kind == Kind::variance)
            sum.samples.assign(means_of(sum.name).size(), std::vector<double>(like.pixel_count()));
        sums_.push_back(std::move(sum));
    }
}

void PartSum::add_mean(Sum& sum, const Channel& channel, const std::vector<uint32_t>& counts) const {
    for (size_t i = 0; i < counts.size(); ++i)
        sum.values[i] += counts[i] * double(channel.values[i]);
}

void PartSum::add_variance(Sum& sum, const Image& part, const std::vector<uint32_t>& counts) const {
    const std::vector<float>& variances = part.find(sum.name)->values;
    for (size_t i = 0; i < counts.size(); ++i) {
        const double n = counts[i];
        if (n > 1.0) sum.values[i] += double(variances[i]) * n * (n - 1.0);  // Infinite for one sample.
    }
    const std::vector<std::string> names = means_of(sum.name);
    for (size_t c = 0; c < names.size(); ++c) {
        const std::vector<float>& means = part.find(names[c])->values;
        std::vector<double>& samples = sum.samples[c];
        for (size_t i = 0; i < counts.size(); ++i) {
            const double n = counts[i];
            if (n == 0.0) continue;
            const auto before = double(counts_[i]);
            if (before > 0.0) {
                const double difference = double(means[i]) - samples[i] / before;
                sum.values[i] += difference * difference * (before * n / (before + n));
            }
            samples[i] += n * double(means[i]);
        }
    }
}

void PartSum::add(const Image& part, const std::vector<uint32_t>& counts) {
    assert(part.data == data_ && counts.size() == counts_.size());
    const bool first = std::ranges::all_of(counts_, [](uint64_t n) { return n == 0; });
    for (Sum& sum : sums_) {
        const Channel& channel = *part.find(sum.name);
        if (sum.kind == Kind::mean) add_mean(sum, channel, counts);
        if (sum.kind == Kind::variance) add_variance(sum, part, counts);
        if (sum.kind == Kind::constant && first)
            sum.values.assign(channel.values.begin(), channel.values.end());
    }
    for (size_t i = 0; i < counts.size(); ++i)
        counts_[i] += counts[i];
}

Image PartSum::image() const {
    Image image{.full = full_, .data = data_, .channels = {}, .attributes = {}};
    for (const Sum& sum : sums_) {
        Channel& channel = image.add(sum.name);
        for (size_t i = 0; i < counts_.size(); ++i) {
            const auto n = double(counts_[i]);
            double value = n;
            if (sum.kind == Kind::mean) value = n > 0.0 ? sum.values[i] / n : 0.0;
            if (sum.kind == Kind::variance)
                value = n > 1.0 ? sum.values[i] / (n * (n - 1.0)) : double(INFINITE);
            if (sum.kind == Kind::constant) value = sum.values[i];
            channel.values[i] = float(value);
        }
    }
    return image;
}

}  // namespace candela
