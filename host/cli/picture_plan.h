// The pictures that `candela render` is asked for: scenes, in frames, by cameras, to files. One picture is a
// plan of one.
#pragma once

#include <cstdint>
#include <istream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_files.h"
#include "cli/name_template.h"
#include "cli/render_options.h"
#include "scene/scene.h"

namespace candela {

struct Picture {
    std::string scene{};                  // Its file.
    std::optional<std::string> camera{};  // By name; none: the scene's first.
    uint32_t view = 0;                    // Its number among those of its scene, or of its frame.
    std::optional<uint32_t> frame{};      // Of an animation.
    std::vector<std::string> files{};     // Its images; empty as long as their names are not known.
};

// Whether all files of the picture are known, and there.
bool is_there(const Picture& picture);

// A scene, or a frame of one.
struct PlannedScene {
    std::string file{};
    size_t number = 0;                // Of the scene; its frames follow each other, with the same number.
    std::optional<uint32_t> frame{};  // None: no frame, or all, as long as it is not known which these are.
    std::vector<Picture> pictures{};  // Empty as long as it is not known how many there are.
};

class PicturePlan {
  public:
    // Throws Error (usage) if two pictures would have the same file, or one a file that is read; if the names
    // of files have unknown fields or formats; or for options that are for one picture if there may be more.
    // Throws Error if a list cannot be read, or a file could not be written. Refers to `options`.
    PicturePlan(const RenderOptions& options, std::istream& standard_input);

    const std::vector<PlannedScene>& scenes() const { return scenes_; }
    // Whether there may be several pictures. A list makes a batch, however long it is.
    bool is_batch() const { return is_batch_; }

    // Whether all pictures of the scenes from i on are known and there.
    bool is_complete_from(size_t i) const;

    // Makes scene i, which stands for all of its frames, the first of these; the others follow it.
    void set_frames(size_t i, const std::vector<uint32_t>& frames);

    // Names all pictures of scene i, which has been read. Throws Error (usage) as the constructor does.
    // Another thread may call this while there is no other call.
    std::vector<Picture> pictures_of(size_t i, const Scene& scene);

    // The file for the cameras of scene i, if one was asked for; its folders are made.
    std::optional<std::string> make_cameras_file(size_t i) const;

    // Makes the folders of a picture that fields name. Throws Error if that fails.
    void make_folders(const Picture& picture) const;

  private:
    // An output of a picture.
    struct Owner {
        size_t scene;  // PlannedScene::number.
        std::optional<uint32_t> frame;
        uint32_t view;
        size_t output;
        bool operator==(const Owner&) const = default;
    };
    void refuse_options_of_one() const;
    void plan_camera_files();
    void plan(PlannedScene& scene);
    void refuse_one_name_for(const char* thing, const char* field) const;
    NameFields fields(const Picture& picture) const;
    void name(const PlannedScene& scene, Picture& picture);
    void claim(const Owner& owner, const Picture& picture, const std::string& file);
    void check_folders() const;

    const RenderOptions& options_;
    bool is_batch_ = false;
    std::vector<NameTemplate> names_;
    std::vector<PlannedScene> scenes_;
    std::vector<std::string> scene_files_;  // By their numbers.
    CommandFiles files_;
    std::map<std::string, Owner> owners_;  // By file.
    std::optional<NameTemplate> cameras_name_;
};

}  // namespace candela
