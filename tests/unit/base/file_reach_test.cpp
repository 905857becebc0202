// What files may be read because another file names them: those in its folder, and only such as have an end.
#include "base/file_reach.h"

#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "unit/base/base_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

class FileReachTest : public testing::Test {
  protected:
    FileReachTest() {
        fs::create_directories(folder_ / "scene/textures");
        fs::create_directory(folder_ / "scene-2");
        fs::create_directory(folder_ / "shared");
        for (const char* file : {"scene/a", "scene/textures/b", "scene-2/c", "shared/d", "e"})
            std::ofstream(folder_ / file) << "bytes of " << file;
        fs::create_symlink("../e", folder_ / "scene/outwards");
        fs::create_symlink("textures/b", folder_ / "scene/inwards");
        fs::create_symlink("..", folder_ / "scene/up");
        fs::create_symlink("scene", folder_ / "link");
    }

    fs::path in_scene(const std::string& name) const { return folder_ / ("scene/" + name); }

    TemporaryDirectory folder_;
};

TEST_F(FileReachTest, IsTheFolderOfTheFileThatIsOpenedAndWhatIsBelow) {
    for (const char* opened : {"scene/scene.json", "link/scene.json", "scene/../scene/scene.json"}) {
        SCOPED_TRACE(opened);
        const FileReach reach(folder_ / opened);
        for (const char* name : {"a", "textures/b", "inwards", "textures/../a", "missing", "up/scene/a", "."})
            EXPECT_TRUE(reach.holds(in_scene(name))) << name;
        for (const char* name :
             {"../e", "outwards", "up/e", "../scene-2/c", "../shared/d", "../missing", ".."})
            EXPECT_FALSE(reach.holds(in_scene(name))) << name;
        EXPECT_FALSE(reach.holds("/etc/passwd"));
        EXPECT_EQ(reach.read(in_scene("inwards")), "bytes of scene/textures/b");
        EXPECT_EQ(reach.find(in_scene("textures"), "b"), in_scene("textures/b"));
    }
    EXPECT_FALSE(FileReach().holds(in_scene("a")));
    EXPECT_TRUE(FileReach("scene.json").holds("a"));  // In the working folder.
    EXPECT_FALSE(FileReach("scene.json").holds("../a"));
}

TEST_F(FileReachTest, SaysWhatIsOutsideAndHowToAllowIt) {
    const FileReach reach(in_scene("scene.json"));
    const std::string why =
        "\": with links followed, it is not in the folder of the file that is opened, \"" +
        (folder_ / "scene").string() +
        "\"; if you trust that file, allow the folder of this one (--allow-folder DIR), or "
        "all (--allow-any-folder)";
    EXPECT_EQ(error_of([&] { reach.find(folder_ / "scene", "../e"); }), "cannot read \"../e" + why);
    EXPECT_EQ(error_of([&] { reach.find(folder_ / "scene", "outwards"); }), "cannot read \"outwards" + why);
    EXPECT_EQ(error_of([&] { reach.read(in_scene("up/e")); }),
              "cannot read \"" + in_scene("up/e").string() + why);
}

TEST_F(FileReachTest, GrowsByWhatIsAllowed) {
    const FileReach more(in_scene("scene.json"), {.folders = {folder_ / "shared", folder_ / "scene-2"}});
    EXPECT_EQ(more.read(folder_ / "shared/d"), "bytes of shared/d");
    EXPECT_EQ(more.read(in_scene("../scene-2/c")), "bytes of scene-2/c");
    EXPECT_FALSE(more.holds(folder_ / "e"));
    EXPECT_EQ(FileReach(in_scene("scene.json"), {.anywhere = true}).read(in_scene("outwards")), "bytes of e");
    try {
        FileReach(in_scene("scene.json"), {.folders = {folder_ / "e"}});
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::request);
        EXPECT_EQ(error.what(), "--allow-folder: \"" + (folder_ / "e").string() +
                                    "\" is not a folder; name one that exists");
    }
}

TEST_F(FileReachTest, ReadsNoMoreThanIsAskedFor) {
    const FileReach reach(in_scene("scene.json"));
    EXPECT_EQ(reach.read(in_scene("a"), 5), "bytes");
    EXPECT_EQ(reach.read(in_scene("a"), 0), "");
    EXPECT_EQ(reach.read(in_scene("a"), 100), "bytes of scene/a");
    // A terabyte that uses no space on the disk.
    fs::resize_file(in_scene("a"), uintmax_t(1) << 40);
    EXPECT_EQ(reach.read(in_scene("a"), 5), "bytes");
}

TEST_F(FileReachTest, IsOfRegularFilesWithAnEnd) {
    const FileReach reach(in_scene("scene.json"), {.anywhere = true});
    ASSERT_EQ(::mkfifo(in_scene("pipe").c_str(), 0600), 0);
    for (const fs::path& path : {in_scene("pipe"), fs::path("/dev/zero"), fs::path("/dev/tty")}) {
        const std::string message = error_of([&] { reach.read(path); });
        EXPECT_TRUE(message.starts_with("cannot read \"" + path.string() + "\": it is ")) << message;
        EXPECT_NE(message.find("regular file"), std::string::npos) << message;
    }
    // The kernel says that they are regular and empty, and goes on writing them.
    for (const char* path : {"/proc/self/status", "/proc/self/maps"}) {
        EXPECT_EQ(error_of([&] { reach.read(path); }),
                  "cannot read \"" + std::string(path) +
                      "\": its contents do not match its size; is it a system file, or still being written?");
    }
    EXPECT_EQ(error_of([&] { reach.read(in_scene("none")); }),
              "cannot read \"" + in_scene("none").string() + "\": the file does not exist; check the name");
    EXPECT_EQ(error_of([&] { reach.read(in_scene("textures")); }),
              "cannot read \"" + in_scene("textures").string() +
                  "\": it is a directory; give the name of a file in it");
}

// What the user names may be anything that can be read, such as a pipe.
TEST_F(FileReachTest, LeavesTheFileThatIsOpenedToTheUser) {
    EXPECT_NE(FileReach("/proc/self/status").read("/proc/self/status"), "");
}

}  // namespace
}  // namespace candela
