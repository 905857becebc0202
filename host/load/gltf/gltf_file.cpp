// Ref: Khronos, "glTF 2.0 Specification", sections 3.2, 3.6.1 and 4.4.
#include "load/gltf/gltf_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/memory_limit.h"
#include "base/text.h"
#include "load/gltf/meshopt.h"
#include "load/gltf/uri.h"
#include "load/quote.h"

namespace candela::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little-endian, and copied as they are");

constexpr std::string_view BYTE_ORDER_MARK = "\xEF\xBB\xBF";
constexpr std::string_view GLB_MAGIC = "glTF";
constexpr size_t GLB_HEADER_SIZE = 12;
constexpr size_t CHUNK_HEADER_SIZE = 8;
constexpr uint32_t JSON_CHUNK = 0x4E4F534A;
constexpr uint32_t BINARY_CHUNK = 0x004E4942;

uint32_t word_at(std::string_view bytes, size_t offset) {
    uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

std::span<const std::byte> as_span(std::string_view bytes) {
    return std::as_bytes(std::span(bytes.data(), bytes.size()));
}

// How many bytes the character of UTF-8 at `i` has; 0 if there is none.
size_t character_size(std::string_view text, size_t i) {
    const auto lead = uint8_t(text[i]);
    if (lead < 0x80u) return 1;
    const size_t size = lead >= 0xC2u && lead < 0xE0u   ? 2
                        : lead >= 0xE0u && lead < 0xF0u ? 3
                        : lead >= 0xF0u && lead < 0xF5u ? 4
                                                        : 0;
    if (i + size > text.size()) return 0;
    for (size_t k = 1; k < size; ++k) {
        if ((uint8_t(text[i + k]) & 0xC0u) != 0x80u) return 0;
    }
    return size;
}

// The text with bytes that are not UTF-8 as the characters of Latin-1; nothing if there are none.
std::optional<std::string> mended(std::string_view text) {
    const auto end_of_utf8 = [&](size_t i) {
        while (i < text.size() && character_size(text, i) > 0)
            i += character_size(text, i);
        return i;
    };
    size_t end = end_of_utf8(0);
    if (end == text.size()) return std::nullopt;
    std::string result(text.substr(0, end));
    while (end < text.size()) {
        const auto code = uint8_t(text[end]);
        result += {char(0xC0u | code >> 6u), char(0x80u | (code & 0x3Fu))};
        const size_t begin = end + 1;
        end = end_of_utf8(begin);
        result += text.substr(begin, end - begin);
    }
    return result;
}

// Throws Error unless a loader of glTF 2.0 can read the file.
void check_version(const Node& root) {
    const Node asset = root.require("asset");
    const auto major = [](const Node& version) {
        const std::string& text = version.string();
        return text.substr(0, text.find('.'));
    };
    const Node version = asset.require("version");
    const auto min = asset.find("minVersion");
    const Node& decisive = min ? *min : version;
    if (major(decisive) != "2" || (min && min->string() != "2.0")) {
        decisive.fail("only glTF 2.0 is read, not " + quote(decisive.string()) +
                      "; export the scene as glTF 2.0");
    }
}

ReadProgress bytes_of(const LoadProgress& progress) {
    return [&progress](size_t done, size_t of) { progress("bytes", done, of); };
}

}  // namespace

Contents::Contents(const std::filesystem::path& path, FileReach reach, const LoadProgress& progress)
    : reach_(std::move(reach)), path_(path) {
    bytes_ = reach_.read(path, UINT64_MAX, bytes_of(progress));
    document_.file = path.string();
    document_.places = json::Document::Places::pointers;
    document_.nulls_are_absent = true;  // Some programs write null for unknown values.
    std::string_view text = bytes_.starts_with(GLB_MAGIC) ? split_glb() : std::string_view(bytes_);
    if (text.starts_with(BYTE_ORDER_MARK))
        text.remove_prefix(BYTE_ORDER_MARK.size());  // Some programs write a byte order mark.
    const std::optional<std::string> in_utf8 = mended(text);
    if (in_utf8)
        warnings_.push_back(document_.file + ": the text is not UTF-8; other bytes are read as Latin-1");
    document_.root = json::parse(in_utf8 ? *in_utf8 : text, document_.file);
    if (!root().is_object()) root().fail_expected("an object { ... }, as every glTF file is");
    check_version(root());
}

// Finds the chunks; returns that of the JSON document.
std::string_view Contents::split_glb() {
    const std::string name = path_.string();
    std::string_view bytes = bytes_;
    const auto cut_off = [&](const char* what) {
        throw Error(name + ": the file is cut off: " + what + "; copy or export it again");
    };
    if (bytes.size() < GLB_HEADER_SIZE) cut_off("its header has 12 bytes");
    if (const uint32_t version = word_at(bytes, 4); version != 2) {
        throw Error(concat(name, ": the file is binary glTF of version ", version,
                           "; version 2 is read: export the scene as glTF 2.0"));
    }
    const uint32_t length = word_at(bytes, 8);
    if (length > bytes.size()) cut_off("it is shorter than its header says");

    std::optional<std::string_view> text;
    size_t offset = GLB_HEADER_SIZE, chunks = 0;
    for (; offset < bytes.size() && offset != length; ++chunks) {
        if (bytes.size() - offset < CHUNK_HEADER_SIZE) {
            if (text) break;
            cut_off("a chunk's header has 8 bytes");
        }
        const size_t size = word_at(bytes, offset);
        const uint32_t type = word_at(bytes, offset + 4);
        offset += CHUNK_HEADER_SIZE;
        if (size > bytes.size() - offset) cut_off("a chunk is shorter than its header says");
        if (chunks == 0 && type == JSON_CHUNK) text = bytes.substr(offset, size);
        if (text && !chunk_ && type == BINARY_CHUNK) chunk_ = bytes.substr(offset, size);
        offset += size;
    }
    if (!text) throw Error(name + ": the first chunk of the file is not its JSON document; export it again");
    if (offset < bytes.size()) {
        warnings_.push_back(concat(name, ": ignored what follows the last chunk, at byte ", offset));
    } else if (length < offset) {
        warnings_.push_back(concat(name, ": the header states ", length, " bytes, but the chunks have ",
                                   offset, "; all are read"));
    }
    // Padded with spaces; some programs pad with zeros.
    return text->substr(0, text->find_last_not_of('\0') + 1);
}

File::File(Contents& contents, LoadProgress progress)
    : contents_(contents),
      progress_(std::move(progress)),
      is_read_(count("buffers")),
      images_(count("images")) {
    for (const std::string& warning : contents.warnings())
        warn(warning);
}

std::filesystem::path File::named(const Node& uri) const {
    return file_of(uri, path().parent_path(), contents_.reach());
}

std::string File::read_named(const Node& uri, uint64_t max) const {
    const std::filesystem::path path = named(uri);
    try {
        return with_memory_for(
            "the bytes of the file", [&] { return path.string(); },
            [&] { return contents_.reach().read(path, max, bytes_of(progress_)); });
    } catch (const Error& error) {
        throw Error(uri.place() + ": " + error.what(), error.kind());
    }
}

size_t File::count(std::string_view array) const {
    const auto found = root().find(array);
    return found ? found->size() : 0;
}

Node File::element(std::string_view array, size_t i) const {
    return root().require(array)[i];
}

uint32_t File::index(std::string_view array, const Node& reference) const {
    const uint32_t i = reference.integer(0, UINT32_MAX);
    const size_t of = count(array);
    if (i < of) return i;
    reference.fail(
        concat('"', array, "\" has no element ", i,
               of == 0 ? std::string(": it is empty or missing") : ", only 0 to " + std::to_string(of - 1),
               "; name one that the file has"));
}

std::span<const std::byte> File::view_bytes(const Node& view) {
    const auto extension = meshopt_of(view);
    if (!extension) return plain_bytes(view);
    const std::string place = extension->place();
    const auto& bytes = contents_.keep("bytes of " + place, [&] {
        return with_memory_for(
            "the data that meshopt has compressed", [&] { return extension->place(); },
            [&] { return decode_meshopt(view, *extension, plain_bytes(*extension)); });
    });
    count_decoded(place, bytes.count);
    return {bytes.first.get(), bytes.count};
}

std::span<const std::byte> File::plain_bytes(const Node& view) {
    const Node buffer = view.require("buffer");
    const std::span<const std::byte> bytes = buffer_bytes(index("buffers", buffer));
    const auto offset_node = view.find("byteOffset");
    const uint64_t offset = offset_node ? offset_node->integer(0, UINT32_MAX) : 0;
    const uint64_t length = view.require("byteLength").integer(1, UINT32_MAX);
    if (offset + length > bytes.size()) {
        view.fail(concat("the view ends at byte ", offset + length, " of its buffer, which has ",
                         bytes.size(), "; is a file cut off?"));
    }
    return bytes.subspan(offset, length);
}

std::string_view File::named_buffer(uint32_t i, const Node& uri, size_t length) {
    struct Buffer {
        std::string bytes;
        std::optional<std::filesystem::path> file;  // None: the bytes are in the URI.
    };
    const auto& buffer = contents_.keep(concat("buffer ", i), [&] {
        if (auto data = inline_data(uri)) return Buffer{std::move(*data), std::nullopt};
        return Buffer{read_named(uri, length), named(uri)};
    });
    if (!is_read_[i]) {
        is_read_[i] = true;
        buffer_bytes_read_ += buffer.bytes.size();
        if (buffer.file) files_.push_back(*buffer.file);
    }
    return buffer.bytes;
}

std::span<const std::byte> File::buffer_bytes(uint32_t i) {
    const Node buffer = element("buffers", i);
    const size_t length = buffer.require("byteLength").integer(1, UINT32_MAX);
    const auto uri = buffer.find("uri");
    std::string_view bytes;
    if (uri) {
        bytes = named_buffer(i, *uri, length);
    } else if (i == 0 && contents_.chunk()) {
        bytes = *contents_.chunk();
    } else {
        if (meshopt_of(buffer)) {
            buffer.fail(
                "the buffer has no bytes, as only views that meshopt compresses may refer to it, but another "
                "does; export the file again");
        }
        buffer.fail(
            "the buffer has neither a uri nor, as the first of a .glb, a binary chunk; export the file "
            "again");
    }
    if (bytes.size() < length) {
        warn(buffer, concat("the buffer has ", bytes.size(), " bytes, not the ", length,
                            " that its byteLength states; is a file cut off?"));
    }
    return as_span(bytes.substr(0, length));
}

void File::warn(const std::string& text) {
    if (warned_.insert(text).second) warnings_.push_back(text);
}

}  // namespace candela::gltf
