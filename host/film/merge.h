// Merges parts of one rendering, each with samples of its own, into the image of all samples: `candela
// merge`.
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
        warnings;  // Odd, but no reason to refuse: gaps, interrupted parts, other devices.
};

// How the files of parts are read: first their headers, then, once, their values.
struct PartReader {
    std::function<Image(const std::filesystem::path&)> header = read_exr_header;
    std::function<Image(const std::filesystem::path&, const ImageLimits&)> image = read_exr;
};

// Merges EXR images by candela render: parts with the same identity whose samples do not overlap. Means are
// weighted by the pixels' sample counts; PartSum says how, and how exact they are. The image has the channels
// that all parts have, and the attributes of the part with the first samples, except for the samples, the
// time and the makers, which are those of all parts. The order of the files changes no bit. Throws Error that
// says what is wrong with which file if one cannot be read, is not such a part, or does not belong with the
// others. Holds the values of one part at a time in memory.
Merged merge_files(const std::vector<std::filesystem::path>& files, const PartReader& read = {});

struct Missing {
    std::vector<SampleRange> samples;  // Of those wanted, ascending.
    std::vector<std::string>
        warnings;  // Of files that cannot be read, and of interrupted parts, some of whose pixels have fewer.
};

// The samples among `wanted` that no part holds for all pixels. A file that cannot be read holds none. Throws
// Error as merge_files() does, as far as headers show what is wrong.
Missing missing_samples(const std::vector<std::filesystem::path>& files, SampleRange wanted,
                        const PartReader& read = {});

}  // namespace candela
