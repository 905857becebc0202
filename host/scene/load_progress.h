// The progress of loading a scene.
#pragma once

#include <cstddef>
#include <functional>

namespace candela {

// Called while a scene is loaded, by one thread at a time, at every step: `done` of `of` things are done.
// `what` is their plural: "bytes" of a file, "shapes", "meshes" or "images". `of` is 0 if unknown.
using LoadProgress = std::function<void(const char* what, size_t done, size_t of)>;

inline void no_progress(const char*, size_t, size_t) {}

}  // namespace candela
