// What is finished gets lost neither if its place has become another thing nor if that is gone.
#include <cstdlib>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/file.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

// The working folder is `working`, and that of temporary files `temporary`, while a test runs.
class FinishedWork : public testing::Test {
  protected:
    FinishedWork() {
        for (const char* folder : {"place", "working", "temporary"})
            fs::create_directory(directory_ / folder);
        fs::current_path(directory_ / "working");
        ::setenv("TMPDIR", (directory_ / "temporary").c_str(), 1);
    }
    ~FinishedWork() override {
        fs::current_path(old_folder_);
        if (old_temporary_.empty()) {
            ::unsetenv("TMPDIR");
        } else {
            ::setenv("TMPDIR", old_temporary_.c_str(), 1);
        }
    }

    // Writes "work", which cannot be done for this reason; returns where the message says it is.
    static fs::path kept(const fs::path& path, const std::string& reason) {
        const std::string message = error_of([&] { write_finished_work(path, "work"); });
        const std::string start =
            "cannot write \"" + path.string() + "\": " + reason + "; the data is saved in \"";
        EXPECT_TRUE(message.starts_with(start)) << message;
        if (!message.starts_with(start)) return {};
        const fs::path place = message.substr(start.size(), message.size() - start.size() - 1);
        EXPECT_EQ(read_file(place), "work");
        return place;
    }
    std::string gone(const fs::path& folder) const {
        return "the directory \"" + folder.string() + "\" does not exist; create it first";
    }

    const TemporaryDirectory directory_;
    const fs::path place_ = directory_ / "place/a.exr";

  private:
    static std::string variable(const char* name) {
        const char* const value = std::getenv(name);
        return value == nullptr ? "" : value;
    }
    const fs::path old_folder_ = fs::current_path();
    const std::string old_temporary_ = variable("TMPDIR");
};

TEST_F(FinishedWork, IsWrittenWhereItBelongs) {
    write_finished_work(place_, "work");
    EXPECT_EQ(read_file(place_), "work");
    EXPECT_EQ(std::distance(fs::directory_iterator(directory_ / "place"), {}), 1);
}

TEST_F(FinishedWork, TakesAFreeNameBesideAFolderOrAPipe) {
    fs::create_directory(place_);
    fs::permissions(place_, fs::perms(0700));
    std::ofstream(directory_ / "place/a-1.exr") << "precious";
    fs::create_symlink("nowhere", directory_ / "place/a-2.exr");
    EXPECT_EQ(kept(place_, "it is a directory; give the name of a file in it"), directory_ / "place/a-3.exr");
    EXPECT_EQ(read_file(directory_ / "place/a-1.exr"), "precious");
    EXPECT_FALSE(fs::exists(directory_ / "place/nowhere"));
    std::ofstream(directory_ / "usual") << "x";
    EXPECT_EQ(fs::status(directory_ / "place/a-3.exr").permissions(),
              fs::status(directory_ / "usual").permissions());

    fs::remove(place_);
    ASSERT_EQ(::mkfifo(place_.c_str(), 0600), 0);
    EXPECT_EQ(kept(place_, "it is not a regular file; choose another name"), directory_ / "place/a-4.exr");
}

TEST_F(FinishedWork, GoesToTheWorkingFolderIfItsOwnIsGone) {
    fs::remove(directory_ / "place");
    EXPECT_EQ(kept(place_, gone(directory_ / "place")), directory_ / "working/a-1.exr");
    EXPECT_EQ(kept(place_, gone(directory_ / "place")), directory_ / "working/a-2.exr");
}

TEST_F(FinishedWork, GoesToAPrivateTemporaryFolderIfBothAreGone) {
    fs::remove(directory_ / "place");
    fs::remove(directory_ / "working");
    const fs::path place = kept(place_, gone(directory_ / "place"));
    EXPECT_EQ(place.filename(), "a-1.exr");
    EXPECT_EQ(place.parent_path().parent_path(), directory_ / "temporary");
    EXPECT_EQ(fs::status(place.parent_path()).permissions(), fs::perms(0700));
}

TEST_F(FinishedWork, ThatNoFolderTakesIsAnErrorAlone) {
    for (const char* folder : {"place", "working", "temporary"})
        fs::remove(directory_ / folder);
    EXPECT_EQ(error_of([&] { write_finished_work(place_, "work"); }),
              "cannot write \"" + place_.string() + "\": " + gone(directory_ / "place"));
}

}  // namespace
}  // namespace candela
