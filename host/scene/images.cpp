// See images.h.
#include "scene/images.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "base/texel_io.h"

namespace candela {
namespace {

// The same for all names of a file.
std::filesystem::path identity_of(const std::filesystem::path& path) {
    std::error_code ignored;
    const std::filesystem::path real = std::filesystem::weakly_canonical(path, ignored);
    return real.empty() ? path.lexically_normal() : real;
}

}  // namespace

uint32_t add_image(Scene& scene, const std::filesystem::path& path, const std::string& place) {
    const std::filesystem::path real = identity_of(path);
    const auto known = std::ranges::find(scene.images, real, &ImageFile::real_path);
    if (known != scene.images.end()) return uint32_t(known - scene.images.begin());
    scene.images.push_back({.path = path, .real_path = real, .place = place, .image = {}});
    scene.files.push_back(path);
    return uint32_t(scene.images.size() - 1);
}

void load_images(Scene& scene) {
    std::vector<std::vector<std::string>> warnings(scene.images.size());
    parallel_for(scene.images.size(), [&](size_t i) {
        ImageFile& file = scene.images[i];
        if (!file.image.texels.empty()) return;
        try {
            file.image = read_texels(file.path, warnings[i]);
        } catch (const Error& error) {
            throw Error(file.place + ": " + error.what(), error.code());
        }
    });
    for (size_t i = 0; i < scene.images.size(); ++i) {
        for (const std::string& warning : warnings[i])
            scene.warnings.push_back(scene.images[i].place + ": " + warning);
    }
}

}  // namespace candela
