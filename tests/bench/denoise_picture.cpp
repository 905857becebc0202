// Denoises EXR files of candela by variance, for measurements: denoise_picture TILE IN.exr OUT.exr [IN
// OUT]... writes R, G and B, and prints the seconds of CPU time of each, the first with that of compiling the
// kernels.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>

#include "denoise/variance.h"
#include "image/image_io.h"
#include "vk/device.h"
#include "vk/instance.h"

namespace candela {
namespace {

std::optional<RgbPlanes> planes(const Image& image, const char* x, const char* y, const char* z) {
    const Channel *a = image.find(x), *b = image.find(y), *c = image.find(z);
    if (!a || !b || !c) return std::nullopt;
    return RgbPlanes{a->values, b->values, c->values};
}

void denoise_file(const vk::Device& device, uint32_t tile, const char* from, const char* to) {
    const Image image = read_exr(from);
    NoisyPicture picture;
    picture.size = {image.data.width(), image.data.height()};
    picture.rgb = image.find_rgb().value();
    picture.variance = image.find_rgb("Variance");
    picture.albedo = image.find_rgb("Albedo");
    picture.normal = planes(image, "N.X", "N.Y", "N.Z");
    if (const Channel* alpha = image.find("A")) picture.alpha = alpha->values;
    if (const Channel* samples = image.find("SampleCount.V")) picture.samples = samples->values;
    const std::clock_t start = std::clock();
    Denoised denoised = filter_by_variance(device, picture, tile).value();
    const Denoised filtered = denoised;
    blend(noisy_weights(picture.size, picture.rgb, *picture.variance, denoised), picture.rgb, picture.alpha,
          denoised);
    std::printf("%s %.3f\n", from, double(std::clock() - start) / CLOCKS_PER_SEC);
    Image result{image.full, image.data, {}, {}};
    for (size_t c = 0; c < 3; ++c) {
        result.add(std::string(1, "RGB"[c])).values = denoised.rgb[c];
        result.add(std::string("Filtered.") + "RGB"[c]).values = filtered.rgb[c];
    }
    result.add("OwnWeight.V").values = filtered.own_weight;
    write_exr(to, result);
}

}  // namespace
}  // namespace candela

int main(int argc, char** argv) {
    using namespace candela;
    try {
        const vk::Instance instance({.validation = false});
        const vk::Device device(instance, vk::select_device(instance.devices(), {}));
        for (int i = 2; i + 1 < argc; i += 2)
            denoise_file(device, uint32_t(std::atoi(argv[1])), argv[i], argv[i + 1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
