// Files: read whole, written whole or not at all, with errors that say what to do.
#include "base/file.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/temporary_file.h"
#include "unit/base/base_fixture.h"

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
    EXPECT_EQ(message, "cannot write \"" + file.string() + "\": " + std::generic_category().message(EFBIG) +
                           "; free some space or choose another place");
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

}  // namespace
}  // namespace candela
