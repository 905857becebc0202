// See oidn.h.
#include "denoise/oidn.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/printable.h"
#include "denoise/smooth_albedo.h"
#include "denoise/tiles.h"

namespace candela {
namespace {

// A tile of this size takes, with the library's own memory, no more than OIDN_BYTES in any quality.
// Tiles overlap, so that what is missing beyond their edges does not show.
constexpr uint32_t TILE = 512, OVERLAP = 64;
constexpr int SCRATCH_MEBIBYTES = 112;

int quality_code(DenoiserQuality quality) {
    switch (quality) {
        case DenoiserQuality::fast:
            return OIDN_FAST;
        case DenoiserQuality::balanced:
            return OIDN_BALANCED;
        case DenoiserQuality::high:
            break;
    }
    return OIDN_HIGH;
}

// Light is limited to this after exposure: the network spreads what is far brighter, such as a small lamp,
// over the pixels around it. The blend gives the lamp its own values back; where the variance is unknown,
// nothing does, and only what the network does not know at all (65504) is kept from it.
constexpr float LARGEST = 100.0f, LARGEST_WITHOUT_BLEND = 1e7f;

// A value of light: not a number is black, and infinity the largest number.
float sane(float value) {
    return std::isnan(value) ? 0.0f : std::clamp(value, 0.0f, std::numeric_limits<float>::max());
}

// The same between -1 and 1, or between 0 and 1.
float sane_normal(float value) {
    return std::isnan(value) ? 0.0f : std::clamp(value, -1.0f, 1.0f);
}
float sane_fraction(float value) {
    return std::isnan(value) ? 0.0f : std::clamp(value, 0.0f, 1.0f);
}

// What colours are multiplied by so that the network sees them at an exposure it knows: the geometric mean
// luminance of blocks becomes 0.18. The library finds it so itself, for each picture that it is given: a tile
// shall not have its own.
float exposure_of(const NoisyPicture& input) {
    constexpr uint32_t BLOCK = 16;
    constexpr double KEY = 0.18, LEAST = 1e-8;
    double sum = 0.0;
    size_t count = 0;
    for (uint32_t y0 = 0; y0 < input.size.y; y0 += BLOCK) {
        for (uint32_t x0 = 0; x0 < input.size.x; x0 += BLOCK) {
            const uint32_t x1 = std::min(x0 + BLOCK, input.size.x), y1 = std::min(y0 + BLOCK, input.size.y);
            double luminance = 0.0;
            for (uint32_t y = y0; y < y1; ++y) {
                for (size_t i = size_t{y} * input.size.x + x0; i < size_t{y} * input.size.x + x1; ++i) {
                    luminance += 0.212671 * double(sane(input.rgb[0][i])) +
                                 0.715160 * double(sane(input.rgb[1][i])) +
                                 0.072169 * double(sane(input.rgb[2][i]));
                }
            }
            luminance /= double(x1 - x0) * double(y1 - y0);
            if (luminance <= LEAST) continue;
            sum += std::log2(luminance);
            ++count;
        }
    }
    return count == 0 ? 1.0f : float(KEY / std::exp2(sum / double(count)));
}

// A device of the library, and what it says of failures.
class OidnDevice {
  public:
    explicit OidnDevice(const std::vector<std::filesystem::path>& candidates) : library_(candidates) {
        device_ = library_.new_device(OIDN_CPU);
        if (device_ == nullptr) {
            check();
            throw Error(about() + "it opens no device");
        }
        try {
            library_.set_device_bool(device_, "setAffinity", false);
            library_.commit_device(device_);
            check();
            const int major = number("versionMajor");
            version_ = std::to_string(major) + '.' + std::to_string(number("versionMinor")) + '.' +
                       std::to_string(number("versionPatch"));
            if (major != OIDN_MAJOR_VERSION) {
                throw Error(about() + "it is version " + version_ + ", and candela needs version " +
                            std::to_string(OIDN_MAJOR_VERSION) + " (`sh cmake/denoiser.sh` gets it)");
            }
        } catch (...) {
            library_.release_device(device_);
            throw;
        }
    }
    ~OidnDevice() { library_.release_device(device_); }
    OidnDevice(const OidnDevice&) = delete;
    OidnDevice& operator=(const OidnDevice&) = delete;

    const OidnLibrary& functions() const { return library_; }
    OidnDeviceHandle* handle() const { return device_; }
    const std::string& version() const { return version_; }
    // Throws Error if anything has failed since the last call.
    void check() const {
        const char* message = nullptr;
        const int code = library_.get_device_error(device_, &message);
        if (code == OIDN_NO_ERROR) return;
        throw Error(
            about() + (message == nullptr ? "it gives no reason" : printable(message, MAX_MESSAGE_BYTES)),
            code == OIDN_OUT_OF_MEMORY ? ErrorKind::out_of_memory : ErrorKind::other);
    }

  private:
    int number(const char* name) const {
        const int value = library_.get_device_int(device_, name);
        check();
        return value;
    }
    std::string about() const { return "Open Image Denoise (\"" + library_.file() + "\") failed: "; }

    OidnLibrary library_;
    OidnDeviceHandle* device_ = nullptr;
    std::string version_;
};

// Red, green and blue of a tile, pixel by pixel, as the library wants them.
struct TileImage {
    uint32_t width, height;
    std::vector<float> values;

    TileImage(uint32_t columns, uint32_t rows)
        : width(columns), height(rows), values(size_t{3} * columns * rows) {}
};

// A part of the picture.
struct Tile {
    TileSpan x, y;
    uint32_t width, height;  // Of what is processed.
};

// Fills the tile with sanitise(value) of the planes of a picture of that width.
template <class Sanitise>
void load(TileImage& image, const Tile& tile, uint32_t width, const RgbPlanes& planes,
          const Sanitise& sanitise) {
    float* out = image.values.data();
    for (uint32_t y = 0; y < tile.height; ++y) {
        const size_t row = size_t{tile.y.first + y} * width + tile.x.first;
        for (size_t i = row; i < row + tile.width; ++i) {
            for (const std::span<const float>& plane : planes)
                *out++ = sanitise(plane[i]);
        }
    }
}

// Calls each(i, rgb) for every pixel i of the picture that the tile keeps.
template <class Each>
void store(const TileImage& image, const Tile& tile, uint32_t width, const Each& each) {
    for (uint32_t y = tile.y.begin; y < tile.y.end; ++y) {
        const float* in =
            &image.values[3 * (size_t{y - tile.y.first} * tile.width + (tile.x.begin - tile.x.first))];
        for (uint32_t x = tile.x.begin; x < tile.x.end; ++x, in += 3)
            each(size_t{y} * width + x, in);
    }
}

// The filter RT between images of tiles, which must stay where they are.
class OidnFilter {
  public:
    explicit OidnFilter(const OidnDevice& device, DenoiserQuality quality)
        : device_(device),
          functions_(device.functions()),
          filter_(functions_.new_filter(device.handle(), "RT")) {
        device_.check();
        functions_.set_filter_int(filter_, "quality", quality_code(quality));
        functions_.set_filter_int(filter_, "maxMemoryMB", SCRATCH_MEBIBYTES);
    }
    ~OidnFilter() { functions_.release_filter(filter_); }
    OidnFilter(const OidnFilter&) = delete;
    OidnFilter& operator=(const OidnFilter&) = delete;

    void set(const char* name, TileImage& image) const {
        functions_.set_image(filter_, name, image.values.data(), OIDN_FLOAT3, image.width, image.height, 0, 0,
                             0);
    }
    void set(const char* name, bool value) const { functions_.set_filter_bool(filter_, name, value); }
    void set(const char* name, float value) const { functions_.set_filter_float(filter_, name, value); }
    void commit() const {
        functions_.commit_filter(filter_);
        device_.check();
    }
    void execute() const {
        functions_.execute_filter(filter_);
        device_.check();
    }

  private:
    const OidnDevice& device_;
    const OidnLibrary& functions_;
    OidnFilterHandle* filter_;
};

class Oidn : public Denoiser {
  public:
    Oidn(const std::vector<std::filesystem::path>& candidates, DenoiserQuality quality)
        : device_(candidates), quality_(quality) {}

    std::string name() const override { return "oidn"; }
    std::string description() const override { return "Open Image Denoise " + device_.version(); }
    Denoised run(const NoisyPicture& input) override;

  private:
    OidnDevice device_;
    DenoiserQuality quality_;
};

// The images of a tile, and the filters between them.
class TileDenoiser {
  public:
    TileDenoiser(const OidnDevice& device, DenoiserQuality quality, const NoisyPicture& input,
                 const Tile& first)
        : input_(input),
          colour_(first.width, first.height),
          output_(first.width, first.height),
          filter_(device, quality) {
        const bool trusts_guides = quality != DenoiserQuality::fast;
        if (input.albedo) {
            // Not by the library's filter of albedos, which smears small letters.
            albedo_.emplace(first.width, first.height);
        }
        if (input.albedo && input.normal) {
            normal_.emplace(first.width, first.height);
            if (trusts_guides) prefilter_normal(device, quality);
        }
        set_features(filter_, trusts_guides);
        const float exposure = exposure_of(input);
        limit_ = (input.variance ? LARGEST : LARGEST_WITHOUT_BLEND) / exposure;
        filter_.set("hdr", true);
        filter_.set("inputScale", exposure);
        filter_.commit();
        if (input.alpha.empty()) return;
        alpha_filter_.emplace(device, quality);
        set_features(*alpha_filter_, trusts_guides);
        alpha_filter_->set("srgb", true);  // Numbers that need no curve.
        alpha_filter_->commit();
    }

    void run(const Tile& tile, Denoised& picture) {
        const uint32_t width = input_.size.x;
        if (albedo_) load_albedo(tile);
        if (normal_) load(*normal_, tile, width, *input_.normal, sane_normal);
        if (normal_filter_) normal_filter_->execute();
        load(colour_, tile, width, input_.rgb, [&](float value) { return std::min(sane(value), limit_); });
        filter_.execute();
        store(output_, tile, width, [&](size_t i, const float* rgb) {
            for (size_t c = 0; c < 3; ++c)
                picture.rgb[c][i] = std::isfinite(rgb[c]) ? std::max(rgb[c], 0.0f) : sane(input_.rgb[c][i]);
        });
        if (!alpha_filter_) return;
        load(colour_, tile, width, {input_.alpha, input_.alpha, input_.alpha}, sane_fraction);
        alpha_filter_->execute();
        store(output_, tile, width,
              [&](size_t i, const float* rgb) { picture.alpha[i] = sane_fraction(rgb[1]); });
    }

  private:
    void load_albedo(const Tile& tile) {
        float* out = albedo_->values.data();
        for (const vec3& albedo : smooth_albedo(
                 input_,
                 {tile.x.first, tile.y.first, tile.x.first + tile.width, tile.y.first + tile.height})) {
            for (int c = 0; c < 3; ++c)
                *out++ = sane_fraction(albedo[c]);
        }
    }
    void prefilter_normal(const OidnDevice& device, DenoiserQuality quality) {
        normal_filter_.emplace(device, quality);
        normal_filter_->set("normal", *normal_);
        normal_filter_->set("output", *normal_);
        normal_filter_->commit();
    }
    void set_features(OidnFilter& filter, bool is_clean) {
        filter.set("color", colour_);
        filter.set("output", output_);
        if (albedo_) filter.set("albedo", *albedo_);
        if (normal_) filter.set("normal", *normal_);
        filter.set("cleanAux", is_clean && albedo_.has_value());
    }

    const NoisyPicture& input_;
    float limit_ = 0.0f;  // Of colours.
    TileImage colour_, output_;
    std::optional<TileImage> albedo_{}, normal_{};
    std::optional<OidnFilter> normal_filter_{}, alpha_filter_{};
    OidnFilter filter_;
};

Denoised Oidn::run(const NoisyPicture& input) {
    Denoised picture;
    for (std::vector<float>& plane : picture.rgb)
        plane.resize(input.pixel_count());
    if (!input.alpha.empty()) picture.alpha.resize(input.pixel_count());
    const std::vector<TileSpan> columns = tile_spans(input.size.x, TILE, OVERLAP);
    const std::vector<TileSpan> rows = tile_spans(input.size.y, TILE, OVERLAP);
    const auto tile_at = [&](const TileSpan& x, const TileSpan& y) {
        return Tile{x, y, std::min(input.size.x, TILE), std::min(input.size.y, TILE)};
    };
    TileDenoiser tiles(device_, quality_, input, tile_at(columns.front(), rows.front()));
    for (const TileSpan& y : rows) {
        for (const TileSpan& x : columns)
            tiles.run(tile_at(x, y), picture);
    }
    return picture;
}

}  // namespace

std::unique_ptr<Denoiser> make_oidn(const std::vector<std::filesystem::path>& candidates,
                                    DenoiserQuality quality) {
    return std::make_unique<Oidn>(candidates, quality);
}

}  // namespace candela
