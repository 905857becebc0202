// Denoising an image with layers: which of them guide the denoiser, and the layers that it adds.
#pragma once

#include <array>
#include <string>

#include "denoise/denoiser.h"
#include "image/image.h"

namespace candela {

// The layers that denoising adds: colour and, where it matters, alpha.
inline constexpr std::array<const char*, 3> DENOISED{"Denoised.R", "Denoised.G", "Denoised.B"};
inline constexpr const char* DENOISED_ALPHA = "Denoised.A";

// Whether a channel is among them.
bool is_denoised_channel(const std::string& name);

// The image's layers as a denoiser takes them; valid as long as the channels are. Albedo and normals are
// those made for denoisers or, if they are missing, those of first hits. Alpha is left out if it is the same
// everywhere. Throws Error that begins with `name` if the image lacks R, G or B.
NoisyPicture noisy_picture(const Image& image, bool with_alpha, const std::string& name);

// For people: "with DenoisingAlbedo and DenoisingNormal", or what the image lacks for the best result.
std::string describe_guides(const Image& image);

// Denoises the image, blends the result with it if it has its variance (blend.h), and adds or replaces the
// layers. Throws Error as noisy_picture() and Denoiser::run() do; the image is then unchanged.
void add_denoised(Image& image, Denoiser& denoiser, bool with_alpha, const std::string& name);

// The image with its denoised layers in place of R, G, B and A as long as this lives, if it has them.
class DenoisedView {
  public:
    explicit DenoisedView(Image& image) : image_(image) { swap(); }
    ~DenoisedView() { swap(); }
    DenoisedView(const DenoisedView&) = delete;
    DenoisedView& operator=(const DenoisedView&) = delete;

  private:
    void swap();

    Image& image_;
};

}  // namespace candela
