// Parts of one rendering, each of other samples, and the image of all of them: what `candela merge` does.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/image_io.h"

namespace candela {

struct Merged {
    Image image;
    std::vector<std::string>
        warnings;  // Odd, but no reason to refuse: gaps, interrupted parts, other devices.
};

// Merges EXR images as candela render writes them; parts of one identity whose samples do not overlap. Means
// are weighted by the pixels' sample counts; PartSum says how, and how exactly. The image has the channels
// that all parts have, and the attributes of the part with the first samples, but for those that speak of the
// samples. The same files in any order give the same bits. Throws Error, which says what is wrong with which
// file, if one cannot be read, is no such part, or does not belong with the others. Holds two parts at a
// time in memory: `read` reads each once to check it, and once to add it.
Merged merge_files(
    const std::vector<std::filesystem::path>& files,
    const std::function<Image(const std::filesystem::path&)>& read = [](const auto& file) {
        return read_exr(file);
    });

}  // namespace candela
