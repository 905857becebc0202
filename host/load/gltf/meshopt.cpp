// Ref: Khronos, "EXT_meshopt_compression".
#include "load/gltf/meshopt.h"

#include <array>
#include <string_view>
#include <utility>

#include <meshoptimizer.h>

#include "base/text.h"
#include "load/gltf/values.h"

namespace candela::gltf {
namespace {

enum class Mode { attributes, triangles, indices };
enum class Filter { none, octahedral, quaternion, exponential };

constexpr std::array<std::pair<std::string_view, Mode>, 3> MODES{
    {{"ATTRIBUTES", Mode::attributes}, {"TRIANGLES", Mode::triangles}, {"INDICES", Mode::indices}}};
constexpr std::array<std::pair<std::string_view, Filter>, 4> FILTERS{{{"NONE", Filter::none},
                                                                      {"OCTAHEDRAL", Filter::octahedral},
                                                                      {"QUATERNION", Filter::quaternion},
                                                                      {"EXPONENTIAL", Filter::exponential}}};

// No stream is shorter than this part of what it holds: one byte each of 256 vertices takes at least two
// bits, and a triangle or an index at least a byte.
constexpr uint64_t MOST_PER_BYTE = 1024;

// A view as its extension describes it.
struct Stream {
    Mode mode = Mode::attributes;
    Filter filter = Filter::none;
    uint32_t count = 0;
    uint32_t stride = 0;  // [bytes]
};

void check_stride(const Node& node, const Stream& stream) {
    constexpr uint32_t MOST = 256;
    const uint32_t stride = stream.stride;
    if (stream.mode != Mode::attributes) {
        if (stride != 2 && stride != 4) node.fail_expected("2 or 4, the size of an index");
    } else if (stream.filter == Filter::octahedral) {
        if (stride != 4 && stride != 8) node.fail_expected("4 or 8 for the filter OCTAHEDRAL");
    } else if (stream.filter == Filter::quaternion) {
        if (stride != 8) node.fail_expected("8 for the filter QUATERNION");
    } else if (stride % 4 != 0 || stride > MOST) {
        node.fail_expected("a multiple of 4 up to 256");
    }
}

Stream read_stream(const Node& extension) {
    Stream stream;
    stream.mode = extension.require("mode").choice(MODES);
    if (const auto filter = extension.find("filter")) {
        constexpr std::string_view OF_KHR = "COLOR";
        if (filter->is_string() && filter->string() == OF_KHR) {
            filter->fail(
                "the filter COLOR of KHR_meshopt_compression is not read; export the file with "
                "EXT_meshopt_compression");
        }
        stream.filter = filter->choice(FILTERS);
        if (stream.filter != Filter::none && stream.mode != Mode::attributes)
            filter->fail("only the mode ATTRIBUTES has filters; export the file again");
    }
    stream.count = extension.require("count").integer(1, UINT32_MAX);
    const Node stride = extension.require("byteStride");
    stream.stride = stride.integer(1, UINT32_MAX);
    check_stride(stride, stream);
    if (stream.mode == Mode::triangles && stream.count % 3 != 0)
        extension.require("count").fail_expected("a multiple of 3 for the mode TRIANGLES");
    return stream;
}

// What the library returns: 0, or the kind of flaw.
int decode_stream(const Stream& stream, std::span<const std::byte> compressed, std::span<std::byte> result) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(compressed.data());
    const size_t size = compressed.size();
    switch (stream.mode) {
        case Mode::attributes:
            return meshopt_decodeVertexBuffer(result.data(), stream.count, stream.stride, bytes, size);
        case Mode::triangles:
            return meshopt_decodeIndexBuffer(result.data(), stream.count, stream.stride, bytes, size);
        case Mode::indices:
            return meshopt_decodeIndexSequence(result.data(), stream.count, stream.stride, bytes, size);
    }
    return 0;
}

void unfilter(const Stream& stream, std::span<std::byte> result) {
    switch (stream.filter) {
        case Filter::none:
            break;
        case Filter::octahedral:
            meshopt_decodeFilterOct(result.data(), stream.count, stream.stride);
            break;
        case Filter::quaternion:
            meshopt_decodeFilterQuat(result.data(), stream.count, stream.stride);
            break;
        case Filter::exponential:
            meshopt_decodeFilterExp(result.data(), stream.count, stream.stride);
            break;
    }
}

// Throws Error for a stream that begins otherwise than those of its mode: with a letter for the mode and a
// version, four bits each.
void check_header(const Node& extension, const Stream& stream, std::byte first) {
    constexpr std::array<unsigned, 3> LETTERS{0xA, 0xE, 0xD};
    constexpr std::array<unsigned, 3> VERSIONS{0, 1, 1};  // The last that every version of the library knows.
    const auto mode = size_t(stream.mode);
    const auto letter = unsigned(first) >> 4u, version = unsigned(first) & 0xFu;
    if (letter != LETTERS[mode]) {
        extension.fail(concat("the compressed data do not begin as those of the mode ", MODES[mode].first,
                              " do; is the file damaged?"));
    }
    if (version <= VERSIONS[mode]) return;
    extension.fail(concat("the data are compressed by meshopt's format ", version,
                          " (KHR_meshopt_compression), which the library that candela was built with does "
                          "not read; export the file with EXT_meshopt_compression, or uncompressed"));
}

}  // namespace

std::optional<Node> meshopt_of(const Node& element) {
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        if (auto extension = extension_of(element, name)) return extension;
    }
    return std::nullopt;
}

DecodedBytes decode_meshopt(const Node& view, const Node& extension, std::span<const std::byte> compressed) {
    const Stream stream = read_stream(extension);
    const uint64_t length = uint64_t(stream.count) * stream.stride;
    if (const uint64_t stated = view.require("byteLength").integer(1, UINT32_MAX); stated != length) {
        extension.fail(concat("the extension describes ", length, " bytes, but the view has ", stated,
                              "; export the file again"));
    }
    if (length > MOST_PER_BYTE * compressed.size()) {
        extension.fail(
            concat(compressed.size(), " compressed bytes cannot hold ", length, "; is the file damaged?"));
    }
    // The decoder writes all of it, so that nothing fills it with zeros before.
    const auto bytes = std::make_shared_for_overwrite<std::byte[]>(length);
    const std::span result(bytes.get(), length);
    if (decode_stream(stream, compressed, result) != 0) {
        check_header(extension, stream, compressed.front());
        extension.fail("the compressed data are damaged; copy or export the file again");
    }
    unfilter(stream, result);
    return {bytes, length};
}

}  // namespace candela::gltf
