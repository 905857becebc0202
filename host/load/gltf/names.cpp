// See names.h.
#include "load/gltf/names.h"

#include <charconv>
#include <vector>

#include "base/error.h"
#include "load/quote.h"

namespace candela::gltf {

std::string name_of(const Node& element, const std::string& otherwise) {
    const auto name = element.find("name");
    return name && name->is_string() && !name->string().empty() ? name->string() : otherwise;
}

size_t find_by_name(const File& file, const std::optional<Node>& array, const std::string& name,
                    std::string_view what, const char* option) {
    const size_t count = array ? array->size() : 0;
    std::vector<std::string> names;
    for (size_t i = 0; i < count; ++i) {
        names.push_back(name_of((*array)[i], std::to_string(i)));
        if (names.back() == name) return i;
    }
    size_t index = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
    if (error == std::errc() && end == name.data() + name.size() && index < count) return index;
    throw Error(std::string(option) + ": " + file.path().string() + " has nothing called " + quote(name) +
                    " among its " + std::string(what) + " (" +
                    (count == 0 ? "it has none" : "known: " + joined(names)) + ')',
                ErrorKind::request);
}

}  // namespace candela::gltf
