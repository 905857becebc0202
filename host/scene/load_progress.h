// How far the loading of a scene has got.
#pragma once

#include <cstddef>
#include <functional>

namespace candela {

// Called while a scene is loaded, by one thread at a time, whenever there is news: `done` of `of` things are
// done, of which `what` is the plural: "bytes" of a file, "shapes", "meshes" or "images". `of` is 0 where
// nobody knows.
using LoadProgress = std::function<void(const char* what, size_t done, size_t of)>;

inline void no_progress(const char*, size_t, size_t) {}

}  // namespace candela
