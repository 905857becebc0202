// What clients can ask. docs/protocol.md describes it.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "denoise/choose_denoiser.h"
#include "load/load.h"
#include "serve/loaded_scene.h"
#include "serve/message.h"
#include "serve/server.h"
#include "serve/shared_arrays.h"
#include "serve/shared_image.h"
#include "vk/instance.h"

namespace candela::serve {

// The version of the protocol. It increases with changes that old clients would not survive.
inline constexpr uint32_t PROTOCOL = 1;

class Methods {
  public:
    struct Options {
        std::optional<std::string> device{};  // Index or part of the name; none: the best.
        std::optional<std::filesystem::path> kernel_cache{};
        std::function<vk::Instance::Options()> instance;  // Called when Vulkan is first needed.
        LoadOptions loading{};                            // What requests do not say.
        std::string command_line{};                       // For image files.
    };

    explicit Methods(Options options) : options_(std::move(options)) {}

    // A Handler. The memory of scenes and images is within the limit of the process.
    Json operator()(const Request& request, const Call& call);

    // How often the validation layer has reported something, if it is on.
    size_t validation_messages() const { return instance_ ? instance_->validation_messages().size() : 0; }

  private:
    struct LoadRequest {
        std::string id{};
        std::filesystem::path path{};
        LoadOptions options{};
        std::unique_ptr<SharedArrays> arrays{};
    };
    using Method = Json (Methods::*)(const Node& parameters, const Call& call);

    Json version(const Node& parameters, const Call& call);
    Json devices(const Node& parameters, const Call& call);
    Json load(const Node& parameters, const Call& call);
    Json scene(const Node& parameters, const Call& call);
    Json set(const Node& parameters, const Call& call);
    Json views(const Node& parameters, const Call& call);
    Json render(const Node& parameters, const Call& call);
    Json image(const Node& parameters, const Call& call);
    Json labels(const Node& parameters, const Call& call);
    Json object(const Node& parameters, const Call& call);
    Json material(const Node& parameters, const Call& call);
    Json save(const Node& parameters, const Call& call);
    Json release(const Node& parameters, const Call& call);
    Json close(const Node& parameters, const Call& call);

    const vk::Instance& instance();
    DeviceSlot take_device();
    void remove_scene(const std::string& id);
    LoadRequest read_load(const Node& parameters) const;
    LoadedScene& find_scene(const Node& parameters);
    SharedImage& find_image(const Node& parameters);
    void denoise(Image& image, DenoiserChoice choice, LoadedScene& scene);

    Options options_;
    std::unique_ptr<vk::Instance> instance_;
    std::optional<DeviceSlot> idle_;  // Of a scene that is gone: the next finds its kernels.
    std::map<std::string, std::unique_ptr<LoadedScene>> scenes_;
    std::map<std::string, std::unique_ptr<SharedImage>> images_;
    uint64_t next_image_ = 1;
    std::map<DenoiserChoice, std::unique_ptr<Denoiser>> denoisers_;  // Those that have been asked for.
    LoadedScene* denoised_ = nullptr;                                // Whose device they use.
};

}  // namespace candela::serve
