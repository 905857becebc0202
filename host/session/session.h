// Session: a scene that stays. A program loads it, changes it, renders on and takes the picture's layers.
// This header is all that it needs; it links the library candela_session, which brings the rest.
//
// One rule holds throughout: after any change, the picture has the bits that a fresh session gives which
// loads that state. So a change begins the picture anew, and rendering on, in however many steps, changes no
// bit.
//
// All errors are std::runtime_error; what() names the thing, the place, the cause and the remedy. After an
// error, the scene is as it was before the call, and the session can go on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace candela {

struct SessionOptions {
    std::string device{};  // Index or part of the name; empty: the best.
    // A folder where compiled kernels are kept from one program to the next; none: nowhere.
    std::optional<std::filesystem::path> kernel_cache{};
    // Gets what is odd in scene files but not an error, and why a device was lost that is opened again.
    std::function<void(const std::string&)> warn{};
    bool validation = false;  // Turn on Vulkan's validation layer; `warn` gets its messages, too.
};

// A scene file, of any format that candela reads, and how it is read.
struct SceneFile {
    std::filesystem::path path;
    // Files may be read from these folders, too: by default, a scene names only what is in its own.
    std::vector<std::filesystem::path> folders{};
    // For glTF: the pose at this time of the animation [s], of this name or index, by default the first.
    // None: nodes as they stand.
    std::optional<double> time{};
    std::optional<std::string> animation{};
};

// What is not given is what the scene proposes.
struct PictureRequest {
    std::optional<std::string> camera{};        // By name; none: the scene's first.
    std::optional<uint32_t> width{}, height{};  // Pixels.
    std::optional<uint32_t> seed{};             // Each has other noise.
    // Whether there are layers besides R G B A: albedo, normal, position, depth, variance, sample count.
    bool all_layers = false;
};

// One plane of values: row-major, top row first. Names follow EXR: "R", "Albedo.G", "Z".
struct PictureLayer {
    std::string name;
    std::vector<float> values;
};

// Only one may exist at a time.
class Session {
  public:
    explicit Session(SessionOptions options = {});
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    // Reads a scene, which takes the place of any before it, changes included.
    void load(const SceneFile& file);

    // Changes the scene by `json`, an object with any of the keys "cameras", "materials" and "environment",
    // in the syntax of scene files (docs/scene-format.md): it replaces cameras and materials of the same
    // names, and the environment, and adds cameras of new names. Files that it names are relative to the
    // scene's folder. Whether a mesh has tangents is decided when it is read, so that a material on meshes
    // can neither get nor lose a normal map or anisotropy.
    void change(std::string_view json);

    // Shows glTF at another time of its animation [s], as SceneFile::time and ::animation say it. Its files
    // are not read again, and what changes have replaced stays.
    void pose(std::optional<double> time, std::optional<std::string> animation = {});

    // Chooses the picture. Without a call, or after load(), it is the one that the scene proposes.
    void choose(const PictureRequest& picture);

    // Renders until every pixel has `spp` samples: on from those that it has, or from none after a change.
    // Calls `keep_going` regularly, with the share of the samples that are there, in [0, 1]; rendering stops
    // where it returns false, and goes on in the next call. Returns whether all samples are there. A device
    // that is lost is opened again, five times in a row at most.
    bool render(uint32_t spp, const std::function<bool(double done)>& keep_going = {});

    // The picture that was rendered last: its size, and its layers, R, G, B and A among them, of the samples
    // so far.
    uint32_t width() const;
    uint32_t height() const;
    std::vector<PictureLayer> layers() const;

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace candela
