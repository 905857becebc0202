// The denoiser Open Image Denoise, on the CPU: the same picture on every computer of a kind, whatever
// renders.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "denoise/denoiser.h"
#include "denoise/oidn_library.h"

namespace candela {

enum class DenoiserQuality { fast, balanced, high };

// Open Image Denoise, from the first of these files that is there. Normals are denoised first, except with
// `fast`; albedo is taken as it is. A large picture is denoised in tiles that overlap, each with the same
// exposure, so that the memory that it takes does not grow with the picture. Throws Error if the library is
// missing (request), is of another major version or does not run on this computer.
// Ref: Áfra, "Intel Open Image Denoise" (2019), openimagedenoise.org.
std::unique_ptr<Denoiser> make_oidn(const std::vector<std::filesystem::path>& candidates,
                                    DenoiserQuality quality);

// What it needs at most, besides the picture and its denoised planes [bytes].
inline constexpr uint64_t OIDN_BYTES = uint64_t{256} << 20;

}  // namespace candela
