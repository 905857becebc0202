// The scenes of a command: the files that it names itself, and those that lists name.
#pragma once

#include <istream>
#include <string>
#include <vector>

namespace candela {

struct SceneList {
    std::vector<std::string> scenes;  // In the order of the command line.
    std::vector<std::string> lists;   // The files of the lists.
    bool is_list = false;             // Whether a list has been named, however many scenes it has.
};

// The scenes that arguments name: each is a file, @FILE for the files that this one lists, or - for a list on
// `standard_input`. A list has a path on each line, as it would be on the command line: relative to the
// current folder. Space around it is left out, and so are empty lines and those that begin with #. Throws
// Error if a list cannot be read, and Error (usage) if there is no scene at all or standard input is named
// twice.
SceneList list_scenes(const std::vector<std::string>& arguments, std::istream& standard_input);

}  // namespace candela
