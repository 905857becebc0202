// The scenes that a command line and its lists name.
#include "cli/scene_list.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "unit/base/base_fixture.h"

namespace candela {
namespace {

using Paths = std::vector<std::string>;

Paths scenes_of(const Paths& arguments, const std::string& input = "") {
    std::istringstream stream(input);
    return list_scenes(arguments, stream).scenes;
}

TEST(SceneList, JoinsFilesAndLists) {
    const TemporaryDirectory directory;
    const std::string list = (directory.path() / "list.txt").string();
    std::ofstream(list) << "# models\n b/c.glb \r\n\n\t#d.glb\ne #f.glb\n@g.glb";
    EXPECT_EQ(scenes_of({"a.glb"}), Paths{"a.glb"});
    EXPECT_EQ(scenes_of({"z.json", '@' + list, "-", "y.obj"}, "h.ply\n"),
              (Paths{"z.json", "b/c.glb", "e #f.glb", "@g.glb", "h.ply", "y.obj"}));
    std::istringstream none;
    EXPECT_EQ(list_scenes({'@' + list}, none).lists, Paths{list});
    EXPECT_TRUE(list_scenes({'@' + list}, none).is_list);
    EXPECT_FALSE(list_scenes({"a.glb"}, none).is_list);
}

TEST(SceneList, RefusesWhatNamesNoScene) {
    EXPECT_EQ(error_of([] { scenes_of({"-"}, "# none\n\n"); }),
              "SCENE: the list names no scene; write the path of a scene on each line");
    EXPECT_EQ(error_of([] {
                  scenes_of({"-", "-"}, "a.glb");
              }),
              "SCENE: - is the list on standard input; give it once");
    EXPECT_EQ(error_of([] { scenes_of({"@none.txt"}); }),
              "cannot read \"none.txt\": the file does not exist; check the name");
}

}  // namespace
}  // namespace candela
