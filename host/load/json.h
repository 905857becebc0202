// A JSON document in which every value knows its place in the file, so that later messages about it can begin
// with `file:line:column`, or with its JSON pointer. Comments (// and /* */) are allowed.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace candela::json {

// Counted from 1. A column is one code point of UTF-8, a tab included.
struct Place {
    uint32_t line = 1;
    uint32_t column = 1;
};

struct Value;
struct Member;
using Array = std::vector<Value>;

// In the order of the file; no two keys are equal.
class Object : public std::vector<Member> {
  public:
    // The member with that key, or null.
    const Member* find(std::string_view key) const;
    // Makes find() fast for many members; call it when all have been added.
    void sort_keys();

  private:
    std::vector<uint32_t> by_key_;  // The members' indices; empty if they are few.
};

struct Value {
    Place place;  // Place of the first character.
    std::variant<std::nullptr_t, bool, double, std::string, Array, Object> data;
};

struct Member {
    std::string key;
    Place place;  // Place of the key.
    Value value;
};

// A value of a file, and how messages tell where the file's values are.
struct Document {
    enum class Places { lines, pointers };

    std::string file;  // Its name in messages.
    Value root;
    Places places = Places::lines;
    bool nulls_are_absent = false;  // Whether a member that is null is treated as absent.
};

// Where a value of the document is, as messages begin: `file:line:column`, or `file#/key/0` with its JSON
// pointer (RFC 6901).
std::string place_of(const Document& document, const Value& value);

// Parses `text`; `file` is its name in messages. Throws Error `file:line:column: cause` for text that is not
// one JSON value in UTF-8, a duplicate key, a number that a double cannot hold, or nesting deeper than 256.
Value parse(std::string_view text, const std::string& file);

// Throws Error with the message `file:line:column: message`.
[[noreturn]] void fail(const std::string& file, Place place, const std::string& message);

// A value as compact JSON.
std::string to_text(const Value& value);

// A short description of a value, for messages: scalars and short arrays of numbers as they are, otherwise
// `an array of 7` or `an object`.
std::string describe(const Value& value);

}  // namespace candela::json
