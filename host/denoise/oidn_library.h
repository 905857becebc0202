// Open Image Denoise, loaded at run time: the functions of its C interface that candela calls.
//
// Declared here instead of by its header, so that nothing needs the library to build. The interface is stable
// within a major version.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "os/library.h"

namespace candela {

struct OidnDeviceHandle;
struct OidnFilterHandle;

inline constexpr int OIDN_MAJOR_VERSION = 2;

// Values of its enumerations.
inline constexpr int OIDN_CPU = 1;
inline constexpr int OIDN_NO_ERROR = 0, OIDN_OUT_OF_MEMORY = 4;
inline constexpr int OIDN_FLOAT3 = 3;
inline constexpr int OIDN_FAST = 4, OIDN_BALANCED = 5, OIDN_HIGH = 6;

class OidnLibrary {
  public:
    // Loads the first of `candidates` that is there. Throws Error (request) if none is, and Error if the one
    // that is there cannot be used.
    explicit OidnLibrary(const std::vector<std::filesystem::path>& candidates);
    OidnLibrary(const OidnLibrary&) = delete;
    OidnLibrary& operator=(const OidnLibrary&) = delete;

    const std::string& file() const { return file_; }

    OidnDeviceHandle* (*new_device)(int type) = nullptr;
    void (*commit_device)(OidnDeviceHandle*) = nullptr;
    void (*release_device)(OidnDeviceHandle*) = nullptr;
    void (*set_device_bool)(OidnDeviceHandle*, const char*, bool) = nullptr;
    int (*get_device_int)(OidnDeviceHandle*, const char*) = nullptr;
    // Returns and forgets the first error since the last call.
    int (*get_device_error)(OidnDeviceHandle*, const char** message) = nullptr;
    OidnFilterHandle* (*new_filter)(OidnDeviceHandle*, const char* type) = nullptr;
    void (*commit_filter)(OidnFilterHandle*) = nullptr;
    void (*execute_filter)(OidnFilterHandle*) = nullptr;
    void (*release_filter)(OidnFilterHandle*) = nullptr;
    void (*set_filter_bool)(OidnFilterHandle*, const char*, bool) = nullptr;
    void (*set_filter_int)(OidnFilterHandle*, const char*, int) = nullptr;
    void (*set_filter_float)(OidnFilterHandle*, const char*, float) = nullptr;
    void (*set_image)(OidnFilterHandle*, const char* name, void* data, int format, size_t width,
                      size_t height, size_t offset, size_t pixel_stride, size_t row_stride) = nullptr;

  private:
    template <class Function>
    void find(Function*& function, const char* name);

    std::string file_;
    std::optional<os::Library> library_;
};

// Where it is looked for: the file that CANDELA_OIDN names, and nowhere else, if that is set; otherwise
// beside the program, in the folder lib beside it, and on the system's path.
std::vector<std::filesystem::path> oidn_candidates();

}  // namespace candela
