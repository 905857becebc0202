// See load.h.
#include "load/load.h"

#include "load/json/loader.h"

namespace candela {

Scene load_scene(const std::filesystem::path& path) {
    return load_json_scene(path);
}

}  // namespace candela
