// Recognises the formats of texture files, and rejects the rest. See texel_io.h.
#include "image/texel_io.h"

#include <algorithm>
#include <array>
#include <new>

#include "base/error.h"
#include "base/file.h"
#include "base/memory_limit.h"
#include "base/text.h"
#include "image/image_io_parts.h"
#include "image/texel_io_parts.h"

namespace candela {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

// The bytes that all files of a kind have, and their offset.
struct Signature {
    const char* name;  // With its article.
    size_t offset;
    std::string_view bytes;
};

struct TexelFormat {
    Signature signature;
    TexelImage (*decode)(const TexelSource& source);
    std::array<std::string_view, 4> extensions;
};

constexpr std::array<TexelFormat, 8> TEXEL_FORMATS{
    {{{"a PNG image", 0, "\x89PNG\r\n\x1a\n"sv}, decode_png_texels, {".png", ".apng"}},
     {{"a JPEG image", 0, "\xff\xd8\xff"sv}, decode_jpeg_texels, {".jpg", ".jpeg", ".jpe", ".jfif"}},
     {{"a WebP image", 8, "WEBP"sv}, decode_webp_texels, {".webp"}},
     {{"a KTX 2 texture", 0, "\xabKTX 20"sv}, decode_ktx_texels, {".ktx2"}},
     {{"a Radiance picture", 0, HDR_MAGIC}, decode_hdr_texels, {".hdr", ".pic"}},
     {{"an OpenEXR image", 0, EXR_MAGIC}, decode_exr_texels, {".exr"}},
     {{"a BMP image", 0, "BM"sv}, decode_bmp_texels, {".bmp", ".dib"}},
     {{"a Targa image", 0, {}}, decode_targa_texels, {".tga", ".icb", ".vda", ".vst"}}}};

// Other kinds that people use as textures, which are not read.
constexpr std::array<Signature, 16> OTHER_KINDS{{{"a GIF image", 0, "GIF8"sv},
                                                 {"a TIFF image", 0, "II*\0"sv},
                                                 {"a TIFF image", 0, "MM\0*"sv},
                                                 {"a TIFF image", 0, "II+\0"sv},
                                                 {"a TIFF image", 0, "MM\0+"sv},
                                                 {"a Photoshop document", 0, "8BPS"sv},
                                                 {"a DDS texture", 0, "DDS "sv},
                                                 {"a KTX texture", 0, "\xabKTX "sv},
                                                 {"an AVIF image", 4, "ftypavif"sv},
                                                 {"a HEIC image", 4, "ftyphei"sv},
                                                 {"a HEIC image", 4, "ftypmif1"sv},
                                                 {"a JPEG 2000 image", 4, "jP  \r\n\x87\n"sv},
                                                 {"a JPEG 2000 image", 0, "\xff\x4f\xff\x51"sv},
                                                 {"a JPEG XL image", 4, "JXL \r\n\x87\n"sv},
                                                 {"a JPEG XL image", 0, "\xff\x0a"sv},
                                                 {"a PNM image", 0, "P6"sv}}};

// The same for texts, in lower case: the first of their words.
constexpr std::array<Signature, 4> OTHER_TEXTS{{{"an SVG drawing", 0, "<svg"sv},
                                                {"an XML document, perhaps an SVG drawing", 0, "<?xml"sv},
                                                {"a web page", 0, "<!doctype html"sv},
                                                {"a web page", 0, "<html"sv}}};

bool matches(std::string_view bytes, const Signature& signature) {
    return bytes.size() >= signature.offset && bytes.substr(signature.offset).starts_with(signature.bytes);
}

// The beginning of a text in lower case, after a byte-order mark and white space.
std::string lower_start(std::string_view bytes) {
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
    bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
    return lower_case(bytes.substr(0, 32));
}

[[noreturn]] void fail_unknown(const TexelSource& source) {
    if (source.bytes.empty()) source.fail("the file is empty; write it again");
    const auto refuse = [&](const Signature& kind) {
        source.fail("it is " + std::string(kind.name) + "; convert it to " + source.limits.formats);
    };
    for (const Signature& kind : OTHER_KINDS) {
        if (matches(source.bytes, kind)) refuse(kind);
    }
    const std::string start = lower_start(source.bytes);
    for (const Signature& kind : OTHER_TEXTS) {
        if (matches(start, kind)) refuse(kind);
    }
    source.fail("its first bytes are not those of an image that can be read; give " +
                std::string(source.limits.formats));
}

const TexelFormat& find_format(const TexelSource& source) {
    for (const TexelFormat& format : TEXEL_FORMATS) {
        const Signature& signature = format.signature;
        if (signature.bytes.empty() ? is_targa(source.bytes) : matches(source.bytes, signature))
            return format;
    }
    fail_unknown(source);
}

bool has_extension(const TexelFormat& format, std::string_view extension) {
    return std::ranges::find(format.extensions, extension) != format.extensions.end();
}

// Warns of an extension that is another format's.
void check_extension(const TexelSource& source, const TexelFormat& format) {
    const std::string extension = extension_of(source.name);
    if (extension.empty() || has_extension(format, extension)) return;
    if (std::ranges::any_of(TEXEL_FORMATS, [&](const TexelFormat& f) { return has_extension(f, extension); }))
        source.warn("it is " + std::string(format.signature.name) +
                    ", despite its name, and is read as such");
}

}  // namespace

void TexelSource::fail(const std::string& reason) const {
    throw Error("cannot read " + quoted(name) + ": " + reason);
}

void TexelSource::fail_damaged(const std::string& how) const {
    fail("the file is damaged or incomplete (" + how + "); write it again");
}

void TexelSource::fail_too_short(uvec2 size) const {
    fail_damaged("its " + std::to_string(size.x) + 'x' + std::to_string(size.y) + " pixels need more than " +
                 std::to_string(bytes.size()) + " bytes");
}

void TexelSource::warn(const std::string& what) const {
    warnings.push_back(name.string() + ": " + what);
}

TexelImage make_texels(uvec2 size, uint32_t channels, TexelType type) {
    TexelImage image{.size = size, .channels = channels, .type = type, .texels = {}, .gamma = {}};
    image.texels.resize(size_t{size.x} * size.y * channels * byte_size(type));
    return image;
}

TexelImage decode_texels(std::string_view bytes, const fs::path& name, std::vector<std::string>& warnings,
                         const TexelLimits& limits) {
    const TexelSource source{bytes, name, limits, warnings};
    const TexelFormat& format = find_format(source);
    check_extension(source, format);
    const uint64_t before = memory_in_use();
    try {
        return format.decode(source);
    } catch (const std::bad_alloc& error) {
        throw Error("cannot read " + quoted(name) + ": there is not enough memory for its pixels" +
                        shortage_text(error, before) + "; use a smaller image or a larger machine",
                    ErrorKind::out_of_memory);
    }
}

}  // namespace candela
