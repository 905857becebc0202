// Blender's own files, which only Blender can read: it exports them to glTF.
#pragma once

#include <filesystem>

#include "base/temporary_folder.h"

namespace candela {

// Whether a file's name says that it is Blender's.
bool is_blend_file(const std::filesystem::path& file);

// A scene of Blender as a glTF file, in a folder of its own that is removed with this object. Runs the
// program that the environment variable CANDELA_BLENDER names, a Blender, or a Python that has the module
// bpy; by default the `blender` on the PATH. Scripts in the file are not run.
class ExportedBlend {
  public:
    // Throws Error if the file cannot be exported, which says what to install if there is no such program.
    explicit ExportedBlend(const std::filesystem::path& file);

    std::filesystem::path gltf() const { return folder_.path() / "scene.glb"; }

  private:
    TemporaryFolder folder_;
};

}  // namespace candela
