// Merges parts of one rendering, each with different samples, into the image of all samples: `candela merge`.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "film/sample_range.h"
#include "image/image.h"
#include "image/image_io.h"

namespace candela {

struct Merged {
    Image image;
    std::vector<std::string>
        warnings;               // Oddities that can be merged: gaps, interrupted parts, other devices.
    bool had_denoised = false;  // Parts have denoised layers, which are left out.
};

// How the files of parts are read: first their headers, then, once, their values.
struct PartReader {
    std::function<Image(const std::filesystem::path&)> header = read_exr_header;
    std::function<Image(const std::filesystem::path&, const ImageLimits&)> image = read_exr;
};

// Merges EXR images by candela render: parts with the same identity whose samples do not overlap. Means are
// weighted by the pixels' sample counts; see PartSum, also for their precision. The image has the channels
// that all parts have, and the attributes of the part with the first samples, except that samples, time and
// makers are those of all parts. The order of the files does not change a bit. Throws Error if a file cannot
// be read, is not such a part, or does not belong with the others. Holds the values of one part at a time in
// memory.
Merged merge_files(const std::vector<std::filesystem::path>& files, const PartReader& read = {});

struct Missing {
    std::vector<SampleRange> samples;   // The wanted samples that are missing, ascending.
    std::vector<std::string> warnings;  // About files that cannot be read, and interrupted parts, in which
                                        // some pixels have fewer samples.
};

// The samples among `wanted` that no part holds for all pixels. A file that cannot be read holds none. Throws
// Error as merge_files() does, as far as headers show what is wrong.
Missing missing_samples(const std::vector<std::filesystem::path>& files, SampleRange wanted,
                        const PartReader& read = {});

}  // namespace candela
