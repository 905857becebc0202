// nlohmann-json parses and validates, but its events carry no positions. So a cursor walks over the same
// text, one token per event; it can be simple, since it only passes tokens that the parser has accepted.
#include "load/json.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>
#include <unordered_set>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "load/quote.h"

namespace candela::json {
namespace {

constexpr size_t MAX_NESTING = 256;  // A value's destructor recurses this deep.

class Cursor {
  public:
    explicit Cursor(std::string_view text) : text_(text) {}

    Place place() const { return place_; }
    size_t offset() const { return offset_; }
    bool at(std::string_view token) const { return text_.substr(offset_, token.size()) == token; }
    bool at_separator() const { return at(",") || at(":"); }

    void advance() {
        const char c = text_[offset_++];
        if (c == '\n') {
            ++place_.line;
            place_.column = 1;
        } else if ((offset_ >= text_.size()) || (uint8_t(text_[offset_]) & 0xC0u) != 0x80u) {
            ++place_.column;  // The next byte begins a code point.
        }
    }

    // Moves over white space and comments, but not over a comment that lacks its end.
    void skip_space() {
        for (;;) {
            size_t end = text_.find_first_not_of(" \t\r\n", offset_);
            if (at("//")) {
                end = text_.find_first_of("\r\n", offset_);
            } else if (at("/*")) {
                end = text_.find("*/", offset_ + 2);
                if (end == std::string_view::npos) return;
                end += 2;
            }
            if (end == offset_) return;
            advance_to(std::min(end, text_.size()));
            if (offset_ == text_.size()) return;
        }
    }

    // Moves over the token at the cursor.
    void skip_token() {
        if (at("\"")) {
            do {
                if (at("\\")) advance();
                advance();
            } while (!at("\""));
            advance();
        } else if (at("[") || at("]") || at("{") || at("}")) {
            advance();
        } else {
            advance_to(std::min(text_.find_first_of(" \t\r\n,:[]{}/", offset_), text_.size()));
        }
    }

  private:
    void advance_to(size_t end) {
        while (offset_ < end)
            advance();
    }

    std::string_view text_;
    size_t offset_ = 0;
    Place place_;
};

// The readable part of a message such as "[json.exception.parse_error.101] parse error at line 1, column 2:
// syntax error while parsing value - invalid literal; last read: 'x'". The place is left to fail().
std::string cause_of(const nlohmann::json::exception& exception) {
    constexpr int NUMBER_OVERFLOW = 406;
    if (exception.id == NUMBER_OVERFLOW) return "the number is too large; write one below 1.8e308";
    std::string text = exception.what();
    text.erase(0, text.find("] ") + 2);
    if (text.starts_with("parse error at")) text.erase(0, text.find(": ") + 2);
    return text.substr(0, text.find("; last read:"));
}

// Receives the parser's events and builds the document.
class Builder : public nlohmann::json_sax<nlohmann::json> {
  public:
    Builder(std::string_view text, const std::string& file) : cursor_(text), file_(file) {}

    Value take() { return std::move(root_); }

    bool null() override { return add(nullptr); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(number_integer_t value) override { return add(double(value)); }
    bool number_unsigned(number_unsigned_t value) override { return add(double(value)); }
    bool number_float(number_float_t value, const string_t&) override { return add(value); }
    bool string(string_t& value) override { return add(std::move(value)); }
    bool binary(binary_t&) override { return false; }  // Never occurs in text.
    bool start_object(size_t) override { return open<Object>(); }
    bool start_array(size_t) override { return open<Array>(); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t& key) override {
        const Place place = next_token();
        Open& object = open_.back();
        if (!object.keys.insert(key).second) {
            fail(file_, place, "duplicate key " + shown(quote(key)) + "; keep one of the two");
        }
        std::get<Object>(object.value.data).push_back({std::move(key), place, {}});
        return true;
    }

    // `position` is the offset after the token that the parser refused. The parser may have accepted
    // separators since the last event.
    bool parse_error(size_t position, const std::string&,
                     const nlohmann::json::exception& exception) override {
        cursor_.skip_space();
        while (cursor_.at_separator() && cursor_.offset() + 1 < position) {
            cursor_.advance();
            cursor_.skip_space();
        }
        fail(file_, cursor_.place(), cause_of(exception));
    }

  private:
    // An array or object whose end has not been reached.
    struct Open {
        Value value;
        std::unordered_set<std::string> keys;
    };

    // Moves past the token of the current event and returns its place.
    Place next_token() {
        cursor_.skip_space();
        while (cursor_.at_separator()) {
            cursor_.advance();
            cursor_.skip_space();
        }
        const Place place = cursor_.place();
        cursor_.skip_token();
        return place;
    }

    template <class Data>
    bool add(Data&& data) {
        attach({next_token(), std::forward<Data>(data)});
        return true;
    }

    template <class Container>
    bool open() {
        const Place place = next_token();
        if (open_.size() == MAX_NESTING) {
            fail(file_, place,
                 "arrays and objects are nested deeper than " + std::to_string(MAX_NESTING) +
                     "; nest them less");
        }
        Value& value = open_.emplace_back().value;
        value.place = place;
        value.data.emplace<Container>();
        return true;
    }

    bool close() {
        next_token();
        Value value = std::move(open_.back().value);
        if (auto* object = std::get_if<Object>(&value.data)) object->sort_keys();
        open_.pop_back();
        attach(std::move(value));
        return true;
    }

    void attach(Value&& value) {
        if (open_.empty()) {
            root_ = std::move(value);
        } else if (auto* array = std::get_if<Array>(&open_.back().value.data)) {
            array->push_back(std::move(value));
        } else {
            std::get<Object>(open_.back().value.data).back().value = std::move(value);
        }
    }

    Cursor cursor_;
    const std::string& file_;
    std::vector<Open> open_;
    Value root_;
};

// Refuses texts that the parser would report badly, or not at all.
void check_encoding(std::string_view text, const std::string& file) {
    if (text.empty()) fail(file, {}, "the file is empty; a scene is a JSON object { ... }");
    if (text.starts_with("\xEF\xBB\xBF")) {
        fail(file, {}, "the file begins with a byte order mark; save it as UTF-8 without one");
    }
    const size_t nul = text.find('\0');
    if (nul == std::string_view::npos) return;
    Cursor cursor(text);
    while (cursor.offset() < nul)
        cursor.advance();
    fail(file, cursor.place(), "found a byte of value 0: this is not text; a scene is JSON in UTF-8");
}

std::string line_text(const std::string& file, Place place) {
    return file + ':' + std::to_string(place.line) + ':' + std::to_string(place.column);
}

bool is_at_or_before(Place a, Place b) {
    return a.line != b.line ? a.line < b.line : a.column <= b.column;
}

// Finds, among values in the order of the file, the last one that begins at or before a place; the end if
// there is none.
template <class Values, class PlaceOf>
auto last_until(const Values& values, Place place, const PlaceOf& place_of) {
    const auto after = std::partition_point(values.begin(), values.end(), [&](const auto& value) {
        return is_at_or_before(place_of(value), place);
    });
    return after == values.begin() ? values.end() : std::prev(after);
}

// Appends the JSON pointer from `value` to the one that begins at a place, which its places lead to.
void append_pointer(const Value* value, Place place, std::string& pointer) {
    while (value->place.line != place.line || value->place.column != place.column) {
        if (const auto* array = std::get_if<Array>(&value->data)) {
            const auto next = last_until(*array, place, [](const Value& v) { return v.place; });
            if (next == array->end()) return;
            pointer += '/' + std::to_string(next - array->begin());
            value = &*next;
        } else if (const auto* object = std::get_if<Object>(&value->data)) {
            const auto next = last_until(*object, place, [](const Member& m) { return m.value.place; });
            if (next == object->end()) return;
            pointer += '/';
            for (const char c : printable(next->key, MAX_NAME_BYTES)) {
                if (c == '~' || c == '/') {
                    pointer += c == '~' ? "~0" : "~1";
                } else {
                    pointer += c;
                }
            }
            value = &next->value;
        } else {
            return;
        }
    }
}

}  // namespace

const Member* Object::find(std::string_view key) const {
    if (by_key_.empty()) {
        const auto found = std::ranges::find(*this, key, &Member::key);
        return found == end() ? nullptr : &*found;
    }
    const auto key_of = [this](uint32_t i) -> std::string_view { return (*this)[i].key; };
    const auto found = std::ranges::lower_bound(by_key_, key, {}, key_of);
    return found != by_key_.end() && key_of(*found) == key ? &(*this)[*found] : nullptr;
}

void Object::sort_keys() {
    constexpr size_t FEW = 16;
    if (size() <= FEW) return;
    by_key_.resize(size());
    std::iota(by_key_.begin(), by_key_.end(), 0u);
    std::ranges::sort(by_key_, {}, [this](uint32_t i) -> std::string_view { return (*this)[i].key; });
}

Value parse(std::string_view text, const std::string& file) {
    check_encoding(text, file);
    Builder builder(text, file);
    constexpr bool WHOLE_TEXT = true;
    constexpr bool IGNORE_COMMENTS = true;
    nlohmann::json::sax_parse(text, &builder, nlohmann::json::input_format_t::json, WHOLE_TEXT,
                              IGNORE_COMMENTS);
    return builder.take();
}

void fail(const std::string& file, Place place, const std::string& message) {
    throw Error(line_text(file, place) + ": " + message);
}

std::string place_of(const Document& document, const Value& value) {
    if (document.places == Document::Places::lines) return line_text(document.file, value.place);
    std::string pointer = document.file + '#';
    append_pointer(&document.root, value.place, pointer);
    return pointer;
}

std::string to_text(const Value& value) {
    std::string text;
    if (const auto* array = std::get_if<Array>(&value.data)) {
        for (const Value& element : *array)
            text += (text.empty() ? "" : ",") + to_text(element);
        return '[' + text + ']';
    }
    if (const auto* object = std::get_if<Object>(&value.data)) {
        for (const Member& member : *object)
            text += (text.empty() ? "" : ",") + json_string(member.key) + ':' + to_text(member.value);
        return '{' + text + '}';
    }
    if (const auto* string = std::get_if<std::string>(&value.data)) return json_string(*string);
    return describe(value);
}

std::string describe(const Value& value) {
    struct Describer {
        std::string operator()(std::nullptr_t) const { return "null"; }
        std::string operator()(bool b) const { return b ? "true" : "false"; }
        std::string operator()(double number) const {
            std::array<char, 32> text;
            return {text.data(), std::to_chars(text.begin(), text.end(), number).ptr};
        }
        std::string operator()(const std::string& text) const { return quote(text); }
        std::string operator()(const Object&) const { return "an object"; }
        std::string operator()(const Array& array) const {
            constexpr size_t MAX_SHOWN = 4;
            const auto is_number = [](const Value& v) { return std::holds_alternative<double>(v.data); };
            if (array.size() > MAX_SHOWN || !std::all_of(array.begin(), array.end(), is_number)) {
                return "an array of " + std::to_string(array.size());
            }
            std::string text;
            for (const Value& element : array)
                text += (text.empty() ? "" : ", ") + describe(element);
            return '[' + text + ']';
        }
    };
    return std::visit(Describer(), value.data);
}

}  // namespace candela::json
