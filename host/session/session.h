// Session: a scene that stays loaded. A program loads it, changes it, continues rendering and reads the
// picture's layers. The program needs only this header and the library candela_session.
//
// One rule always holds: after any change, the picture has the same bits as in a new session that loads the
// changed scene. So a change restarts the picture, and the number of steps in which it is rendered does not
// matter.
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
    // A folder that keeps compiled kernels between runs of programs; none: they are not kept.
    std::optional<std::filesystem::path> kernel_cache{};
    // Gets warnings: oddities of scene files that are not errors, and why a lost device is reopened.
    std::function<void(const std::string&)> warn{};
    bool validation = false;  // Turn on Vulkan's validation layer; `warn` also gets its messages.
};

// A scene file, of any format that candela reads, and how it is read.
struct SceneFile {
    std::filesystem::path path;
    // Further folders from which files may be read; by default, only the scene's own.
    std::vector<std::filesystem::path> folders{};
    // For glTF: pose the scene at this time [s] of the animation with this name or index (by default the
    // first). None: not animated.
    std::optional<double> time{};
    std::optional<std::string> animation{};
};

// The scene proposes what is not given.
struct PictureRequest {
    std::optional<std::string> camera{};        // By name; none: the scene's first.
    std::optional<uint32_t> width{}, height{};  // Pixels.
    std::optional<uint32_t> seed{};             // Each gives different noise.
    // Whether to make the layers besides R G B A: albedo, normal, position, depth, variance, sample count.
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

    // Reads a scene, which replaces any earlier one and its changes.
    void load(const SceneFile& file);

    // Changes the scene by `json`, an object with any of the keys "cameras", "materials", "environment" and
    // "sky", in the syntax of scene files (docs/scene-format.md): it replaces cameras and materials of the
    // same names, and the environment, and adds cameras of new names. Files that it names are relative to the
    // scene's folder. Whether a mesh has tangents is decided when it is read, so that a material on meshes
    // can neither get nor lose a normal map or anisotropy.
    void change(std::string_view json);

    // Shows glTF at another time of its animation [s]; see SceneFile::time and ::animation. Its files are not
    // read again, and what changes have replaced stays.
    void pose(std::optional<double> time, std::optional<std::string> animation = {});

    // Chooses the picture. By default, and after load(), it is the one that the scene proposes.
    void choose(const PictureRequest& picture);

    // Renders until every pixel has `spp` samples. Continues from the samples so far if they are no more than
    // that and the picture is the same; otherwise it begins anew. Calls `keep_going` regularly, with the
    // fraction of the samples that are done, in [0, 1]; rendering stops when it returns false, and continues
    // in the next call. Returns whether all samples are done. A lost device is reopened, at most five times
    // in a row.
    bool render(uint32_t spp, const std::function<bool(double done)>& keep_going = {});

    // The picture that was rendered last, from the samples so far: its size, and its layers, including R, G,
    // B and A.
    uint32_t width() const;
    uint32_t height() const;
    std::vector<PictureLayer> layers() const;

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace candela
