// See renderer.h.
#include "render/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "base/cpu_time.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/memory_limit.h"
#include "gpu_scene/light_tree_arrays.h"
#include "render/kernels.h"
#include "render/media_at.h"
#include "shared/first_points.h"
#include "vk/transfer.h"

namespace candela {
namespace {

// Submissions on a GPU must stay far below the limit of a driver's watchdog; on a CPU they only determine how
// soon Ctrl-C takes effect.
constexpr double GPU_SUBMISSION_SECONDS = 0.075;
constexpr double CPU_SUBMISSION_SECONDS = 0.25;

constexpr uint64_t COUNTER_BYTES = COUNTER_COUNT * sizeof(uint32_t);

// Vulkan guarantees this maxComputeWorkGroupInvocations, so the device's limit need not be checked.
static_assert(WORKGROUP_SIZE * WORKGROUP_SIZE <= 128);

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

uint32_t layer_count(const RenderSettings& settings) {
    return layers_before_guides(settings) + (settings.guides ? LAYER_COUNT_GUIDES : 0);
}

std::string gibibytes(uint64_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f GiB", double(bytes) / (1 << 30));
    return text;
}

// Throws Error if the process would exceed its limit. While the picture is written, the host holds it as
// accumulated and as channels, 1.3 times as much as on the device; and the memory of a CPU device is the
// host's.
void check_host_memory(const vk::Device& device, const GpuScene& scene, const RenderSettings& settings) {
    const uint64_t on_device = device_bytes(scene, settings);
    const uint64_t picture = on_device - scene.bytes();
    const uint64_t layers = uint64_t{settings.crop.width()} * settings.crop.height() * settings.layer_bytes;
    const uint64_t needed = 3 * picture / 2 + layers + settings.later_bytes +
                            (device.info().type == vk::DeviceType::cpu ? on_device : 0);
    if (memory_in_use() + needed <= memory_limit()) return;
    throw Error("rendering a picture of " + std::to_string(settings.crop.width()) + "x" +
                    std::to_string(settings.crop.height()) + " needs " + gibibytes(needed) + ", where " +
                    gibibytes(memory_in_use()) + " are in use and --memory-limit allows " +
                    gibibytes(memory_limit()) +
                    "; use a smaller picture (--size, --crop) or scene, or raise the "
                    "limit",
                ErrorKind::out_of_memory);
}

const vk::Device& check_memory(const vk::Device& device, const GpuScene& scene,
                               const RenderSettings& settings) {
    const uint64_t needed = device_bytes(scene, settings);
    const uint64_t available = device.available_memory();
    if (needed > available) {
        throw Error("rendering needs " + gibibytes(needed) + " (scene " + gibibytes(scene.bytes()) +
                        ", the rest for a picture of " + std::to_string(settings.crop.width()) + "x" +
                        std::to_string(settings.crop.height()) + "), but " + device.info().name + " has " +
                        gibibytes(available) + "; use a smaller picture (--size, --crop) or scene",
                    ErrorKind::out_of_memory);
    }
    check_host_memory(device, scene, settings);
    return device;
}

// The part of the picture, from its first pixel on, that fits into one image: all of it, or whole tiles.
PixelRect largest_part(const vk::DeviceLimits& limits, const RenderSettings& settings) {
    constexpr uint32_t TILE = 64;  // Drivers pad images to multiples of this.
    const uint64_t bytes = std::min(limits.max_image_bytes, limits.max_memory_allocation_size);
    const uint64_t pixels = bytes / (sizeof(vec4) * layer_count(settings));
    const PixelRect& all = settings.crop;
    const auto max = [&](uint32_t wanted, uint64_t allowed) {
        allowed = std::min<uint64_t>(allowed, limits.max_image_dimension_2d);
        return wanted <= allowed ? wanted : uint32_t(allowed / TILE * TILE);
    };
    const uint32_t width = max(all.width(), limits.max_image_dimension_2d);
    const uint64_t filled_width = uint64_t{(width + TILE - 1) / TILE} * TILE;
    const uint32_t height = max(all.height(), pixels / filled_width);
    return {all.x0, all.y0, all.x0 + width, all.y0 + height};
}

vk::StorageImage make_accumulation(const vk::Device& device, const RenderSettings& settings) {
    const PixelRect& rect = settings.crop;
    try {
        return vk::make_storage_image(device, rect.width(), rect.height(), layer_count(settings),
                                      "accumulation");
    } catch (const Error& error) {
        const PixelRect part = largest_part(device.limits(), settings);
        if (error.kind() != ErrorKind::out_of_memory || part == rect) throw;
        const auto text = [](uint32_t number) { return std::to_string(number); };
        throw Error(std::string(error.what()) + "; or render the picture in parts of at most " +
                        text(part.width()) + 'x' + text(part.height()) + " (the first one by --crop " +
                        text(part.x0) + ',' + text(part.y0) + ',' + text(part.x1) + ',' + text(part.y1) + ')',
                    error.kind());
    }
}

std::span<const uint32_t> spirv_of(RenderKernel which, const vk::Device& device,
                                   const KernelConstants& constants) {
    if (which == RenderKernel::position) return kernels::position;
    if (which == RenderKernel::first_hits) return kernels::first_hits;
    if (which == RenderKernel::first_points) return kernels::first_points;
    const bool inlined = device.info().is_lavapipe();
    if ((constants[CONSTANT_MATERIALS] & 1u << MATERIAL_PRINCIPLED) != 0)
        return inlined ? kernels::render_layered_inlined : kernels::render_layered;
    return inlined ? kernels::render_inlined : kernels::render;
}

// Half the width and height of the view: at distance 1, or for parallel rays; of a panorama, see Parameters.
vec2 half_view(const SceneFrame& frame, const Camera& camera, vec2 size) {
    if (camera.panorama) {
        const bool has_circle = camera.panorama->mapping != Mapping::equirectangular;
        return has_circle ? size / std::min(size.x, size.y) : vec2(1);
    }
    const float half_y = camera.ortho_height ? 0.5f * frame.length(*camera.ortho_height)
                                             : std::tan(0.5f * camera.vertical_fov);
    return {half_y * size.x / size.y / camera.focal_ratio, half_y};
}

// See Parameters.
float fisheye_edge(const Panorama& panorama) {
    switch (panorama.mapping) {
        case Mapping::fisheye:
            return panorama.fisheye_fov / (4.0f * PI);
        case Mapping::equisolid:
            return std::sin(0.25f * panorama.fisheye_fov);
        case Mapping::equirectangular:
            break;
    }
    return 0.0f;
}

}  // namespace

Parameters make_parameters(const GpuScene& scene, const Camera& camera, const RenderSettings& settings) {
    const SceneFrame& frame = scene.frame;
    const vec3 forward(normalize(camera.look_at - camera.position));
    const vec3 right = normalize(cross(forward, camera.up));
    const vec3 up = cross(right, forward);
    const vec2 size(settings.size);
    const vec2 half = half_view(frame, camera, size);
    const Lens& lens = camera.lens;
    static_assert(MAX_BOUNCES == DEPTH_SAFETY_LIMIT);
    const float lens_radius = frame.length(double(lens.radius));
    const float cos_lens = std::cos(lens.rotation);
    const float sin_lens = std::sin(lens.rotation);
    return {.position = frame.point(camera.position),
            .right = half.x * right,
            .up = half.y * up,
            .forward = forward,
            .full_size = settings.size,
            .principal_point = 1.0f + 2.0f * camera.principal_offset * vec2(size.y / size.x, 1.0f),
            .crop = {settings.crop.x0, settings.crop.y0},
            .seed = settings.seed,
            .max_depth = std::min(settings.max_depth, DEPTH_SAFETY_LIMIT),
            .rr_depth = settings.rr_depth,
            .lights = turned(scene.light_groups, scene.environment_rotation),
            .environment_size = scene.environment_size,
            .environment_turn = {std::cos(scene.environment_rotation), std::sin(scene.environment_rotation)},
            .lens_x = lens_radius * (cos_lens * right + sin_lens * up),
            .lens_y = lens_radius * (cos_lens * up - sin_lens * right),
            .focal_distance = frame.length(double(lens.focal_distance)),
            .blades = lens.blades,
            .first_sample = settings.first_sample,
            .camera_media = media_at(scene, camera.position),
            .fisheye_edge = camera.panorama ? fisheye_edge(*camera.panorama) : 0.0f};
}

vk::Kernel make_kernel(const vk::Device& device, RenderKernel which, const KernelConstants& constants) {
    const bool render = which == RenderKernel::render;
    std::vector<vk::Binding> bindings = SceneBuffers::bindings(constants);
    if (which == RenderKernel::first_hits) {
        bindings.push_back({BINDING_FIRST_HITS, vk::BindingType::storage_buffer});
        return {device,      spirv_of(which, device, constants), bindings, sizeof(PixelRun), constants.values,
                "first hits"};
    }
    if (which == RenderKernel::first_points) {
        bindings.push_back({BINDING_FIRST_POINTS, vk::BindingType::storage_buffer});
        return {device,        spirv_of(which, device, constants), bindings, sizeof(Tile), constants.values,
                "first points"};
    }
    bindings.push_back({BINDING_IMAGE, vk::BindingType::storage_image});
    if (render) bindings.push_back({BINDING_COUNTERS, vk::BindingType::storage_buffer});
    return {device,           spirv_of(which, device, constants), bindings, sizeof(Tile),
            constants.values, render ? "render" : "position"};
}

Accumulation empty_state(const RenderSettings& settings) {
    return {.full = settings.size,
            .rect = settings.crop,
            .seed = settings.seed,
            .first_sample = settings.first_sample,
            .layer_count = layer_count(settings),
            .denoising_layer = settings.guides ? layers_before_guides(settings) : 0,
            .values = {}};
}

uint64_t device_bytes(const GpuScene& scene, const RenderSettings& settings) {
    const uint64_t layer = uint64_t{settings.crop.width()} * settings.crop.height() * sizeof(vec4);
    return scene.bytes() + layer * (layer_count(settings) + 1);
}

Renderer::Renderer(const vk::Device& device, const GpuScene& scene, const Camera& camera,
                   const RenderSettings& settings)
    : device_(&check_memory(device, scene, settings)),
      settings_(settings),
      frame_(scene.frame),
      eye_(scene.frame.point(camera.position)),
      scene_(device, scene, make_parameters(scene, camera, settings),
             map_arrays(device.info(), scene, settings.scene_access)),
      constants_(kernel_constants(device, scene, scene_.map(), camera, settings)),
      counter_buffer_(device, COUNTER_BYTES, vk::BufferUsage::storage, "counters"),
      counts_(device, COUNTER_BYTES, vk::BufferUsage::readback, "counts"),
      image_(make_accumulation(device, settings)),
      commands_(device) {
    if (settings_.submission_seconds == 0.0) {
        const bool cpu = device.info().type == vk::DeviceType::cpu;
        settings_.submission_seconds = cpu ? CPU_SUBMISSION_SECONDS : GPU_SUBMISSION_SECONDS;
    }
    compile();
}

void Renderer::compile() {
    const CpuWatch watch;
    const auto start = std::chrono::steady_clock::now();
    const uint32_t compiled_before = device_->programs().compiled();
    render_kernel_ = std::make_unique<vk::Kernel>(scene_kernel(RenderKernel::render));
    render_kernel_->bind(BINDING_IMAGE, image_);
    render_kernel_->bind(BINDING_COUNTERS, counter_buffer_);
    // Some drivers compile at the first dispatch.
    if (device_->programs().compiled() != compiled_before) {
        record(*render_kernel_,
               Tile{.origin = {0, 0}, .size = {0, 0}, .stride = {1, 1}, .target_samples = 0, .lane = LANES});
        commands_.submit_and_wait();
    }
    pipeline_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    pipeline_cpu_seconds_ = watch.seconds();
}

void Renderer::reset(const GpuScene& scene, const Camera& camera, const RenderSettings& settings,
                     const BufferSet& changed) {
    const double submission_seconds = settings_.submission_seconds;
    settings_ = settings;
    if (settings_.submission_seconds == 0.0) settings_.submission_seconds = submission_seconds;
    if (changed.any()) {
        scene_.update(scene, map_arrays(device_->info(), scene, settings.scene_access), changed);
        scene_.bind_to(*render_kernel_);
    }
    frame_ = scene.frame;
    eye_ = frame_.point(camera.position);
    scene_.set(make_parameters(scene, camera, settings));
    const uvec2 size = image_size();
    if (size == uvec2(image_.width(), image_.height()) && layer_count(settings) == image_.layers()) {
        vk::clear(image_);
    } else {
        image_ = make_accumulation(*device_, settings);
        render_kernel_->bind(BINDING_IMAGE, image_);
    }
    samples_ = 0;
    counters_ = {};
    const auto constants = kernel_constants(*device_, scene, scene_.map(), camera, settings);
    if (constants == constants_) return;
    constants_ = constants;
    compile();
}

vk::Kernel Renderer::scene_kernel(RenderKernel which) const {
    vk::Kernel kernel = make_kernel(*device_, which, constants_);
    scene_.bind_to(kernel);
    return kernel;
}

// Records the dispatch of one tile.
void Renderer::record(const vk::Kernel& kernel, Tile tile) {
    const auto groups = [](uint32_t pixels) {
        return std::max(1u, (pixels + WORKGROUP_SIZE - 1) / WORKGROUP_SIZE);
    };
    const uvec2 count(groups(tile.size.x), groups(tile.size.y));
    if (device_->info().is_lavapipe()) tile.stride = spreading_stride(count);
    commands_.dispatch(kernel, bytes_of(tile), {count.x, count.y, 1});
}

// Dispatches a tile; returns whether all pixels that it is for hold their samples.
bool Renderer::dispatch(const Tile& tile, Work& work) {
    commands_.clear(counter_buffer_);
    record(*render_kernel_, tile);
    commands_.copy(counter_buffer_, counts_);
    work.seconds += commands_.submit_and_wait();
    uint32_t words[COUNTER_COUNT];
    std::memcpy(words, counts_.mapped(), sizeof words);
    counters_.rays += uint64_t{words[COUNTER_RAYS_HIGH]} << 32 | words[COUNTER_RAYS_LOW];
    counters_.nonfinite_samples += words[COUNTER_NONFINITE];
    counters_.depth_limit_hits += words[COUNTER_DEPTH_LIMIT];
    work.samples += words[COUNTER_SAMPLES];
    return words[COUNTER_UNFINISHED] == 0;
}

// Dispatches a tile until all its pixels hold their samples. Once is enough, unless the driver ends long
// loops, as lavapipe does: see kernels/render.glsl. Lanes none of which then finishes a sample render one by
// one.
Renderer::Work Renderer::complete(const Tile& tile) {
    Work work;
    while (true) {
        const uint64_t before = work.samples;
        if (dispatch(tile, work)) return work;
        if (work.samples > before) continue;
        Tile one = tile;
        for (one.lane = 0; one.lane < LANES; ++one.lane)
            dispatch(one, work);
        if (work.samples > before) continue;
        throw Error("the driver of " + device_->info().name +
                    " ends loops before a single path is finished: paths are too long, or rays meet too many "
                    "shapes in the same place; allow fewer bounces (--max-depth), remove shapes that lie on "
                    "each other, or use another device (candela devices lists them)");
    }
}

bool Renderer::render(uint32_t target, const std::function<bool(double)>& keep_going) {
    Schedule schedule(image_size(), samples_, target,
                      std::min(settings_.submission_seconds, settings_.latency), settings_.pass_growth);
    while (!schedule.done()) {
        const Work work = complete(schedule.next());
        schedule.advance(work.seconds, work.samples);
        if (!keep_going(schedule.progress()) && !schedule.done()) return false;
    }
    samples_ = std::max(samples_, target);
    return true;
}

Accumulation Renderer::download() const {
    Accumulation state = empty_state(settings_);
    state.values = vk::download(image_, 0, image_.layers());
    state.counters = counters_;
    return state;
}

void Renderer::upload(const Accumulation& state) {
    if (state.full != settings_.size || state.rect != settings_.crop || state.seed != settings_.seed ||
        state.first_sample != settings_.first_sample || state.layer_count != image_.layers() ||
        state.denoising_layer != constants_[CONSTANT_DENOISING_LAYER]) {
        throw Error(
            "the state does not fit: its size, crop, seed, first sample or set of images differs from this "
            "rendering's; render with the settings that it was made with");
    }
    if (!state.values.empty()) vk::upload(image_, 0, state.values);
    samples_ = state.min_samples();
    counters_ = state.counters;
}

}  // namespace candela
