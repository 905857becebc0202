// See named_file.h.
#include "load/obj/named_file.h"

#include <algorithm>
#include <string_view>
#include <system_error>

#include "load/text_lines.h"

namespace candela {
namespace {

bool exists(const std::filesystem::path& path, const FileReach& reach) {
    if (!reach.holds(path)) return false;
    std::error_code ignored;
    const auto type = std::filesystem::status(path, ignored).type();
    using std::filesystem::file_type;
    return type != file_type::not_found && type != file_type::none && type != file_type::directory;
}

}  // namespace

NamedFile find_named_file(const std::filesystem::path& folder, std::string name, const FileReach& reach) {
    const std::filesystem::path exact = folder / name;
    if (exists(exact, reach)) return {exact, true};
    name = trimmed(std::string_view(name).substr(0, name.find(" #")));
    if (name.size() > 1 && name.starts_with('"') && name.ends_with('"'))
        name = name.substr(1, name.size() - 2);
    std::ranges::replace(name, '\\', '/');
    if (name.empty()) return {exact, false};
    const std::filesystem::path path = folder / name;
    if (exists(path, reach)) return {path, true};
    const std::filesystem::path alone = folder / name.substr(name.rfind('/') + 1);
    if (exists(alone, reach)) return {alone, true};
    return {path, false};
}

}  // namespace candela
