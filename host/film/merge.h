// Parts of one rendering, each of other samples, and the image of all of them: what `candela merge` does.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/image_io.h"
#include "film/sample_range.h"

namespace candela {

struct Merged {
    Image image;
    std::vector<std::string>
        warnings;  // Odd, but no reason to refuse: gaps, interrupted parts, other devices.
};

// How parts are read, by the names of their files: what they say of themselves, and then their values, once.
struct PartReader {
    std::function<Image(const std::filesystem::path&)> header = read_exr_header;
    std::function<Image(const std::filesystem::path&, const ImageLimits&)> image = read_exr;
};

// Merges EXR images as candela render writes them; parts of one identity whose samples do not overlap. Means
// are weighted by the pixels' sample counts; PartSum says how, and how exactly. The image has the channels
// that all parts have, and the attributes of the part with the first samples, but for those that speak of the
// samples. The same files in any order give the same bits. Throws Error, which says what is wrong with which
// file, if one cannot be read, is no such part, or does not belong with the others. Holds the values of one
// part at a time in memory.
Merged merge_files(const std::vector<std::filesystem::path>& files, const PartReader& read = {});

struct Missing {
    std::vector<SampleRange> samples;   // Of those wanted, ascending.
    std::vector<std::string> warnings;  // Of interrupted parts, some of whose pixels have fewer samples.
};

// Which of the samples `wanted` no part holds for all pixels. Reads headers alone. Throws Error as
// merge_files() does for what these tell.
Missing missing_samples(const std::vector<std::filesystem::path>& files, SampleRange wanted,
                        const PartReader& read = {});

}  // namespace candela
