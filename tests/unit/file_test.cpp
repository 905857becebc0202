// Files: read whole, written whole or not at all, with errors that say what to do; and the hash of bytes.
#include "base/file.h"

#include <array>
#include <csignal>
#include <fstream>
#include <span>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/temporary_file.h"
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

TEST(File, OfACacheIsARegularOneOrNothing) {
    const TemporaryDirectory directory;
    write_file_atomically(directory / "file", "bytes");
    EXPECT_EQ(read_regular_file(directory / "file"), "bytes");
    ASSERT_EQ(::mkfifo((directory / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(read_regular_file(directory / "pipe"), std::nullopt);
    EXPECT_EQ(read_regular_file(directory.path()), std::nullopt);
    EXPECT_EQ(read_regular_file("/dev/zero"), std::nullopt);
    EXPECT_EQ(read_regular_file(directory / "missing"), std::nullopt);
}

TEST(File, PrivateFoldersAreForThisUserAlone) {
    const TemporaryDirectory directory;
    create_private_folders(directory / "a/b");
    EXPECT_EQ(fs::status(directory / "a").permissions(), fs::perms(0700));
    EXPECT_EQ(fs::status(directory / "a/b").permissions(), fs::perms(0700));
    write_file_atomically(directory / "file", "");
    create_private_folders(directory / "file/b");
    EXPECT_EQ(directory.size(), 2);
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

// Starts a process that writes a temporary file beside `target` and waits; once it is there the process is
// killed, if `killed`, or else ends when this object does.
class Writer {
  public:
    Writer(const fs::path& target, bool killed) {
        std::array<int, 2> there{};
        EXPECT_EQ(::pipe2(there.data(), O_CLOEXEC), 0);
        pid_ = ::fork();
        if (pid_ == 0) {
            TemporaryFile file(target);
            file.write("half");
            EXPECT_EQ(::write(there[1], "x", 1), 1);
            while (true)
                ::pause();
        }
        char byte = 0;
        EXPECT_EQ(::read(there[0], &byte, 1), 1);
        ::close(there[0]);
        ::close(there[1]);
        if (killed) kill();
    }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    ~Writer() { kill(); }

  private:
    void kill() {
        if (pid_ <= 0) return;
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
        pid_ = -1;
    }

    pid_t pid_ = -1;
};

TEST(File, RemovesWhatKilledProcessesLeftBehind) {
    const TemporaryDirectory directory;
    const Writer dead(directory / "out.exr", true);
    EXPECT_EQ(directory.size(), 1);
    check_writable(directory / "out.exr");
    EXPECT_EQ(directory.size(), 0);
}

TEST(File, LeavesTheTemporaryFilesOfOthersAlone) {
    const TemporaryDirectory directory;
    const Writer living(directory / "out.exr", false);
    // A file of another computer, whose processes nobody can ask for from here; and what only looks like one.
    for (const char* name : {".candela-0123456789abcdef-1-0.tmp", ".candela-.tmp", "candela.tmp"})
        std::ofstream(directory / name) << "half";
    check_writable(directory / "out.exr");
    write_file_atomically(directory / "out.exr", "image");
    EXPECT_EQ(read_file(directory / "out.exr"), "image");
    EXPECT_EQ(directory.size(), 5);
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
        EXPECT_EQ(error_of([&] { write_file_atomically(file_, name); }),
                  "cannot write \"" + file_.string() +
                      "\": no file can be put in its place (Operation not permitted); what was to be written "
                      "is in \"" +
                      (directory_ / name).string() + '"');
        EXPECT_EQ(read_file(directory_ / name), name);
    }
    EXPECT_EQ(read_file(file_), "old");
    EXPECT_EQ(directory_.size(), 3);
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
