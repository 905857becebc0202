// Groups similar warnings. See printable.h.
#include <algorithm>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/printable.h"

namespace candela {
namespace {

constexpr size_t MAX_OF_A_KIND = 3;
constexpr size_t MAX_BYTES = size_t{64} << 10;
constexpr size_t AROUND_LINE = 24;  // Bytes printed around each line.

constexpr std::string_view DIGITS = "0123456789";

// The length of the place that `text` begins with, such as `#/a/0` or `:12:3`; 0 if there is none.
size_t length_of_place(std::string_view text) {
    if (text.starts_with("#/")) return std::min(text.find_first_of(" ,:;\""), text.size());
    size_t length = 0;
    while (text.substr(length).starts_with(':')) {
        const size_t end = std::min(text.find_first_not_of(DIGITS, length + 1), text.size());
        if (end == length + 1) break;
        length = end;
    }
    return length;
}

std::string without_places(std::string_view warning) {
    std::string text;
    while (!warning.empty()) {
        const size_t length = length_of_place(warning);
        if (length == 0) text += warning[0];
        warning.remove_prefix(std::max<size_t>(length, 1));
    }
    return text;
}

// The length of a quotation that `text` begins with, in which a backslash escapes quotation marks.
size_t length_of_quotation(std::string_view text) {
    size_t length = 1;
    while (length < text.size() && text[length] != '"')
        length += text[length] == '\\' ? 2 : 1;
    return std::min(length + 1, text.size());
}

// `text` without names and numbers: without quoted text, and words with digits, inner dots or slashes.
std::string without_names(std::string_view text) {
    std::string kind;
    while (!text.empty()) {
        size_t length = 1;
        if (text[0] == '"') {
            length = length_of_quotation(text);
            kind += '"';
        } else if (text[0] == ' ') {
            kind += ' ';
        } else {
            length = std::min(text.find_first_of(" \""), text.size());
            const std::string_view word = text.substr(0, length);
            const size_t end = word.find_last_not_of(".,;:)") + 1;  // Before punctuation.
            const bool is_name =
                word.substr(0, end).find_first_of("0123456789./\\") != std::string_view::npos;
            kind += is_name ? std::string(word.substr(end)) : std::string(word);
        }
        text.remove_prefix(length);
    }
    return kind;
}

// Equal warnings about several places.
struct Same {
    const std::string* first;
    size_t count = 0;
};

struct Kind {
    std::vector<Same> shown;
    size_t more = 0;  // Warnings that are not shown.
};

std::string line_of(const Same& same) {
    if (same.count == 1) return printable(*same.first, MAX_MESSAGE_BYTES);
    const std::string times = " (" + std::to_string(same.count) + " times)";
    return printable(*same.first, MAX_MESSAGE_BYTES - times.size()) + times;
}

std::vector<Kind> kinds_of(const std::vector<std::string>& warnings) {
    std::vector<Kind> kinds;
    std::unordered_map<std::string, size_t> kind_of;
    // The kind of each text that is shown, and which of its texts it is.
    std::unordered_map<std::string, std::pair<size_t, size_t>> shown;
    for (const std::string& warning : warnings) {
        std::string text = without_places(warning);
        if (const auto known = shown.find(text); known != shown.end()) {
            ++kinds[known->second.first].shown[known->second.second].count;
            continue;
        }
        const auto [found, is_new] = kind_of.emplace(without_names(text), kinds.size());
        if (is_new) kinds.emplace_back();
        Kind& kind = kinds[found->second];
        if (kind.shown.size() == MAX_OF_A_KIND) {
            ++kind.more;
            continue;
        }
        shown.emplace(std::move(text), std::pair(found->second, kind.shown.size()));
        kind.shown.push_back({&warning, 1});
    }
    return kinds;
}

}  // namespace

std::vector<std::string> summary_of(const std::vector<std::string>& warnings) {
    std::vector<std::string> lines;
    size_t bytes = 0, left = warnings.size();
    for (const Kind& kind : kinds_of(warnings)) {
        for (const Same& same : kind.shown) {
            std::string line = line_of(same);
            bytes += line.size() + AROUND_LINE;
            if (bytes > MAX_BYTES) break;
            lines.push_back(std::move(line));
            left -= same.count;
        }
        if (bytes > MAX_BYTES) break;
        if (kind.more == 0) continue;
        lines.push_back(std::to_string(kind.more) + " more like the last, with other names or numbers");
        left -= kind.more;
    }
    if (left > 0) lines.push_back(std::to_string(left) + " more warnings");
    return lines;
}

}  // namespace candela
