// What load_images() does besides reading files; see images.h.
#pragma once

#include "scene/images.h"
#include "scene/scene.h"

namespace candela {

// Whether an image is within the file that names it, as its name then says.
inline bool is_within(const ImageFile& file) {
    return file.place.starts_with(file.path.string());
}

// Drops missing images that may be missing, with one warning, and images out of reach, with another.
void drop_missing_images(Scene& scene, const ImageOptions& options);

// Chooses the channel of opacities that wait for their image, turns bump maps of mesh files into normal maps
// where they are some, and warns of normal maps that are none, and of opacities from images without alpha.
void check_maps(Scene& scene);

}  // namespace candela
