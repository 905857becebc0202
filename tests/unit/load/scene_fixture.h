// What the tests of scene files share: a folder to write scenes to, and errors whose place is marked in the
// text.
#pragma once

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>

#include "load/load.h"
#include "scene/mesh.h"
#include "unit/base/base_fixture.h"

namespace candela {

// Removes the one '@' from `text` and returns where it stood, as `line:column`.
inline std::string take_mark(std::string& text) {
    const size_t mark = text.find('@');
    if (mark == std::string::npos) throw std::logic_error("no @ in: " + text);
    text.erase(mark, 1);
    const auto begin = text.begin();
    const auto lines = std::count(begin, begin + std::ptrdiff_t(mark), '\n');
    const size_t line_begin = mark == 0 ? std::string::npos : text.rfind('\n', mark - 1);
    const size_t column = mark - (line_begin == std::string::npos ? 0 : line_begin + 1) + 1;
    return std::to_string(lines + 1) + ':' + std::to_string(column);
}

class SceneFolder {
  public:
    void write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }

    Scene load(const std::string& text, const ImageOptions& images = {},
               const LoadProgress& progress = no_progress) {
        write("scene.json", text);
        return load_scene(folder_ / "scene.json",
                          {.images = images, .progress = progress, .reach = {.anywhere = true}});
    }

    // Loads a scene that has an error at its '@', and checks the message after `scene.json:line:column: `.
    void expect_error(std::string text, const std::string& message) {
        SCOPED_TRACE(text);
        const std::string place = take_mark(text);
        EXPECT_EQ(without_folder(error_of([&] { load(text); })), "scene.json:" + place + ": " + message);
    }

    // Loads a scene that is odd at its '@', and checks its only warning, after `scene.json:line:column: `.
    void expect_warning(std::string text, const std::string& message) {
        SCOPED_TRACE(text);
        const std::string place = take_mark(text);
        const Scene scene = load(text);
        ASSERT_EQ(scene.warnings.size(), 1u);
        EXPECT_EQ(without_folder(scene.warnings[0]), "scene.json:" + place + ": " + message);
    }

    std::string without_folder(std::string message) const {
        const std::string prefix = (folder_.path() / "").string();
        for (size_t at = message.find(prefix); at != std::string::npos; at = message.find(prefix)) {
            message.erase(at, prefix.size());
        }
        return message;
    }

    const std::filesystem::path& path() const { return folder_.path(); }

  private:
    TemporaryDirectory folder_;
};

// The mesh of a shape, in world space. Throws if the shape is something else.
inline TriangleMesh world_mesh(const Scene& scene, size_t shape = 0) {
    const auto& instance = std::get<MeshInstance>(scene.shapes.at(shape).geometry);
    return placed(scene.meshes.at(instance.mesh), instance.transform);
}

// A camera for scenes in which another part is under test.
inline const std::string GOOD_CAMERA =
    R"("cameras": {"main": {"position": [0, 0, 5], "look_at": [0, 0, 0], "vertical_fov": 40}})";

// A scene with these members and without shapes.
inline std::string settings(const std::string& members) {
    return "{" + members + ",\n\"shapes\": []}";
}

// A valid scene with these shapes; `mark`, unless it is 0, stands before their list.
inline std::string scene_of(const std::string& shapes, char mark = '\0') {
    return "{" + GOOD_CAMERA + R"(,
"materials": {"glass": {"type": "diffuse", "reflectance": 1}, "white": {"type": "diffuse", "reflectance": 0.5}},
"shapes": )" +
           (mark == '\0' ? "" : std::string(1, mark)) + '[' + shapes + "]}";
}

}  // namespace candela
