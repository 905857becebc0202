// Typed access to a value of a JSON document. Every failure throws Error `place: ...` at the value's place,
// such as `file:line:column`, and says what was expected and what was found.
#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/math.h"
#include "base/text.h"
#include "load/json.h"

namespace candela {

// A view: the document and the key must outlive it.
class Node {
  public:
    // `key` names the value in messages: its own key, or the key of the array that contains it.
    Node(const json::Document& document, std::string_view key, const json::Value& value)
        : document_(&document), key_(key), value_(&value) {}
    explicit Node(const json::Document& document) : Node(document, "", document.root) {}

    std::string_view key() const { return key_; }
    // As json::place_of().
    std::string place() const;
    // Throws Error `place: message`.
    [[noreturn]] void fail(const std::string& message) const;
    // Throws Error `place: "key": expected WHAT, found VALUE`.
    [[noreturn]] void fail_expected(const std::string& what) const;
    // Throws Error for a name that is not among `known`, with the nearest known name: `unknown WHAT "name"
    // (did you mean "x"? WORD: x, y, z)`.
    [[noreturn]] void fail_unknown(const std::string& what, std::string_view name,
                                   std::span<const std::string> known,
                                   const std::string& word = "known") const;

    // Objects. `allow_only` checks that no other keys are present. If the key is absent, `find` returns
    // nothing and `require` throws Error. `members` are in the order of the file.
    void allow_only(std::initializer_list<std::string_view> keys,
                    std::span<const std::string_view> more_keys = {}) const;
    std::optional<Node> find(std::string_view key) const;
    Node require(std::string_view key) const;
    std::vector<Node> members() const;

    // Arrays. `i` is below size().
    std::vector<Node> elements() const;
    size_t size() const;
    Node operator[](size_t i) const;

    // As compact JSON.
    std::string text() const { return json::to_text(*value_); }
    bool is_null() const { return std::holds_alternative<std::nullptr_t>(value_->data); }
    bool is_object() const { return std::holds_alternative<json::Object>(value_->data); }
    bool is_array() const { return std::holds_alternative<json::Array>(value_->data); }
    bool is_number() const { return std::holds_alternative<double>(value_->data); }
    bool is_string() const { return std::holds_alternative<std::string>(value_->data); }
    bool boolean() const;
    const std::string& string() const;
    // A string that can name a file.
    const std::string& file_name() const;
    // A number that a float can hold.
    double number() const;
    // A number in [lo, hi], compared as floats, so that a limit written in decimals is within it.
    float number(float lo, float hi) const;
    // A number of at least 0.
    double non_negative() const;
    // A number above 0 that a float can hold with full precision.
    double positive() const;
    // An angle in [-pi, pi] [rad], which the file gives in degrees.
    double angle() const;
    // A whole number in [lo, hi].
    uint32_t integer(uint32_t lo, uint32_t hi) const;
    // An array of `count` numbers that floats can hold.
    std::vector<double> numbers(size_t count) const;
    // Three numbers that floats can hold.
    glm::dvec3 vector() const;
    // One grey number or three, none below 0.
    glm::dvec3 rgb() const;
    // The same, none above 1.
    glm::dvec3 reflectance() const;
    // The value that the string names.
    template <class T, size_t N>
    T choice(const std::array<std::pair<std::string_view, T>, N>& values) const {
        std::vector<std::string> names;
        for (const auto& [name, value] : values) {
            if (string() == name) return value;
            names.emplace_back(name);
        }
        fail_unknown(std::string(key_), string(), names);
    }

  private:
    const json::Object& object() const;
    const json::Array& array() const;
    Node child(std::string_view key, const json::Value& value) const { return {*document_, key, value}; }

    const json::Document* document_;
    std::string_view key_;
    const json::Value* value_;
};

}  // namespace candela
