// Files for one user alone: nothing is read that another user may have written, and no link is followed.
#include "base/private_file.h"

#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

constexpr size_t MAX = 1000;
constexpr uid_t NOBODY = 65534;

class PrivateFile : public testing::Test {
  protected:
    void write(const std::string& bytes = "new") const { write_private_file(folder_, "file", bytes); }
    std::optional<std::string> read() const { return read_private_file(folder_, "file", MAX); }
    // Neither reads the file nor changes it, which anybody would have done with an ordinary one.
    void expect_unused() const {
        const std::string before = read_file(file_);
        EXPECT_EQ(read(), std::nullopt);
        write();
        EXPECT_EQ(read_file(file_), before);
    }

    const TemporaryDirectory directory_;
    const fs::path folder_ = directory_ / "above/folder";
    const fs::path file_ = folder_ / "file";
};

TEST_F(PrivateFile, IsReadAsItWasWritten) {
    EXPECT_EQ(read(), std::nullopt);
    for (const std::string& bytes : {std::string("old"), std::string(), std::string(MAX, 'x')}) {
        write(bytes);
        EXPECT_EQ(read(), bytes);
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(PrivateFile, AndItsFoldersAreForThisUserAlone) {
    write();
    EXPECT_EQ(fs::status(directory_ / "above").permissions(), fs::perms(0700));
    EXPECT_EQ(fs::status(folder_).permissions(), fs::perms(0700));
    EXPECT_EQ(fs::status(file_).permissions(), fs::perms(0600));
}

TEST_F(PrivateFile, InAFolderWhereOthersMayWriteIsNotUsed) {
    write("old");
    for (const mode_t mode : {0770, 0702, 0777, 01777}) {
        ASSERT_EQ(::chmod(folder_.c_str(), mode), 0);
        expect_unused();
    }
    ASSERT_EQ(::chmod(folder_.c_str(), 0755), 0);
    EXPECT_EQ(read(), "old");
}

TEST_F(PrivateFile, ThatOthersMayWriteToIsReplacedUnread) {
    for (const mode_t mode : {0660, 0602}) {
        write("old");
        ASSERT_EQ(::chmod(file_.c_str(), mode), 0);
        EXPECT_EQ(read(), std::nullopt);
        write();
        EXPECT_EQ(read(), "new");
    }
}

TEST_F(PrivateFile, OfAnotherUserIsNotUsed) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can make what belongs to somebody else";
    write("old");
    ASSERT_EQ(::chown(folder_.c_str(), NOBODY, NOBODY), 0);
    expect_unused();
    ASSERT_EQ(::chown(folder_.c_str(), 0, 0), 0);
    EXPECT_EQ(read(), "old");
    ASSERT_EQ(::chown(file_.c_str(), NOBODY, NOBODY), 0);
    EXPECT_EQ(read(), std::nullopt);
}

TEST_F(PrivateFile, IsNoLinkAndNotBelowOne) {
    write("old");
    fs::rename(file_, folder_ / "target");
    fs::create_symlink("target", file_);
    expect_unused();
    EXPECT_TRUE(fs::is_symlink(file_));
    fs::rename(folder_ / "target", file_);
    EXPECT_EQ(read(), "old");
    fs::rename(folder_, directory_ / "target");
    fs::create_symlink(directory_ / "target", folder_);
    expect_unused();
}

TEST_F(PrivateFile, OfManyBytesIsNotRead) {
    write("old");
    fs::resize_file(file_, MAX + 1);
    EXPECT_EQ(read(), std::nullopt);
    fs::resize_file(file_, uintmax_t{1} << 40);  // It uses no space on the disk.
    EXPECT_EQ(read(), std::nullopt);
    write();
    EXPECT_EQ(read(), "new");
}

TEST_F(PrivateFile, IsARegularOneOrNothing) {
    write();
    const auto expect_left = [&](fs::file_type type) {
        EXPECT_EQ(read(), std::nullopt);
        write();
        EXPECT_EQ(fs::symlink_status(file_).type(), type);
        fs::remove(file_);
    };
    fs::remove(file_);
    ASSERT_EQ(::mkfifo(file_.c_str(), 0600), 0);
    expect_left(fs::file_type::fifo);
    fs::create_directory(file_);
    expect_left(fs::file_type::directory);
    std::ofstream(directory_ / "regular") << "x";
    write_private_file(directory_ / "regular", "file", "new");
    write_private_file(directory_ / "regular/below", "file", "new");
    EXPECT_EQ(directory_.size(), 2);
}

}  // namespace
}  // namespace candela
