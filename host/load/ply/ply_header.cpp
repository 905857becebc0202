// One statement per line, by its first word.
#include "load/ply/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <unordered_set>
#include <utility>

#include "base/error.h"
#include "load/quote.h"
#include "load/text_lines.h"

namespace candela {
namespace {

template <class T, size_t N>
using Names = std::array<std::pair<std::string_view, T>, N>;

constexpr Names<PlyFormat, 3> FORMATS{{{"ascii", PlyFormat::ascii},
                                       {"binary_little_endian", PlyFormat::little_endian},
                                       {"binary_big_endian", PlyFormat::big_endian}}};
constexpr Names<PlyType, 16> TYPES{{{"char", PlyType::int8},
                                    {"uchar", PlyType::uint8},
                                    {"short", PlyType::int16},
                                    {"ushort", PlyType::uint16},
                                    {"int", PlyType::int32},
                                    {"uint", PlyType::uint32},
                                    {"float", PlyType::float32},
                                    {"double", PlyType::float64},
                                    {"int8", PlyType::int8},
                                    {"uint8", PlyType::uint8},
                                    {"int16", PlyType::int16},
                                    {"uint16", PlyType::uint16},
                                    {"int32", PlyType::int32},
                                    {"uint32", PlyType::uint32},
                                    {"float32", PlyType::float32},
                                    {"float64", PlyType::float64}}};

class HeaderReader {
  public:
    HeaderReader(std::string_view bytes, const std::string& file)
        : bytes_(bytes), rest_(bytes), file_(file) {}

    PlyHeader read() {
        find_line_end();
        while (read_statement()) {
        }
        if (!has_format_) fail("the header does not state its format; write \"format ascii 1.0\"");
        header_.size = size_t(rest_.data() - bytes_.data());
        return std::move(header_);
    }

  private:
    [[noreturn]] void fail(const std::string& cause) const {
        throw Error(file_ + ':' + std::to_string(header_.lines) + ": " + cause);
    }

    // Binary rows may begin with any byte, even a line feed, so the first line determines how lines end.
    void find_line_end() {
        constexpr std::string_view BYTE_ORDER_MARK = "\xEF\xBB\xBF";
        if (rest_.starts_with(BYTE_ORDER_MARK)) rest_.remove_prefix(BYTE_ORDER_MARK.size());
        const size_t length = std::min(rest_.find_first_of("\r\n"), rest_.size());
        const bool is_ply = trimmed(rest_.substr(0, length)) == "ply";
        rest_.remove_prefix(length);
        if (!is_ply || rest_.empty())
            throw Error(file_ + ": the file does not begin with the line \"ply\"; is it a PLY file?");
        line_end_ = rest_.starts_with('\n') || rest_.starts_with("\r\n") ? '\n' : '\r';
        next_line();
    }

    // Cuts the next line off. Before a line feed, a carriage return belongs to the line's end.
    std::string_view next_line() {
        const size_t length = rest_.find(line_end_);
        if (length == std::string_view::npos)
            throw Error(file_ + ": the header has no line \"end_header\"; is the file cut off?");
        std::string_view line = rest_.substr(0, length);
        rest_.remove_prefix(length + 1);
        if (line.ends_with('\r')) line.remove_suffix(1);
        ++header_.lines;
        return line;
    }

    // Returns false after the last.
    bool read_statement() {
        std::string_view line = next_line();
        const std::string_view statement = next_word(line);
        if (statement == "end_header") return false;
        if (statement == "format") {
            read_format(line);
        } else if (statement == "element") {
            read_element(line);
        } else if (statement == "property") {
            read_property(line);
        } else if (statement == "comment") {
            read_comment(line);
        } else if (!statement.empty() && statement != "obj_info") {
            fail("unknown statement " + shown(quote(statement)) +
                 " (known: format, comment, obj_info, element, property, end_header)");
        }
        return true;
    }

    void read_format(std::string_view rest) {
        const std::string_view name = next_word(rest);
        const std::string_view version = next_word(rest);
        const auto found = find_name(FORMATS, name);
        if (!found || version != "1.0") {
            fail("unknown format " + quote(trimmed(std::string(name) + ' ' + std::string(version))) +
                 " (known: ascii, binary_little_endian, binary_big_endian; each 1.0)");
        }
        header_.format = *found;
        has_format_ = true;
    }

    void read_element(std::string_view rest) {
        PlyElement element;
        element.name = next_word(rest);
        element.line = header_.lines;
        const std::string_view count = next_word(rest);
        const char* end = count.data() + count.size();
        const auto [stop, error] = std::from_chars(count.data(), end, element.rows);
        if (element.name.empty() || error != std::errc() || stop != end)
            fail("an element needs a name and a number of rows, as \"element vertex 8\"");
        if (!elements_.insert(element.name).second)
            fail("element " + quote(element.name) + " is declared twice");
        header_.elements.push_back(std::move(element));
        properties_.clear();
    }

    void read_property(std::string_view rest) {
        if (header_.elements.empty()) fail("a property comes before the first element");
        PlyElement& element = header_.elements.back();
        PlyProperty property;
        std::string_view type = next_word(rest);
        if (type == "list") {
            property.length = type_of(next_word(rest));
            if (!is_integer(*property.length)) fail("the length of a list must be of an integer type");
            type = next_word(rest);
        }
        property.type = type_of(type);
        property.name = next_word(rest);
        if (property.name.empty()) fail("a property needs a type and a name, as \"property float x\"");
        if (!properties_.insert(property.name).second)
            fail("property " + quote(property.name) + " is declared twice");
        element.properties.push_back(std::move(property));
    }

    // MeshLab names images in comments.
    void read_comment(std::string_view rest) {
        if (next_word(rest) == "TextureFile") header_.textures.emplace_back(trimmed(rest));
    }

    PlyType type_of(std::string_view name) const {
        if (const auto type = find_name(TYPES, name)) return *type;
        fail("unknown type " + quote(name) +
             " (known: char, uchar, short, ushort, int, uint, float, double, and those as int8 to float64)");
    }

    template <class T, size_t N>
    static std::optional<T> find_name(const Names<T, N>& names, std::string_view name) {
        for (const auto& [known, value] : names) {
            if (known == name) return value;
        }
        return std::nullopt;
    }

    std::string_view bytes_;
    std::string_view rest_;  // The text after the lines read so far.
    const std::string& file_;
    char line_end_ = '\n';
    bool has_format_ = false;
    std::unordered_set<std::string> elements_;    // The names of all.
    std::unordered_set<std::string> properties_;  // Names of the last element's properties.
    PlyHeader header_;
};

template <class List>
auto find_named(const List& list, std::string_view name) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const auto& x) { return x.name == name; });
    return found == list.end() ? nullptr : &*found;
}

}  // namespace

size_t size_of(PlyType type) {
    constexpr std::array<size_t, 8> SIZES{1, 1, 2, 2, 4, 4, 4, 8};
    return SIZES[size_t(type)];
}

bool is_integer(PlyType type) {
    return type != PlyType::float32 && type != PlyType::float64;
}

const PlyProperty* PlyElement::find(std::string_view property) const {
    return find_named(properties, property);
}

size_t PlyElement::min_size(PlyFormat format) const {
    if (format == PlyFormat::ascii) return 2 * properties.size();  // A digit and a blank.
    size_t size = 0;
    for (const PlyProperty& property : properties)
        size += size_of(property.length.value_or(property.type));
    return size;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
    return find_named(elements, element);
}

PlyHeader read_ply_header(std::string_view bytes, const std::string& file) {
    return HeaderReader(bytes, file).read();
}

}  // namespace candela
