// Ref: RFC 3986 (URI), RFC 2397 (data), RFC 4648 (base64).
#include "load/gltf/uri.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "base/text.h"
#include "load/quote.h"

namespace candela::gltf {
namespace {

constexpr uint8_t NO_DIGIT = 255;
constexpr std::string_view SPACES = " \t\r\n";

// The value of each character as a digit of base64.
constexpr std::array<uint8_t, 256> BASE64_DIGITS = [] {
    std::array<uint8_t, 256> digits{};
    digits.fill(NO_DIGIT);
    constexpr std::string_view ALPHABET = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < ALPHABET.size(); ++i)
        digits[uint8_t(ALPHABET[i])] = uint8_t(i);
    return digits;
}();

// Nothing for a text that is not base64. The padding (=) may be missing, and lines may be broken.
std::optional<std::string> decode_base64(std::string_view text) {
    std::string without_spaces;
    if (text.find_first_of(SPACES) != std::string_view::npos) {
        std::ranges::copy_if(text, std::back_inserter(without_spaces),
                             [](char c) { return SPACES.find(c) == std::string_view::npos; });
        text = without_spaces;
    }
    for (int i = 0; i < 2 && text.ends_with('='); ++i)
        text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    uint32_t bits = 0;
    int held = 0;  // Bits that are not written yet.
    for (const char c : text) {
        const uint8_t digit = BASE64_DIGITS[uint8_t(c)];
        if (digit == NO_DIGIT) return std::nullopt;
        bits = bits << 6 | digit;
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes += char(bits >> held & 0xFFu);
    }
    return bytes;
}

std::optional<uint32_t> hex_digit(char c) {
    if (c >= '0' && c <= '9') return uint32_t(c - '0');
    if (c >= 'a' && c <= 'f') return uint32_t(c - 'a' + 10);
    if (c >= 'A' && c <= 'F') return uint32_t(c - 'A' + 10);
    return std::nullopt;
}

// Nothing if a % is not followed by two digits.
std::optional<std::string> decode_percents(const std::string& text) {
    std::string decoded;
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded += text[i];
            continue;
        }
        const auto high = i + 2 < text.size() ? hex_digit(text[i + 1]) : std::nullopt;
        const auto low = high ? hex_digit(text[i + 2]) : std::nullopt;
        if (!low) return std::nullopt;
        decoded += char(16 * *high + *low);
        i += 2;
    }
    return decoded;
}

// Whether a URI begins with a scheme, such as `https:`.
bool has_scheme(std::string_view uri) {
    const size_t end =
        uri.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+-.");
    return end != 0 && end != std::string_view::npos && uri[end] == ':';
}

}  // namespace

std::optional<std::string> inline_data(const Node& uri) {
    const std::string_view text = uri.string();
    constexpr std::string_view SCHEME = "data:";
    if (lower_case(text.substr(0, SCHEME.size())) != SCHEME) return std::nullopt;
    const size_t comma = text.find(',');
    if (comma == std::string_view::npos || !text.substr(0, comma).ends_with(";base64"))
        uri.fail("data in a URI must be base64, data:TYPE;base64,DATA; encode it so");
    const std::string_view data = text.substr(comma + 1);
    std::optional<std::string> bytes;
    if (data.find('%') == std::string_view::npos) {
        bytes = decode_base64(data);
    } else if (const auto decoded = decode_percents(std::string(data))) {
        bytes = decode_base64(*decoded);
    }
    if (!bytes) uri.fail("the data of the URI is not base64; is the file cut off?");
    return bytes;
}

std::filesystem::path file_of(const Node& uri, const std::filesystem::path& folder, const FileReach& reach) {
    const std::string& text = uri.file_name();
    if (text.empty()) uri.fail("the URI is empty; name a file");
    const auto is_absolute = [](const std::string& name) {
        return name.starts_with('/') || name.starts_with('\\');
    };
    const std::optional<std::string> decoded = decode_percents(text);
    if (has_scheme(text) || is_absolute(text) || (decoded && is_absolute(*decoded))) {
        uri.fail("only files that are named relative to this one are read, not " + quote(text.substr(0, 60)) +
                 "; put the file beside this one");
    }
    if (decoded && decoded->find('\0') != std::string::npos)
        uri.fail("a file name cannot hold the character U+0000; remove it");
    // Some programs write names unescaped, or with Windows' separators.
    std::vector<std::string> names{text};
    if (decoded) names.insert(names.begin(), *decoded);
    for (size_t i = 0, count = names.size(); i < count; ++i) {
        std::string with_slashes = names[i];
        std::ranges::replace(with_slashes, '\\', '/');
        names.push_back(with_slashes);
    }
    const auto is_within_reach = [&](const std::string& name) { return reach.holds(folder / name); };
    // The message must not reveal whether a file elsewhere exists.
    const auto is_there = [&](const std::string& name) {
        std::error_code ignored;
        return is_within_reach(name) && std::filesystem::exists(folder / name, ignored);
    };
    const auto found = std::ranges::find_if(names, is_there);
    if (found != names.end()) return folder / *found;
    if (!std::ranges::all_of(names, is_within_reach)) uri.fail(reach.refusal(text));
    if (!decoded) uri.fail("a % in a URI is followed by two hexadecimal digits; write % itself as %25");
    return folder / *decoded;
}

}  // namespace candela::gltf
