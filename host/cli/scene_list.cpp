// See scene_list.h.
#include "cli/scene_list.h"

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "base/file.h"

namespace candela {
namespace {

void add_lines(std::istream& list, std::vector<std::string>& scenes) {
    constexpr const char* SPACE = " \t\r\v\f";
    for (std::string line; std::getline(list, line);) {
        const size_t begin = line.find_first_not_of(SPACE);
        if (begin == std::string::npos || line[begin] == '#') continue;
        scenes.push_back(line.substr(begin, line.find_last_not_of(SPACE) + 1 - begin));
    }
}

}  // namespace

SceneList list_scenes(const std::vector<std::string>& arguments, std::istream& standard_input) {
    if (std::ranges::count(arguments, "-") > 1)
        throw Error("SCENE: - is the list on standard input; give it once", ErrorKind::request);
    SceneList list;
    for (const std::string& argument : arguments) {
        if (argument == "-") {
            add_lines(standard_input, list.scenes);
        } else if (argument.starts_with('@')) {
            list.lists.push_back(argument.substr(1));
            std::istringstream lines(read_file(list.lists.back()));
            add_lines(lines, list.scenes);
        } else {
            list.scenes.push_back(argument);
            continue;
        }
        list.is_list = true;
    }
    if (list.scenes.empty()) {
        throw Error("SCENE: the list names no scene; write the path of a scene on each line",
                    ErrorKind::request);
    }
    return list;
}

}  // namespace candela
