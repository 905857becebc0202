// Error messages, and the conversions that may lead to them.
#include "load/node.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "load/quote.h"

namespace candela {
namespace {

// The least number of characters to insert, delete or replace that turns `a` into `b`.
// Ref: Wagner, Fischer, "The String-to-String Correction Problem" (1974).
size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t(0));
    for (size_t i = 0; i < a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < b.size(); ++j) {
            const size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
        }
    }
    return row[b.size()];
}

// The name that was probably meant, or null if none is close.
const std::string* nearest(std::string_view name, std::span<const std::string> known) {
    const std::string* best = nullptr;
    if (name.size() > MAX_NAME_BYTES) return nullptr;  // Not a name that anybody typed.
    size_t min = std::min<size_t>(3, name.size());     // At most two slips, and not the whole name.
    for (const std::string& candidate : known) {
        const size_t longer = std::max(candidate.size(), name.size());
        if (longer - std::min(candidate.size(), name.size()) >= min) continue;
        const size_t distance = edit_distance(name, candidate);
        if (distance < min) {
            min = distance;
            best = &candidate;
        }
    }
    return best;
}

}  // namespace

std::string Node::place() const {
    return json::place_of(*document_, *value_);
}

void Node::fail(const std::string& message) const {
    throw Error(place() + ": " + message);
}

void Node::fail_expected(const std::string& what) const {
    const std::string subject = key_.empty() ? std::string("the scene") : quote(key_);
    fail(subject + ": expected " + what + ", found " + shown(json::describe(*value_)));
}

void Node::fail_unknown(const std::string& what, std::string_view name, std::span<const std::string> known,
                        const std::string& word) const {
    std::string message = "unknown " + what + ' ' + quote(name) + " (";
    if (const std::string* guess = nearest(name, known)) message += "did you mean " + quote(*guess) + "? ";
    fail(message + word + ": " + (known.empty() ? "none" : joined(known)) + ')');
}

const json::Object& Node::object() const {
    const auto* object = std::get_if<json::Object>(&value_->data);
    if (object == nullptr) fail_expected("an object { ... }");
    return *object;
}

void Node::allow_only(std::initializer_list<std::string_view> keys,
                      std::span<const std::string_view> more_keys) const {
    std::vector<std::string> known(keys.begin(), keys.end());
    known.insert(known.end(), more_keys.begin(), more_keys.end());
    for (const json::Member& member : object()) {
        if (std::find(known.begin(), known.end(), member.key) != known.end()) continue;
        const json::Value at_key{member.place, nullptr};
        child(member.key, at_key).fail_unknown("key", member.key, known);
    }
}

std::optional<Node> Node::find(std::string_view key) const {
    const json::Member* member = object().find(key);
    if (member == nullptr) return std::nullopt;
    const Node node = child(member->key, member->value);
    if (node.is_null() && document_->nulls_are_absent) return std::nullopt;
    return node;
}

Node Node::require(std::string_view key) const {
    if (const std::optional<Node> node = find(key)) return *node;
    fail("the key " + quote(key) + " is missing here; add it");
}

std::vector<Node> Node::members() const {
    std::vector<Node> nodes;
    nodes.reserve(object().size());
    for (const json::Member& member : object())
        nodes.push_back(child(member.key, member.value));
    return nodes;
}

const json::Array& Node::array() const {
    const auto* array = std::get_if<json::Array>(&value_->data);
    if (array == nullptr) fail_expected("an array [ ... ]");
    return *array;
}

std::vector<Node> Node::elements() const {
    std::vector<Node> nodes;
    nodes.reserve(array().size());
    for (const json::Value& element : array())
        nodes.push_back(child(key_, element));
    return nodes;
}

size_t Node::size() const {
    return array().size();
}

Node Node::operator[](size_t i) const {
    return child(key_, array()[i]);
}

bool Node::boolean() const {
    const bool* value = std::get_if<bool>(&value_->data);
    if (value == nullptr) fail_expected("true or false");
    return *value;
}

const std::string& Node::string() const {
    const auto* value = std::get_if<std::string>(&value_->data);
    if (value == nullptr) fail_expected("a string");
    return *value;
}

const std::string& Node::file_name() const {
    if (string().find('\0') != std::string::npos)
        fail("a file name cannot hold the character U+0000; remove it");
    return string();
}

double Node::number() const {
    const double* value = std::get_if<double>(&value_->data);
    if (value == nullptr) fail_expected("a number");
    // Some programs write the greatest float in so few digits that the number exceeds it.
    constexpr double ROUNDED_TO_INFINITY = 0x1.ffffffp127;
    if (std::abs(*value) >= ROUNDED_TO_INFINITY) fail_expected("a number of at most 3.4e38 in size");
    return std::clamp(*value, -double(FLOAT_MAX), double(FLOAT_MAX));
}

float Node::number(float lo, float hi) const {
    const auto value = float(number());
    if (value < lo || value > hi) {
        constexpr int DIGITS = 6;  // As many as every float has.
        fail_expected("a number from " + number_text(lo, DIGITS) + " to " + number_text(hi, DIGITS));
    }
    return value;
}

double Node::non_negative() const {
    const double value = number();
    if (value < 0.0) fail_expected("a number of at least 0");
    return value;
}

double Node::positive() const {
    const double value = number();
    if (value <= 0.0) fail_expected("a number above 0");
    if (value < FLOAT_MIN) fail_expected("a number of at least 1.2e-38");
    return value;
}

double Node::angle() const {
    return glm::radians(std::remainder(number(), 360.0));
}

uint32_t Node::integer(uint32_t lo, uint32_t hi) const {
    const double* value = std::get_if<double>(&value_->data);
    if (value == nullptr || *value < lo || *value > hi || *value != std::floor(*value)) {
        fail_expected("a whole number from " + std::to_string(lo) + " to " + std::to_string(hi));
    }
    return uint32_t(*value);
}

std::vector<double> Node::numbers(size_t count) const {
    constexpr std::array<const char*, 5> WORDS{"no", "one", "two", "three", "four"};
    const auto* array = std::get_if<json::Array>(&value_->data);
    if (array == nullptr || array->size() != count)
        fail_expected((count < WORDS.size() ? WORDS[count] : std::to_string(count)) +
                      std::string(" numbers"));
    std::vector<double> values;
    values.reserve(count);
    for (const json::Value& element : *array)
        values.push_back(child(key_, element).number());
    return values;
}

glm::dvec3 Node::vector() const {
    const std::vector<double> v = numbers(3);
    return {v[0], v[1], v[2]};
}

glm::dvec3 Node::rgb() const {
    if (!is_number() && !is_array()) fail_expected("one grey number or three [r, g, b]");
    const glm::dvec3 value = is_number() ? glm::dvec3(number()) : vector();
    if (glm::any(glm::lessThan(value, glm::dvec3(0)))) fail_expected("numbers of at least 0");
    return value;
}

glm::dvec3 Node::reflectance() const {
    const glm::dvec3 value = rgb();
    if (glm::any(glm::greaterThan(value, glm::dvec3(1)))) fail_expected("numbers from 0 to 1");
    return value;
}

}  // namespace candela
