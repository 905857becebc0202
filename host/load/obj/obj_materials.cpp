// Looks up files and names.
#include "load/obj/obj_materials.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>

#include "base/text.h"
#include "load/obj/counted_warnings.h"
#include "load/obj/named_file.h"
#include "load/quote.h"
#include "load/text_lines.h"

namespace candela {
namespace {

using Paths = std::vector<std::filesystem::path>;

// Cuts the next name off `text`: a word, or what is in quotation marks.
std::string_view next_name(std::string_view& text) {
    text = trimmed(text);
    const size_t end = text.starts_with('"') ? text.find('"', 1) : std::string_view::npos;
    if (end == std::string_view::npos) return next_word(text);
    const std::string_view name = text.substr(1, end - 1);
    text.remove_prefix(end + 1);
    return name;
}

// Adds the files that one `mtllib` stands for: its name as a whole, or one name after the other. Returns the
// first of them that does not exist.
std::optional<std::string> find_libraries(const std::filesystem::path& folder, const std::string& names,
                                          Paths& paths) {
    if (const auto whole = find_named_file(folder, names)) {
        paths.push_back(*whole);
        return std::nullopt;
    }
    Paths found;
    std::optional<std::string> missing;
    std::string_view rest = names;
    for (std::string_view name = next_name(rest); !name.empty(); name = next_name(rest)) {
        if (const auto path = find_named_file(folder, std::string(name))) {
            found.push_back(*path);
        } else if (!missing) {
            missing = name;
        }
    }
    if (found.empty()) return names;
    std::ranges::move(found, std::back_inserter(paths));
    return missing;
}

}  // namespace

ObjLibraries load_mtl_libraries(const std::filesystem::path& obj, const std::vector<ObjName>& names) {
    ObjLibraries all;
    Paths paths;
    CountedWarnings missing;
    for (const ObjName& name : names) {
        if (name.name.empty()) continue;
        const auto lost = find_libraries(obj.parent_path(), name.name, paths);
        if (!lost) continue;
        all.all_there = false;
        missing.add("missing", concat(obj.string(), ':', name.line, ": the material library ", quote(*lost),
                                      " does not exist; its materials are shown in grey"));
    }
    all.materials.warnings = missing.texts();
    for (const std::filesystem::path& path : paths) {
        if (std::ranges::find(all.materials.files, path) != all.materials.files.end()) continue;
        all.materials.files.push_back(path);
        MtlLibrary library = load_mtl(path);
        all.materials.materials.merge(library.materials);  // Keeps those that are already there.
        std::ranges::move(library.warnings, std::back_inserter(all.materials.warnings));
    }
    return all;
}

std::string unknown_material(const MtlLibrary& library, const ObjName& name) {
    const std::string unknown = "unknown material " + quote(name.name);
    if (library.files.empty())
        return unknown + ": the file names no library (\"mtllib pot.mtl\"); shown in grey";
    std::vector<std::string> defined;
    for (const auto& [known, material] : library.materials)
        defined.push_back(known);
    return unknown + " (defined: " + joined(defined) + "); shown in grey";
}

}  // namespace candela
