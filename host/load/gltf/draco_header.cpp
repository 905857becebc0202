// Ref: Google, "Draco 3D Graphics Compression: Bitstream Specification", sections 4.1, 4.2, 5.1 and 5.2.
#include "load/gltf/draco_header.h"

#include <string_view>

#include "base/text.h"

namespace candela::gltf {
namespace {

constexpr std::string_view MAGIC = "DRACO";
constexpr uint32_t MAJOR = 2, MINOR = 2;
constexpr uint32_t TRIANGULAR_MESH = 1;
constexpr uint32_t SEQUENTIAL = 0, EDGEBREAKER = 1;  // Methods.
constexpr uint32_t HAS_METADATA = 0x80;              // In the second byte of the flags.

// Reads from the front of bytes; past their end, zeros.
class Reader {
  public:
    explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    bool at_end() const { return bytes_.empty(); }

    uint32_t byte() {
        if (bytes_.empty()) return 0;
        const auto first = uint32_t(bytes_.front());
        bytes_ = bytes_.subspan(1);
        return first;
    }

    // Seven bits to a byte, the lowest first.
    uint32_t varint() {
        uint32_t value = 0;
        for (uint32_t shift = 0; shift < 35; shift += 7) {
            const uint32_t next = byte();
            value |= (next & 0x7Fu) << shift;
            if ((next & 0x80u) == 0) break;
        }
        return value;
    }

    void skip(size_t count) { bytes_ = bytes_.subspan(count < bytes_.size() ? count : bytes_.size()); }

  private:
    std::span<const std::byte> bytes_;
};

// One object of metadata: entries, and others below it, which stand in the order of the tree.
void skip_metadata(Reader& reader) {
    const auto skip_name = [&] { reader.skip(reader.byte()); };
    for (uint64_t pending = 1, done = 0; pending > 0 && !reader.at_end(); --pending, ++done) {
        if (done > 0) skip_name();
        for (uint32_t entries = reader.varint(); entries > 0 && !reader.at_end(); --entries) {
            skip_name();
            reader.skip(reader.varint());
        }
        pending += reader.varint();
    }
}

void skip_all_metadata(Reader& reader) {
    for (uint32_t attributes = reader.varint(); attributes > 0 && !reader.at_end(); --attributes) {
        reader.varint();  // Of which attribute.
        skip_metadata(reader);
    }
    skip_metadata(reader);
}

}  // namespace

std::optional<DracoHeader> read_draco_header(std::span<const std::byte> bytes, std::string& problem) {
    Reader reader(bytes);
    for (const char letter : MAGIC) {
        if (reader.byte() == uint32_t(uint8_t(letter))) continue;
        problem = "the data do not begin with \"DRACO\"";
        return std::nullopt;
    }
    const uint32_t major = reader.byte(), minor = reader.byte();
    if (major != MAJOR || minor != MINOR) {
        problem = concat("the data are in version ", major, ".", minor, " of Draco's format, not 2.2");
        return std::nullopt;
    }
    const uint32_t type = reader.byte(), method = reader.byte();
    reader.byte();
    const bool has_metadata = (reader.byte() & HAS_METADATA) != 0;
    if (type != TRIANGULAR_MESH || (method != SEQUENTIAL && method != EDGEBREAKER)) {
        problem = "the data do not hold a mesh of triangles";
        return std::nullopt;
    }
    if (has_metadata) skip_all_metadata(reader);
    DracoHeader header;
    if (method == SEQUENTIAL) {
        header.faces = reader.varint();
        header.vertices = reader.varint();
    } else {
        reader.byte();  // How connectivity is coded.
        header.vertices = reader.varint();
        header.faces = reader.varint();
    }
    if (reader.at_end()) {
        problem = "the data end within their header";
        return std::nullopt;
    }
    return header;
}

}  // namespace candela::gltf
