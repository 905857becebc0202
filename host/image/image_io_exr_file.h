// An OpenEXR file that is read through the library's C interface, which checks sizes against the file's
// before it allocates.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <openexr.h>

#include "image/image.h"
#include "image/image_io.h"

namespace candela {

// A file of which at least the first bytes are in memory.
struct ExrBytes {
    std::string_view bytes;
    uint64_t size = bytes.size();  // Size of the file.
};

// The largest chunk that is decoded: 256 lines of DWAB, 2^16 pixels wide, of four 32-bit channels.
inline constexpr uint64_t MAX_CHUNK_BYTES = uint64_t{1} << 28;

class ExrFile {
  public:
    // Copies neither the bytes nor the path, which is the file's name in messages. Throws Error if it is not
    // an OpenEXR file, or its header is damaged.
    ExrFile(const ExrBytes& file, const std::filesystem::path& path);
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;
    ~ExrFile() { exr_finish(&context_); }

    // The image without values. Throws Error if an Image cannot hold it, or if it exceeds the limits.
    Image read_header(const ImageLimits& limits);

  protected:
    static constexpr int PART = 0;  // The first one of a file.

    [[noreturn]] void fail(const std::string& why) const;
    [[noreturn]] void fail_damaged(const std::string& how) const;
    // Throws Error or std::bad_alloc unless `result` is success.
    void check(exr_result_t result) const;

    exr_context_t context() const { return context_; }
    std::string_view bytes() const { return bytes_; }
    // Valid once the header is read.
    bool is_tiled() const { return tiled_; }

  private:
    void read_windows(Image& image) const;
    void read_attributes(Image& image) const;
    void read_channels(Image& image) const;

    std::string_view bytes_;
    const std::filesystem::path& path_;
    exr_context_t context_ = nullptr;
    bool tiled_ = false;
};

}  // namespace candela
