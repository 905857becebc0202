// An image in memory that the client shares.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/memory_limit.h"
#include "image/image.h"
#include "image/labels.h"
#include "serve/message.h"
#include "serve/shared_memory.h"

namespace candela::serve {

class SharedImage {
  public:
    // Takes the layers of an image that layer_kinds() knows. Throws Error if there is no memory for them.
    explicit SharedImage(Image image, std::shared_ptr<const Labels> labels = nullptr);

    // The file, the size of the picture, and where the layers are in the file: each row-major, float32, with
    // the values of a pixel beside each other.
    Json describe() const;
    // What the numbers of the layers of ids mean; null without such layers.
    const Labels* labels() const { return labels_.get(); }
    // The image, as it was.
    Image image() const;

  private:
    struct Layer {
        std::string name;
        std::vector<std::string> channels;
        uint64_t offset = 0;  // Bytes.
    };
    static std::vector<Layer> layers_of(const Image& image);
    static uint64_t bytes_of(const Image& image, const std::vector<Layer>& layers);
    float* values_of(const Layer& layer) const;

    std::vector<Layer> layers_;
    std::shared_ptr<const Labels> labels_;
    Image frame_;  // With the channels of no layer alone.
    MemoryCharge charge_;
    SharedMemory memory_;
};

}  // namespace candela::serve
