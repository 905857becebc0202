// Files for programs that look at pictures: labels in colours, depths, and the names of what is in them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/file.h"
#include "film/accumulation.h"
#include "image/image.h"
#include "image/image_io.h"

namespace candela {

enum class LabelsOf { objects, instances, materials };
enum class DepthUnit { millimetre, micrometre };

enum class DataKind { labels, depth, manifest };

struct DataFile {
    DataKind kind;
    const char* option;
    std::string name;
};

struct DataOutputs {
    std::optional<std::string> labels{}, depth{}, manifest{};  // Names of files.
    LabelsOf labels_of = LabelsOf::objects;
    DepthUnit depth_unit = DepthUnit::millimetre;

    // Declares them on `app`; this object must not move.
    void add_to(CLI::App& app);

    // Adds the layers that they are made of to the selection.
    void add_layers_to(AovSelection& aovs) const;

    // Those that are asked for.
    std::vector<DataFile> files() const;
    // Gives them other names, in that order.
    void rename(const std::string* names);

    // Writes one of files() from the image's layers and attributes, as finished work. Throws Error if that
    // fails, or if the image lacks them. Warns of depths that the file cannot hold.
    void write(const DataFile& file, const Image& image, const PictureNotes& notes) const;
};

// Throws Error (usage) if the name has another extension than such a file must have.
void check_data_name(const DataFile& file);

}  // namespace candela
