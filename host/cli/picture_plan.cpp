// See picture_plan.h.
#include "cli/picture_plan.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/printable.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/scene_list.h"

namespace candela {
namespace {

[[noreturn]] void refuse_pictures(const std::string& message) {
    throw Error(message, ErrorKind::request);
}

// A picture, for messages.
std::string text_of(const Picture& picture) {
    return candela::quoted(picture.scene) +
           (picture.frame ? " in frame " + std::to_string(*picture.frame) : "") +
           (picture.camera ? " by the camera \"" + printable(*picture.camera, MAX_NAME_BYTES) + '"' : "");
}

void make_folder_of(const std::string& file) {
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    std::error_code error;
    if (!folder.empty()) std::filesystem::create_directories(folder, error);
    if (error) {
        throw Error("cannot make the folder " + quoted(folder) + ": " + error.message() +
                    "; choose another place");
    }
}

}  // namespace

bool is_there(const Picture& picture) {
    return !picture.files.empty() && std::ranges::all_of(picture.files, [](const std::string& file) {
        std::error_code ignored;
        return std::filesystem::is_regular_file(file, ignored);
    });
}

PicturePlan::PicturePlan(const RenderOptions& options, std::istream& standard_input) : options_(options) {
    const OutputOptions& outputs = options.outputs;
    const SceneList list = list_scenes(options.list.scenes, standard_input);
    is_batch_ = list.is_list || list.scenes.size() > 1 || options.list.cameras.size() > 1 ||
                options.wants_all_cameras() || options.frames.are_several();
    if (is_batch_) refuse_options_of_one();
    check_formats(outputs.images);
    for (const auto& [option, name] : outputs.images.outputs())
        names_.emplace_back(name, option);

    for (const std::string& path : list.lists)
        files_.read("the list", path);
    for (const std::string& path : list.scenes)
        files_.read("SCENE", path);
    if (outputs.reference) files_.read("--reference", *outputs.reference);
    if (const auto background = outputs.images.screen.background_file())
        files_.read("--background", *background);
    if (options.rendering.loading.gltf.animation && !options.rendering.loading.gltf.time &&
        !options.frames.frames)
        refuse_pictures("--animation: it is not shown without a time; also give --time or --frames");
    if (outputs.images.aovs.motion && !options.frames.frames)
        refuse_pictures("--aov: motion is that since the frame before; also give --frames");
    if (options.wants_all_cameras()) refuse_one_name_for("camera", "camera");
    if (options.frames.are_several()) refuse_one_name_for("frame", "frame");
    scene_files_ = list.scenes;
    for (size_t i = 0; i < scene_files_.size(); ++i) {
        const bool has_frames = options.frames.frames && !options.frames.wants_all();
        for (const uint32_t frame : has_frames ? *options.frames.frames : std::vector<uint32_t>{0}) {
            scenes_.push_back({.file = scene_files_[i],
                               .number = i,
                               .frame = has_frames ? std::optional(frame) : std::nullopt});
            plan(scenes_.back());
        }
    }
    if (outputs.report == STDOUT && outputs.images.uses_stdout())
        refuse_pictures("--report and -o both go to standard output; give one of them a file");
    if (outputs.report) files_.write("--report", *outputs.report);
    if (options.checkpoint.file) files_.write("--checkpoint", *options.checkpoint.file);
    options.cameras.check(files_);
    if (options.cameras.written) plan_camera_files();
    if (is_batch_) check_folders();
}

void PicturePlan::refuse_options_of_one() const {
    constexpr const char* ONE = ": cannot be used for several pictures; ";
    const std::optional<std::string>& report = options_.outputs.report;
    if (options_.checkpoint.file)
        refuse_pictures(std::string("--checkpoint") + ONE +
                        "--skip-existing goes on with an interrupted batch");
    if (options_.outputs.write_every)
        refuse_pictures(std::string("--write-every") + ONE +
                        "leave it out: each picture is written when it is done");
    if (options_.outputs.reference)
        refuse_pictures(std::string("--reference") + ONE + "render the picture that it belongs to alone");
    if (report && *report != "-" && !Report::is_lines(*report)) {
        refuse_pictures(
            "--report: several pictures need a line each; give a name that ends in .jsonl instead of " +
            candela::quoted(*report));
    }
}

// Throws Error (usage) if two scenes would have the same file of cameras.
void PicturePlan::plan_camera_files() {
    const std::string& text = *options_.cameras.written;
    cameras_name_.emplace(text, "--write-cameras");
    if (cameras_name_->uses("view") || cameras_name_->uses("camera")) {
        refuse_pictures("--write-cameras: " + candela::quoted(text) +
                        " is one file for all pictures of a scene; leave {camera} and {view} out");
    }
    if (options_.frames.are_several() && !cameras_name_->uses("frame")) {
        refuse_pictures("--write-cameras: " + candela::quoted(text) +
                        " would hold the cameras of each frame; add the field {frame}");
    }
    std::map<std::string, std::string> scenes;  // By file.
    for (const PlannedScene& scene : scenes_) {
        const std::string file =
            cameras_name_->open_name(fields({.scene = scene.file, .frame = scene.frame}));
        const auto [other, is_new] = scenes.emplace(file, scene.file);
        if (!is_new) {
            refuse_pictures("--write-cameras: " + candela::quoted(file) +
                            " would hold the cameras of two scenes, of " + candela::quoted(other->second) +
                            " and of " + candela::quoted(scene.file) +
                            "; tell them apart by fields in the name, such as {stem} or {folder}");
        }
        files_.write("--write-cameras", file);
        if (!cameras_name_->names_folders()) check_writable(file);
    }
}

// Throws Error (usage) if a name does not tell the cameras or frames of a scene apart.
void PicturePlan::refuse_one_name_for(const char* thing, const char* field) const {
    const bool may_be_view = std::string_view(field) == "camera";
    for (const NameTemplate& name : names_) {
        if (name.uses(field) || (may_be_view && name.uses("view"))) continue;
        refuse_pictures(std::string(name.option()) + ": \"" + name.text() +
                        "\" would be the picture of each " + thing + "; add the field {" + field + '}' +
                        (may_be_view ? " or {view}" : ""));
    }
}

// Lists the pictures of a scene, and names them as far as they are known before it is read.
void PicturePlan::plan(PlannedScene& scene) {
    const ListOptions& list = options_.list;
    for (const std::string& camera : list.cameras)
        scene.pictures.push_back({scene.file, camera, uint32_t(scene.pictures.size()), scene.frame});
    if (list.cameras.empty()) scene.pictures.push_back({.scene = scene.file, .frame = scene.frame});
    for (Picture& picture : scene.pictures)
        name(scene, picture);
    if (options_.wants_all_cameras()) scene.pictures.clear();
}

void PicturePlan::set_frames(size_t i, const std::vector<uint32_t>& frames) {
    std::vector<PlannedScene> all;
    for (const uint32_t frame : frames) {
        all.push_back({.file = scenes_[i].file, .number = scenes_[i].number, .frame = frame});
        plan(all.back());
    }
    const auto place = scenes_.erase(scenes_.begin() + std::ptrdiff_t(i));
    scenes_.insert(place, all.begin(), all.end());
}

NameFields PicturePlan::fields(const Picture& picture) const {
    NameFields fields = fields_of(picture.scene);
    fields.camera = picture.camera;
    fields.scene = options_.rendering.loading.gltf.scene;
    fields.variant = options_.rendering.loading.gltf.variant;
    fields.view = picture.view;
    if (options_.frames.frames) fields.frame = picture.frame;
    return fields;
}

// Gives the picture its files, if all their names are known. Those of an unknown camera or frame are claimed
// for its field, so that two scenes do not rely on different names of their cameras.
void PicturePlan::name(const PlannedScene& scene, Picture& picture) {
    const NameFields known = fields(picture);
    std::vector<std::string> files;
    for (size_t i = 0; i < names_.size(); ++i) {
        const std::optional<std::string> file = names_[i].name(known);
        if (file) files.push_back(*file);
        claim({scene.number, picture.frame, picture.view, i}, picture,
              file ? *file : names_[i].open_name(known));
    }
    if (files.size() == names_.size()) picture.files = std::move(files);
}

// Throws Error (usage) if the file is not that output of this picture alone.
void PicturePlan::claim(const Owner& owner, const Picture& picture, const std::string& file) {
    options_.outputs.images.check_name(owner.output, file);
    const auto [known, is_new] = owners_.emplace(file, owner);
    const Owner& other = known->second;
    if (!is_new && other == owner) return;
    const bool is_of_another =
        other.scene != owner.scene || other.frame != owner.frame || other.view != owner.view;
    if (!is_new && is_of_another) {
        refuse_pictures(
            std::string(names_[owner.output].option()) + ": " + candela::quoted(file) +
            " would be two pictures, of " +
            text_of({.scene = scene_files_[other.scene], .frame = other.frame}) + " and of " +
            text_of(picture) +
            "; tell them apart by fields in the name, such as {stem}, {folder}, {camera} or {view}");
    }
    files_.write(names_[owner.output].option(), file);
}

// Throws Error if a folder is missing, or may not be written to, before the first of many scenes is read.
void PicturePlan::check_folders() const {
    std::set<std::filesystem::path> folders;
    for (const PlannedScene& scene : scenes_) {
        for (const Picture& picture : scene.pictures) {
            for (size_t i = 0; i < picture.files.size(); ++i) {
                const std::filesystem::path file(picture.files[i]);
                if (file == STDOUT) continue;
                if (!names_[i].names_folders() && folders.insert(file.parent_path()).second)
                    check_writable(file);
            }
        }
    }
}

bool PicturePlan::is_complete_from(size_t i) const {
    return std::all_of(scenes_.begin() + std::ptrdiff_t(i), scenes_.end(), [](const PlannedScene& scene) {
        return !scene.pictures.empty() && std::ranges::all_of(scene.pictures, is_there);
    });
}

std::vector<Picture> PicturePlan::pictures_of(size_t i, const Scene& scene) {
    files_.read_all("the scene's file", scene.files);
    std::vector<Picture> pictures = scenes_[i].pictures;
    if (options_.wants_all_cameras()) {
        for (const Camera& camera : scene.cameras)
            pictures.push_back({scenes_[i].file, camera.name, uint32_t(pictures.size()), scenes_[i].frame});
    }
    for (Picture& picture : pictures) {
        if (!picture.camera) picture.camera = scene.cameras.front().name;
        if (picture.files.empty()) name(scenes_[i], picture);
    }
    return pictures;
}

std::optional<std::string> PicturePlan::make_cameras_file(size_t i) const {
    if (!cameras_name_) return std::nullopt;
    std::optional<std::string> file =
        cameras_name_->name(fields({.scene = scenes_[i].file, .frame = scenes_[i].frame}));
    make_folder_of(*file);
    return file;
}

void PicturePlan::make_folders(const Picture& picture) const {
    for (size_t i = 0; i < picture.files.size(); ++i) {
        if (names_[i].names_folders()) make_folder_of(picture.files[i]);
    }
}

}  // namespace candela
