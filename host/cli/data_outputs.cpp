// See data_outputs.h.
#include "cli/data_outputs.h"

#include <array>
#include <cmath>
#include <cstring>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "cli/arguments.h"
#include "cli/console.h"
#include "cli/json_text.h"
#include "film/id_layers.h"

namespace candela {
namespace {

constexpr Choices<LabelsOf, 3> LABELS_OF_NAMES{
    {{"objects", LabelsOf::objects}, {"instances", LabelsOf::instances}, {"materials", LabelsOf::materials}}};
constexpr Choices<DepthUnit, 2> DEPTH_UNIT_NAMES{
    {{"mm", DepthUnit::millimetre}, {"um", DepthUnit::micrometre}}};

constexpr const char* channel_of(LabelsOf labels_of) {
    switch (labels_of) {
        case LabelsOf::instances:
            return INSTANCE_ID;
        case LabelsOf::materials:
            return MATERIAL_ID;
        default:
            return OBJECT_ID;
    }
}

// The channel of that name, or an Error that names the file which needs it and the word of --aov.
const Channel& require(const DataFile& file, const Image& image, const char* channel, const char* aov) {
    if (const Channel* const found = image.find(channel)) return *found;
    throw Error(concat(file.option, ": ", quoted(file.name), " is made of the channel ", channel,
                       ", which the parts lack; render them with --aov ", aov, " among others"));
}

// The colour of a number, as the labels of PASCAL VOC have it: from the lowest bits up, three bits of the
// number give one each of red, green and blue, from the highest down. Different up to 2^24 - 1; 0 is black.
// Ref: Everingham et al., "The PASCAL Visual Object Classes Challenge 2012 Development Kit",
// VOClabelcolormap.
std::array<uint8_t, 3> label_colour(uint32_t number) {
    std::array<uint8_t, 3> colour{};
    for (uint32_t bit = 0; bit < 24; ++bit)
        colour[bit % 3] |= uint8_t((number >> bit & 1u) << (7 - bit / 3));
    return colour;
}

TexelImage labels_picture(const Image& image, const Channel& numbers) {
    TexelImage picture{.size = {image.data.width(), image.data.height()},
                       .channels = 3,
                       .type = TexelType::unorm8,
                       .texels = {},
                       .gamma = {}};
    picture.texels.reserve(3 * numbers.values.size());
    for (const float number : numbers.values) {
        for (const uint8_t part : label_colour(uint32_t(number)))
            picture.texels.push_back(std::byte(part));
    }
    return picture;
}

struct DepthPicture {
    TexelImage picture;
    size_t beyond = 0;  // Pixels whose depth the picture cannot hold.
};

// Depths in units of 1/`per_metre` m, rounded; 0 where nothing is, or what 16 bits cannot hold.
DepthPicture depth_picture(const Image& image, const Channel& depths, double per_metre) {
    DepthPicture result{.picture = {.size = {image.data.width(), image.data.height()},
                                    .channels = 1,
                                    .type = TexelType::unorm16,
                                    .texels = std::vector<std::byte>(2 * depths.values.size()),
                                    .gamma = {}}};
    for (size_t i = 0; i < depths.values.size(); ++i) {
        const double depth = std::round(double(depths.values[i]) * per_metre);
        const bool fits = depth >= 1.0 && depth <= 65535.0;
        if (!fits && std::isfinite(depths.values[i])) ++result.beyond;
        const auto value = uint16_t(fits ? depth : 0.0);
        std::memcpy(&result.picture.texels[2 * i], &value, sizeof value);
    }
    return result;
}

}  // namespace

void DataOutputs::add_to(CLI::App& app) {
    CLI::Option* const labels_file =
        app.add_option("--labels", labels,
                       "Write a PNG that gives each object a colour of its own; black: nothing")
            ->type_name("FILE");
    add_choice(app, "--labels-of", labels_of, LABELS_OF_NAMES, "What --labels tells apart (default: objects)")
        ->needs(labels_file);
    CLI::Option* const depth_file =
        app.add_option("--depth-png", depth,
                       "Write a grey 16-bit PNG of the depth Z, up to 65535 --depth-unit; 0: nothing, or "
                       "beyond")
            ->type_name("FILE");
    add_choice(app, "--depth-unit", depth_unit, DEPTH_UNIT_NAMES, "Unit of --depth-png (default: mm)")
        ->needs(depth_file);
    app.add_option("--manifest", manifest,
                   "Write the numbers and names of objects, instances and materials as JSON")
        ->type_name("FILE");
}

void DataOutputs::add_layers_to(AovSelection& aovs) const {
    aovs.ids |= labels || manifest;
    aovs.depth |= depth.has_value();
}

std::vector<DataFile> DataOutputs::files() const {
    std::vector<DataFile> files;
    if (labels) files.push_back({DataKind::labels, "--labels", *labels});
    if (depth) files.push_back({DataKind::depth, "--depth-png", *depth});
    if (manifest) files.push_back({DataKind::manifest, "--manifest", *manifest});
    return files;
}

void DataOutputs::rename(const std::string* names) {
    for (std::optional<std::string>* name : {&labels, &depth, &manifest}) {
        if (*name) *name = *names++;
    }
}

void DataOutputs::write(const DataFile& file, const Image& image, const PictureNotes& notes) const {
    if (file.kind == DataKind::manifest) {
        const auto ids = image.attributes.find(std::string(IDS_ATTRIBUTE));
        require(file, image, OBJECT_ID, "ids");
        if (ids == image.attributes.end()) return;
        const auto json = nlohmann::ordered_json::parse(std::get<std::string>(ids->second));
        return write_finished_work(file.name, json_text(json) + '\n');
    }
    if (file.kind == DataKind::labels) {
        const Channel& numbers = require(file, image, channel_of(labels_of), "ids");
        return write_picture(file.name, labels_picture(image, numbers), notes, write_finished_work);
    }
    const bool is_millimetre = depth_unit == DepthUnit::millimetre;
    const DepthPicture depths =
        depth_picture(image, require(file, image, "Z", "z"), is_millimetre ? 1e3 : 1e6);
    if (depths.beyond > 0) {
        print_warning(concat(quoted(file.name), ": ", depths.beyond,
                             depths.beyond == 1 ? " pixel shows" : " pixels show",
                             " what is not between 1 and 65535 ", name_of(depth_unit, DEPTH_UNIT_NAMES),
                             " away, and is 0 there",
                             is_millimetre ? "; the layer Z of an EXR has no limit"
                                           : "; --depth-unit mm reaches up to 65.535 m"));
    }
    PictureNotes with_unit = notes;
    with_unit.texts.emplace_back("candela.depthUnit", name_of(depth_unit, DEPTH_UNIT_NAMES));
    write_picture(file.name, depths.picture, with_unit, write_finished_work);
}

void check_data_name(const DataFile& file) {
    const std::string extension = file.kind == DataKind::manifest ? ".json" : ".png";
    if (extension_of(file.name) == extension) return;
    throw Error(concat(file.option, ": ", quoted(file.name), " must be a ", extension, " file"),
                ErrorKind::request);
}

}  // namespace candela
