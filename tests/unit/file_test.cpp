// Files: read whole, written whole or not at all, with errors that say what to do; and the hash of bytes.
#include "base/file.h"

#include <csignal>
#include <fstream>
#include <span>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/hash.h"
#include "base_fixture.h"

namespace candela {
namespace {

namespace fs = std::filesystem;

// Lets no file grow beyond `bytes` while it lives, as if the disk were full.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &old_limit_);
        const rlimit limit{bytes, old_limit_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &old_limit_);
        std::signal(SIGXFSZ, old_handler_);
    }

  private:
    void (*old_handler_)(int);
    rlimit old_limit_{};
};

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

// Makes `directory` the current one while it lives.
class CurrentDirectory {
  public:
    explicit CurrentDirectory(const fs::path& directory) : old_(fs::current_path()) {
        fs::current_path(directory);
    }
    CurrentDirectory(const CurrentDirectory&) = delete;
    CurrentDirectory& operator=(const CurrentDirectory&) = delete;
    ~CurrentDirectory() { fs::current_path(old_); }

  private:
    fs::path old_;
};

std::string all_bytes() {
    std::string bytes;
    for (int i = 0; i < 300'000; ++i)
        bytes += char(i * 7 % 256);
    return bytes;
}

TEST(File, ReadsBackEveryByteThatItWrote) {
    const TemporaryDirectory directory;
    for (const std::string& bytes : {std::string(), std::string("text\r\n"), all_bytes()}) {
        write_file_atomically(directory / "file", bytes);
        EXPECT_EQ(read_file(directory / "file"), bytes);
        EXPECT_EQ(directory.size(), 1);
    }
}

TEST(File, ReadsAPipe) {
    const TemporaryDirectory directory;
    const std::string pipe = (directory / "pipe").string();
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::thread writer([&] { std::ofstream(pipe) << "scene"; });
    EXPECT_EQ(read_file(pipe), "scene");
    writer.join();
}

TEST(File, SaysWhyAFileCannotBeRead) {
    const TemporaryDirectory directory;
    const fs::path missing = directory / "box.json";
    EXPECT_EQ(error_of([&] { read_file(missing); }),
              "cannot read \"" + missing.string() + "\": the file does not exist; check the name");
    EXPECT_EQ(error_of([&] { read_file(directory.path()); }),
              "cannot read \"" + directory.path().string() +
                  "\": it is a directory; give the name of a file in it");
    EXPECT_EQ(error_of([] { read_file("/dev/zero"); }),
              "cannot read \"/dev/zero\": it is neither a regular file nor a pipe; give the name of a file");
    const std::string long_name(1000, 'x');
    EXPECT_EQ(error_of([&] { read_file(long_name); }),
              "cannot read \"" + long_name + "\": File name too long; check the name and the permissions");
    // A file that opens but whose first page is mapped nowhere.
    EXPECT_EQ(error_of([] { read_file("/proc/self/mem"); }),
              "cannot read \"/proc/self/mem\": Input/output error; check the file and its disk");
}

TEST(File, SaysThatPermissionIsMissingToRead) {
    const Unprivileged unprivileged;
    const TemporaryDirectory directory;
    const fs::path secret = directory / "secret";
    write_file_atomically(secret, "x");
    fs::permissions(secret, fs::perms::none);
    EXPECT_EQ(error_of([&] { read_file(secret); }),
              "cannot read \"" + secret.string() + "\": Permission denied; check the permissions");
}

TEST(File, FindsAnUnwritablePlaceBeforehandAndWhenWriting) {
    const TemporaryDirectory directory;
    write_file_atomically(directory / "file", "");
    fs::create_symlink("loop", directory / "loop");
    const std::string base = directory.path().string();
    const std::vector<std::pair<std::string, std::string>> cases = {
        {base + "/none/out.exr", "the directory \"" + base + "/none\" does not exist; create it first"},
        {base + "/file/out.exr", "the directory \"" + base + "/file\" does not exist; create it first"},
        {base, "it is a directory; give the name of a file in it"},
        {base + "/", "it names no file; give a file name"},
        {"", "it names no file; give a file name"},
        {base + "/loop", "Too many levels of symbolic links; choose another place"},
        {base + "/" + std::string(300, 'x'), "File name too long; choose another place"},
        {"/dev/null", "it is not a regular file; choose another name"},
    };
    for (const auto& one : cases) {
        const std::string path = one.first;
        const std::string expected = "cannot write \"" + path + "\": " + one.second;
        EXPECT_EQ(error_of([&] { check_writable(path); }), expected);
        EXPECT_EQ(error_of([&] { write_file_atomically(path, "x"); }), expected);
    }
    EXPECT_EQ(directory.size(), 2);
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
    EXPECT_EQ(error_of([&] { check_writable(file); }),
              "cannot write \"" + file.string() +
                  "\": the file exists and is write-protected (Permission denied); choose another name");
    fs::permissions(directory.path(), fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_EQ(error_of([&] { check_writable(directory / "new"); }),
              "cannot write \"" + (directory / "new").string() +
                  "\": no file can be created in the directory \"" + directory.path().string() +
                  "\" (Permission denied); choose a place that you may write to");
    fs::permissions(directory.path(), fs::perms::owner_all);
}

TEST(File, CheckingLeavesNothingBehindAndChangesNothing) {
    const TemporaryDirectory directory;
    check_writable(directory / "new.exr");
    EXPECT_EQ(directory.size(), 0);
    write_file_atomically(directory / "old.exr", "old");
    check_writable(directory / "old.exr");
    EXPECT_EQ(read_file(directory / "old.exr"), "old");
    EXPECT_EQ(directory.size(), 1);
}

TEST(File, KeepsTheOldFileAndNoTemporaryOneWhenTheDiskIsFull) {
    const TemporaryDirectory directory;
    const fs::path file = directory / "out.exr";
    write_file_atomically(file, "old");
    std::string message;
    {
        const FileSizeLimit limit(1000);
        message = error_of([&] { write_file_atomically(file, std::string(5000, 'x')); });
    }
    EXPECT_EQ(message, "cannot write \"" + file.string() +
                           "\": File too large; free some space or choose another place");
    EXPECT_EQ(read_file(file), "old");
    EXPECT_EQ(directory.size(), 1);
}

TEST(File, LeavesTheTemporaryFilesOfOthersAlone) {
    const TemporaryDirectory directory;
    for (int i = 0; i < 1000; ++i) {
        std::ofstream(directory /
                      (".candela-" + std::to_string(::getpid()) + '-' + std::to_string(i) + ".tmp"));
    }
    write_file_atomically(directory / "out.exr", "image");
    EXPECT_EQ(read_file(directory / "out.exr"), "image");
    EXPECT_EQ(directory.size(), 1001);
}

TEST(File, WritesThroughSymbolicLinks) {
    const TemporaryDirectory directory;
    fs::create_directory(directory / "sub");
    fs::create_symlink("sub/target", directory / "relative");
    fs::create_symlink(directory / "relative", directory / "absolute");
    for (const char* bytes : {"the target is new", "the target exists"}) {
        check_writable(directory / "absolute");
        write_file_atomically(directory / "absolute", bytes);
        EXPECT_TRUE(fs::is_symlink(directory / "absolute"));
        EXPECT_TRUE(fs::is_symlink(directory / "relative"));
        EXPECT_EQ(read_file(directory / "sub/target"), bytes);
        EXPECT_EQ(directory.size(), 3);
    }
}

TEST(File, WritesToTheCurrentDirectoryByBareName) {
    const TemporaryDirectory directory;
    const CurrentDirectory current(directory.path());
    check_writable("out.exr");
    write_file_atomically("out.exr", "image");
    EXPECT_EQ(read_file("out.exr"), "image");
    EXPECT_EQ(directory.size(), 1);
}

TEST(File, GivesNewFilesTheUsualPermissions) {
    const TemporaryDirectory directory;
    std::ofstream(directory / "usual") << "x";
    write_file_atomically(directory / "ours", "x");
    EXPECT_EQ(fs::status(directory / "ours").permissions(), fs::status(directory / "usual").permissions());
}

// Ref: test vectors of the authors, http://www.isthe.com/chongo/src/fnv/test_fnv.c
TEST(Hash, AgreesWithThePublishedVectors) {
    const auto hash = [](std::string_view text) { return fnv1a64(std::as_bytes(std::span(text))); };
    EXPECT_EQ(hash(""), 0xcbf29ce484222325u);
    EXPECT_EQ(hash("a"), 0xaf63dc4c8601ec8cu);
    EXPECT_EQ(hash("b"), 0xaf63df4c8601f1a5u);
    EXPECT_EQ(hash("foobar"), 0x85944171f73967e8u);
    EXPECT_EQ(hash("chongo was here!\n"), 0x46810940eff5f915u);
}

TEST(Hash, ContinuesFromThePartBefore) {
    const std::string_view text = "foobar";
    const auto bytes = std::as_bytes(std::span(text));
    EXPECT_EQ(fnv1a64(bytes.subspan(3), fnv1a64(bytes.first(3))), fnv1a64(bytes));
}

}  // namespace
}  // namespace candela
