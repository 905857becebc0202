// See label_attributes.h.
#include "cli/label_attributes.h"

#include <nlohmann/json.hpp>

#include "cli/json_text.h"
#include "film/id_layers.h"
#include "image/cryptomatte.h"

namespace candela {
namespace {

using Json = nlohmann::ordered_json;

// Numbers by name.
Json numbers_of(const std::vector<std::string>& names) {
    Json::object_t numbers;
    numbers.reserve(names.size());
    for (size_t i = 0; i < names.size(); ++i)
        numbers.emplace_back(names[i], i + 1);
    return numbers;
}

// The numbers of the instances of each object, by its name, in the order of its copies.
Json instances_of(const Labels& labels) {
    std::vector<Json::array_t> instances(labels.objects.size());
    for (size_t i = 0; i < labels.instances.size(); ++i)
        instances[labels.instances[i].object - 1].emplace_back(i + 1);
    Json::object_t numbers;
    numbers.reserve(instances.size());
    for (size_t i = 0; i < instances.size(); ++i)
        numbers.emplace_back(labels.objects[i], std::move(instances[i]));
    return numbers;
}

void add_cryptomatte(Image& image, const char* layer, const std::vector<std::string>& names) {
    if (image.find(crypto_channel(layer, 0, false)) == nullptr) return;
    Json::object_t manifest;
    manifest.reserve(names.size());
    for (const std::string& name : names)
        manifest.emplace_back(name, crypto_text(crypto_id(name)));
    image.attributes[crypto_attribute(layer, "name")] = layer;
    image.attributes[crypto_attribute(layer, "hash")] = "MurmurHash3_32";
    image.attributes[crypto_attribute(layer, "conversion")] = "uint32_to_float32";
    image.attributes[crypto_attribute(layer, "manifest")] = json_line(manifest);
}

}  // namespace

void add_label_attributes(Image& image, const Labels& labels) {
    if (image.find(OBJECT_ID) != nullptr) {
        image.attributes[std::string(IDS_ATTRIBUTE)] =
            json_line(Json{{"objects", numbers_of(labels.objects)},
                           {"instances", instances_of(labels)},
                           {"materials", numbers_of(labels.materials)}});
    }
    add_cryptomatte(image, CRYPTO_OBJECT, labels.objects);
    add_cryptomatte(image, CRYPTO_MATERIAL, labels.materials);
}

}  // namespace candela
