// See label_scene.h.
#include "scene/label_scene.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>
#include <variant>

#include "base/error.h"
#include "base/printable.h"
#include "base/text.h"
#include "image/cryptomatte.h"
#include "scene/unique_names.h"

namespace candela {
namespace {

class Labeller {
  public:
    explicit Labeller(const Scene& scene) : scene_(scene) {}

    Labels label() {
        name_materials();
        for (const std::string& name : scene_.objects)
            names_.note(utf8(name));
        labels_.shapes.reserve(scene_.shapes.size());
        count_groups();
        for (const Shape& shape : scene_.shapes) {
            const uint32_t object = object_of(shape);
            labels_.shapes.push_back({object, instance_of(shape, object), shape.material + 1});
        }
        check_label_count(labels_.objects.size(), "objects");
        check_label_count(labels_.instances.size(), "instances");
        check_label_count(labels_.materials.size(), "materials");
        return std::move(labels_);
    }

  private:
    void name_materials() {
        UniqueNames names;
        for (const Material& material : scene_.materials) {
            const std::string name = utf8(material.name);
            labels_.materials.push_back(
                names.choose(name.empty() ? concat("material ", labels_.materials.size()) : name));
        }
    }

    // How many objects have the mesh of that shape in common, for those of which it is the first.
    void count_groups() {
        for (const Shape& shape : scene_.shapes) {
            uint32_t& count = groups_.try_emplace(shape.object, 1).first->second;
            const auto* const instance = std::get_if<MeshInstance>(&shape.geometry);
            if (instance == nullptr || shape.object == NO_OBJECT) continue;
            for (const uint32_t group : scene_.meshes[instance->mesh].groups)
                count = std::max(count, group + 1);
        }
    }

    uint32_t object_of(const Shape& shape) {
        std::vector<std::string>& objects = labels_.objects;
        const auto number = uint32_t(objects.size() + 1);
        if (shape.object == NO_OBJECT) {
            objects.push_back(names_.choose(concat("shape ", labels_.shapes.size())));
            return number;
        }
        const auto [known, is_new] = objects_.try_emplace(shape.object, number);
        for (uint32_t i = 0; is_new && i < groups_.at(shape.object); ++i)
            objects.push_back(utf8(scene_.objects[shape.object + i]));
        return known->second;
    }

    uint32_t instance_of(const Shape& shape, uint32_t object) {
        std::vector<LabelledInstance>& instances = labels_.instances;
        const auto [known, is_new] =
            instances_.try_emplace({object, shape.copy}, uint32_t(instances.size() + 1));
        for (uint32_t i = 0; is_new && i < groups_.at(shape.object); ++i)
            instances.push_back({object + i, shape.copy});
        return known->second;
    }

    const Scene& scene_;
    UniqueNames names_;
    std::unordered_map<uint32_t, uint32_t> groups_;                // Objects in a row, by index of the first.
    std::unordered_map<uint32_t, uint32_t> objects_;               // Numbers, by index into Scene::objects.
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> instances_;  // Numbers, by object and copy.
    Labels labels_;
};

}  // namespace

Labels label_scene(const Scene& scene) {
    return Labeller(scene).label();
}

void check_label_count(size_t count, const char* things) {
    if (count <= MAX_LABEL) return;
    throw Error(concat("the scene has ", count, ' ', things, ", and pictures of ids can number ", MAX_LABEL,
                       " at most; leave out the layers of ids (--aov, --labels, --manifest)"));
}

std::vector<std::string> warnings_of_collisions(const std::vector<std::string>& names, const char* things) {
    std::map<uint32_t, std::vector<std::string>> same;
    std::unordered_map<uint32_t, const std::string*> first;
    for (const std::string& name : names) {
        const uint32_t id = crypto_id(name);
        const auto [known, is_new] = first.try_emplace(id, &name);
        if (is_new) continue;
        if (same[id].empty()) same[id].push_back(*known->second);
        same[id].push_back(name);
    }
    std::vector<std::string> warnings;
    for (const auto& [id, alike] : same) {
        warnings.push_back(concat("the ", things, " ", joined(alike),
                                  " have the same Cryptomatte id, and are one matte; rename all but one"));
    }
    return warnings;
}

}  // namespace candela
