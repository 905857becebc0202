// See id_layers.h.
#include "film/id_layers.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <string>
#include <vector>

#include "image/cryptomatte.h"

namespace candela {
namespace {

constexpr const char* NUMBERS[] = {OBJECT_ID, INSTANCE_ID, MATERIAL_ID};

// What a pixel shows under one number or id, and how many camera rays hit it.
struct Rank {
    uint32_t id;
    uint32_t hits;
};

// What a pixel shows by ids, id_of(part), the most covering first.
template <class IdOf>
void rank(std::span<const CoveredPart> parts, const IdOf& id_of, std::vector<Rank>& ranks) {
    ranks.clear();
    for (const auto& [part, hits] : parts) {
        const uint32_t id = id_of(part);
        const auto known = std::ranges::find(ranks, id, &Rank::id);
        if (known == ranks.end()) {
            ranks.push_back({id, hits});
        } else {
            known->hits += hits;
        }
    }
    std::ranges::sort(
        ranks, [](const Rank& a, const Rank& b) { return a.hits != b.hits ? a.hits > b.hits : a.id < b.id; });
}

template <class IdOf>
void add_numbers(Image& image, const char* channel, const Coverage& coverage, const IdOf& id_of) {
    std::vector<float>& values = image.add(channel).values;
    std::vector<Rank> ranks;
    for (size_t i = 0; i < values.size(); ++i) {
        rank(coverage.at(i), id_of, ranks);
        uint32_t nothing = FIRST_HITS;
        for (const Rank& shown : ranks)
            nothing -= shown.hits;
        if (!ranks.empty() && ranks.front().hits > nothing) values[i] = float(ranks.front().id);
    }
}

template <class IdOf>
void add_ranks(Image& image, const char* layer, const Coverage& coverage, const IdOf& id_of) {
    const size_t first = image.channels.size();
    for (uint32_t i = 0; i < CRYPTO_RANKS; ++i) {
        for (const bool is_coverage : {false, true})
            image.add(crypto_channel(layer, i, is_coverage));
    }
    std::vector<Rank> ranks;
    for (size_t i = 0; i < coverage.pixel_count(); ++i) {
        rank(coverage.at(i), id_of, ranks);
        ranks.resize(std::min<size_t>(ranks.size(), CRYPTO_RANKS));
        for (size_t k = 0; k < ranks.size(); ++k) {
            image.channels[first + 2 * k].values[i] = crypto_value(ranks[k].id);
            image.channels[first + 2 * k + 1].values[i] = float(ranks[k].hits) / float(FIRST_HITS);
        }
    }
}

std::vector<uint32_t> crypto_ids(const std::vector<std::string>& names) {
    std::vector<uint32_t> ids;
    ids.reserve(names.size());
    std::ranges::transform(names, std::back_inserter(ids), crypto_id);
    return ids;
}

}  // namespace

void add_id_layers(Image& image, const AovSelection& aovs, const Coverage& coverage, const Labels& labels) {
    assert(coverage.pixel_count() == image.pixel_count());
    const auto object = [&](ShapePart part) { return labels.shapes[part.shape].object + part.group; };
    const auto instance = [&](ShapePart part) { return labels.shapes[part.shape].instance + part.group; };
    const auto material = [&](ShapePart part) { return labels.shapes[part.shape].material; };
    if (aovs.ids) {
        add_numbers(image, OBJECT_ID, coverage, object);
        add_numbers(image, INSTANCE_ID, coverage, instance);
        add_numbers(image, MATERIAL_ID, coverage, material);
    }
    if (aovs.cryptomatte) {
        const std::vector<uint32_t> objects = crypto_ids(labels.objects);
        const std::vector<uint32_t> materials = crypto_ids(labels.materials);
        add_ranks(image, CRYPTO_OBJECT, coverage, [&](ShapePart part) { return objects[object(part) - 1]; });
        add_ranks(image, CRYPTO_MATERIAL, coverage,
                  [&](ShapePart part) { return materials[material(part) - 1]; });
    }
}

bool is_id_channel(std::string_view name) {
    return std::ranges::find(NUMBERS, name) != std::end(NUMBERS) || is_crypto_channel(name);
}

bool is_label_attribute(std::string_view name) {
    return name == IDS_ATTRIBUTE || name.starts_with(CRYPTO_PREFIX);
}

void drop_stray_label_attributes(Image& image) {
    const auto lacks = [&](const std::string& channel) { return image.find(channel) == nullptr; };
    std::erase_if(image.attributes, [&](const auto& attribute) {
        const std::string_view name = attribute.first;
        if (name == IDS_ATTRIBUTE) return lacks(OBJECT_ID) && lacks(INSTANCE_ID) && lacks(MATERIAL_ID);
        for (const char* layer : {CRYPTO_OBJECT, CRYPTO_MATERIAL}) {
            if (name.starts_with(crypto_attribute(layer, ""))) return lacks(crypto_channel(layer, 0, false));
        }
        return false;
    });
}

}  // namespace candela
