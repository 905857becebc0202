// Textures and their images -> records and texels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "shared/texture.h"

namespace candela {

// The word of each image's first tile among the texels, if a texture looks it up.
using ImagePlaces = std::vector<std::optional<uint32_t>>;

// Collects the textures of a scene, each once, and the images that they look up.
class TextureTable {
  public:
    // The scene's images must outlive the table.
    explicit TextureTable(const std::vector<ImageFile>& images) : images_(images), places_(images.size()) {}

    // The index of a texture's record, or TEXTURE_NONE for none. Throws Error if its image is too large, or
    // if there are too many texels.
    uint32_t add(const std::optional<Texture>& texture);

    // OR of the traits of all textures.
    uint32_t traits() const { return traits_; }

    std::vector<uvec4> records() const;
    const ImagePlaces& places() const { return places_; }

  private:
    using TextureKey = std::array<uint32_t, 13>;  // All bits of a texture.
    static TextureKey key_of(const Texture& texture);

    const std::vector<ImageFile>& images_;
    ImagePlaces places_;
    uint64_t words_ = 0;
    std::map<TextureKey, uint32_t> indices_;  // Of the records.
    std::vector<TextureRecord> records_;
    uint32_t traits_ = 0;
};

// The tiles of all images that have a place. Calls packed(i) as soon as image i is not needed any more.
std::vector<uvec4> build_texels(
    const std::vector<ImageFile>& images, const ImagePlaces& places,
    const std::function<void(size_t)>& packed = [](size_t) {});

// Words of uvec4 that the tiles of an image take.
uint64_t texel_words(const TexelImage& image);

// Writes the tiles of an image; `words` has texel_words() elements.
void pack_texels(const TexelImage& image, std::span<uvec4> words);

}  // namespace candela
