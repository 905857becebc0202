// Looks up files and names.
#include "load/obj/obj_materials.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <unordered_set>

#include "base/error.h"
#include "load/quote.h"
#include "load/text_lines.h"

namespace candela {
namespace {

constexpr const char* REMEDY = "give the shape a \"material\" in the scene";

[[noreturn]] void fail(const std::filesystem::path& obj, uint64_t line, const std::string& cause) {
    throw Error(obj.string() + ':' + std::to_string(line) + ": " + cause);
}

// The files that one `mtllib` stands for: its name as a whole, or word by word.
std::vector<std::filesystem::path> find_libraries(const std::filesystem::path& obj, const ObjName& name,
                                                  const FileReach& reach) {
    const auto is_there = [&](const std::filesystem::path& path) {
        std::error_code ignored;
        return reach.holds(path) && std::filesystem::exists(path, ignored);
    };
    const std::filesystem::path folder = obj.parent_path();
    const std::filesystem::path whole = folder / name.name;
    if (is_there(whole)) return {whole};
    std::vector<std::filesystem::path> paths;
    std::string_view rest = name.name;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest))
        paths.push_back(folder / word);
    if (std::none_of(paths.begin(), paths.end(), is_there)) paths = {whole};
    const auto missing = std::find_if_not(paths.begin(), paths.end(), is_there);
    if (missing == paths.end()) return paths;
    if (!reach.holds(*missing)) fail(obj, name.line, reach.refusal(name.name));
    fail(obj, name.line,
         "the material library " + quote(missing->string()) + " does not exist; put it there, or " + REMEDY);
}

}  // namespace

MtlLibrary load_mtl_libraries(const std::filesystem::path& obj, const std::vector<ObjName>& names,
                              const FileReach& reach) {
    MtlLibrary all;
    const HiddenValues hidden(reach);
    std::unordered_set<std::string> known_names, known_files;
    for (const ObjName& name : names) {
        if (!known_names.insert(name.name).second) continue;
        for (const std::filesystem::path& path : find_libraries(obj, name, reach)) {
            if (known_files.insert(path.string()).second) all.files.push_back(path);
        }
    }
    for (const std::filesystem::path& path : all.files) {
        MtlLibrary library = load_mtl(path, reach);
        all.materials.merge(library.materials);  // Keeps those that are already there.
        std::move(library.warnings.begin(), library.warnings.end(), std::back_inserter(all.warnings));
    }
    return all;
}

const MtlMaterial& find_mtl_material(const MtlLibrary& library, const std::filesystem::path& obj,
                                     const ObjName& name) {
    const auto found = library.materials.find(name.name);
    if (found != library.materials.end()) return found->second;
    const std::string unknown = "unknown material " + quote(name.name);
    if (library.materials.empty()) {
        fail(obj, name.line,
             unknown + ": the file names no library (\"mtllib pot.mtl\"); add one, or " + REMEDY);
    }
    std::vector<std::string> defined;
    for (const auto& [known, material] : library.materials)
        defined.push_back(known);
    fail(obj, name.line, unknown + " (defined: " + joined(defined) + "); correct it, or " + REMEDY);
}

}  // namespace candela
