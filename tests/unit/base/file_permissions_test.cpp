// Files that others may not read, write or replace, and the permissions of those that candela writes.
#include <cerrno>
#include <fstream>
#include <system_error>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

// What the system says of files that permissions protect.
std::string denied() {
    return std::generic_category().message(EACCES);
}

// Takes away the rights of root, who may read and write everything, while it lives.
class Unprivileged {
  public:
    Unprivileged() {
        if (was_root_ && ::setresuid(NOBODY, NOBODY, 0) != 0) ADD_FAILURE() << "cannot stop being root";
    }
    Unprivileged(const Unprivileged&) = delete;
    Unprivileged& operator=(const Unprivileged&) = delete;
    ~Unprivileged() {
        if (was_root_ && ::setresuid(0, 0, 0) != 0) ADD_FAILURE() << "cannot become root again";
    }

  private:
    static constexpr uid_t NOBODY = 65534;
    bool was_root_ = ::geteuid() == 0;
};

TEST(File, SaysThatPermissionIsMissingToRead) {
    const Unprivileged unprivileged;
    const TemporaryDirectory directory;
    const fs::path secret = directory / "secret";
    write_file_atomically(secret, "x");
    fs::permissions(secret, fs::perms::none);
    EXPECT_EQ(error_of([&] { read_file(secret); }),
              "cannot read \"" + secret.string() + "\": " + denied() + "; check the permissions");
}

TEST(File, FindsADirectoryInWhichNotEvenRootMayCreateFiles) {
    const std::string message = error_of([&] { check_writable("/proc/out.exr"); });
    EXPECT_TRUE(message.starts_with(
        "cannot write \"/proc/out.exr\": no file can be created in the directory \"/proc\" ("))
        << message;
    EXPECT_TRUE(message.ends_with("); choose a place that you may write to")) << message;
}

TEST(File, RespectsWriteProtection) {
    const Unprivileged unprivileged;
    const TemporaryDirectory directory;
    const fs::path file = directory / "file";
    write_file_atomically(file, "old");
    fs::permissions(file, fs::perms::owner_read);
    EXPECT_EQ(error_of([&] { check_writable(file); }), "cannot write \"" + file.string() +
                                                           "\": the file exists and is write-protected (" +
                                                           denied() + "); choose another name");
    fs::permissions(directory.path(), fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_EQ(error_of([&] { check_writable(directory / "new"); }),
              "cannot write \"" + (directory / "new").string() +
                  "\": no file can be created in the directory \"" + directory.path().string() + "\" (" +
                  denied() + "); choose a place that you may write to");
    fs::permissions(directory.path(), fs::perms::owner_all);
}

TEST(File, GivesNewFilesTheUsualPermissions) {
    const TemporaryDirectory directory;
    std::ofstream(directory / "usual") << "x";
    write_file_atomically(directory / "ours", "x");
    EXPECT_EQ(fs::status(directory / "ours").permissions(), fs::status(directory / "usual").permissions());
}

TEST(File, GivesAReplacedFileItsPermissions) {
    const TemporaryDirectory directory;
    const fs::path file = directory / "out.exr";
    for (const mode_t mode : {0600, 0640, 0666, 0755}) {
        std::ofstream(file) << "old";
        ASSERT_EQ(::chmod(file.c_str(), mode), 0);
        write_file_atomically(file, "new");
        EXPECT_EQ(fs::status(file).permissions(), fs::perms(mode));
    }
}

// A file of root's in a folder of root's where everybody may create files and only owners may replace theirs.
class AnothersFile : public testing::Test {
  protected:
    void SetUp() override {
        if (::geteuid() != 0) GTEST_SKIP() << "only root can make a file that belongs to somebody else";
        std::ofstream(file_) << "old";
        ASSERT_EQ(::chmod(file_.c_str(), 0666), 0);
        ASSERT_EQ(::chmod(directory_.path().c_str(), 01777), 0);
    }

    const TemporaryDirectory directory_;
    const fs::path file_ = directory_ / "out.exr";
};

TEST_F(AnothersFile, IsRefusedBeforehand) {
    const Unprivileged unprivileged;
    EXPECT_EQ(error_of([&] { check_writable(file_); }),
              "cannot write \"" + file_.string() +
                  "\": the file belongs to another user, and in the directory \"" +
                  directory_.path().string() + "\" only its owner may replace it; choose another name");
    check_writable(directory_ / "new.exr");
}

TEST_F(AnothersFile, LetsWhatIsFinishedTakeANameBesideIt) {
    const Unprivileged unprivileged;
    for (const std::string name : {"out-1.exr", "out-2.exr"}) {
        EXPECT_EQ(error_of([&] { write_finished_work(file_, name); }),
                  "cannot write \"" + file_.string() +
                      "\": no file can be put in its place (Operation not permitted); choose another place; "
                      "the data is saved in \"" +
                      (directory_ / name).string() + '"');
        EXPECT_EQ(read_file(directory_ / name), name);
    }
    EXPECT_EQ(error_of([&] { write_file_atomically(file_, "current"); }),
              "cannot write \"" + file_.string() +
                  "\": no file can be put in its place (Operation not permitted); choose another place");
    EXPECT_EQ(read_file(file_), "old");
    EXPECT_EQ(directory_.size(), 3);
}

}  // namespace
}  // namespace candela
