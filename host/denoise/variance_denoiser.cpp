// See variance_denoiser.h.
#include "denoise/variance_denoiser.h"

#include <string>
#include <utility>

#include "denoise/variance.h"

namespace candela {
namespace {

class VarianceDenoiser : public Denoiser {
  public:
    explicit VarianceDenoiser(std::function<const vk::Device&()> open) : open_(std::move(open)) {}

    std::string name() const override { return "variance"; }
    std::string description() const override { return "variance"; }
    Denoised run(const NoisyPicture& picture) override { return filter_by_variance(open_(), picture); }

  private:
    std::function<const vk::Device&()> open_;
};

}  // namespace

std::unique_ptr<Denoiser> make_variance(std::function<const vk::Device&()> open) {
    return std::make_unique<VarianceDenoiser>(std::move(open));
}

}  // namespace candela
