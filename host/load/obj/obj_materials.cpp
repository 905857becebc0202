// Looks up files and names.
#include "load/obj/obj_materials.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <unordered_set>

#include "base/text.h"
#include "load/obj/counted_warnings.h"
#include "load/obj/named_file.h"
#include "load/quote.h"
#include "load/text_lines.h"

namespace candela {
namespace {

using Paths = std::vector<std::filesystem::path>;

// A missing library: its name, and where it would be.
struct Lost {
    std::string name;
    std::filesystem::path path;
};

// Cuts the next name off `text`: a word, or the text in quotation marks.
std::string_view next_name(std::string_view& text) {
    text = trimmed(text);
    const size_t end = text.starts_with('"') ? text.find('"', 1) : std::string_view::npos;
    if (end == std::string_view::npos) return next_word(text);
    const std::string_view name = text.substr(1, end - 1);
    text.remove_prefix(end + 1);
    return name;
}

// Adds the files of one `mtllib`, whose text is one name or several. Returns the first file that is missing.
std::optional<Lost> find_libraries(const std::filesystem::path& folder, const std::string& names,
                                   const FileReach& reach, Paths& paths) {
    const NamedFile whole = find_named_file(folder, names, reach);
    if (whole.is_there) {
        paths.push_back(whole.path);
        return std::nullopt;
    }
    Paths found;
    std::optional<Lost> lost;
    std::string_view rest = names;
    for (std::string_view name = next_name(rest); !name.empty(); name = next_name(rest)) {
        const NamedFile named = find_named_file(folder, std::string(name), reach);
        if (named.is_there) {
            found.push_back(named.path);
        } else if (!lost) {
            lost = {std::string(name), named.path};
        }
    }
    if (found.empty()) return Lost{names, whole.path};
    std::ranges::move(found, std::back_inserter(paths));
    return lost;
}

}  // namespace

ObjLibraries load_mtl_libraries(const std::filesystem::path& obj, const std::vector<ObjName>& names,
                                const FileReach& reach) {
    ObjLibraries all;
    Paths paths;
    CountedWarnings warnings;
    std::unordered_set<std::string> known_names, known_files;
    for (const ObjName& name : names) {
        if (name.name.empty() || !known_names.insert(name.name).second) continue;
        const auto lost = find_libraries(obj.parent_path(), name.name, reach, paths);
        if (!lost) continue;
        all.all_there = false;
        const bool is_outside = !reach.holds(lost->path);
        const std::string what = is_outside ? reach.refusal(lost->name)
                                            : "the material library " + quote(lost->name) + " does not exist";
        warnings.add(is_outside ? "outside" : "missing",
                     concat(obj.string(), ':', name.line, ": ", what, "; its materials are shown in grey"));
    }
    all.materials.warnings = warnings.texts();
    const HiddenValues hidden(reach);
    for (const std::filesystem::path& path : paths) {
        if (!known_files.insert(path.string()).second) continue;
        all.materials.files.push_back(path);
        MtlLibrary library = load_mtl(path, reach);
        all.materials.materials.merge(library.materials);  // Keeps materials that are already there.
        std::ranges::move(library.warnings, std::back_inserter(all.materials.warnings));
    }
    return all;
}

std::string materials_of(const MtlLibrary& library) {
    if (library.files.empty()) return ": the file names no library (\"mtllib pot.mtl\"); shown in grey";
    std::vector<std::string> defined;
    for (const auto& [known, material] : library.materials)
        defined.push_back(known);
    return " (defined: " + joined(defined) + "); shown in grey";
}

}  // namespace candela
