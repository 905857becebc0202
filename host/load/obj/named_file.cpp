// See named_file.h.
#include "load/obj/named_file.h"

#include <algorithm>

#include "load/text_lines.h"

namespace candela {
namespace {

std::optional<std::filesystem::path> existing(const std::filesystem::path& path) {
    std::error_code ignored;
    const auto type = std::filesystem::status(path, ignored).type();
    using std::filesystem::file_type;
    const bool there =
        type != file_type::not_found && type != file_type::none && type != file_type::directory;
    return there ? std::optional(path) : std::nullopt;
}

}  // namespace

std::optional<std::filesystem::path> find_named_file(const std::filesystem::path& folder, std::string name) {
    if (auto exact = existing(folder / name)) return exact;
    name = trimmed(std::string_view(name).substr(0, name.find(" #")));
    if (name.size() > 1 && name.starts_with('"') && name.ends_with('"'))
        name = name.substr(1, name.size() - 2);
    std::ranges::replace(name, '\\', '/');
    if (name.empty()) return std::nullopt;
    if (auto path = existing(folder / name)) return path;
    const std::string alone = name.substr(name.rfind('/') + 1);
    return alone.empty() ? std::nullopt : existing(folder / alone);
}

}  // namespace candela
