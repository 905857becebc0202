// Files in memory that other programs map.
#include "serve/shared_memory.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"

namespace candela {
namespace {

TEST(SharedMemory, IsAFileOfThisUserThatOthersCanMap) {
    std::filesystem::path path;
    {
        const SharedMemory memory(10000);
        path = memory.path();
        ASSERT_EQ(memory.bytes().size(), 10000u);
        EXPECT_TRUE(std::ranges::all_of(memory.bytes(), [](std::byte b) { return b == std::byte(0); }));
        std::memcpy(memory.bytes().data() + 9990, "0123456789", 10);
        EXPECT_EQ(read_file(path).substr(9990), "0123456789");
        struct stat status {};
        ASSERT_EQ(::stat(path.c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 0777u, 0600u);
        const std::string name = path.filename().string();
        EXPECT_EQ(name.find("candela-shared-" + std::to_string(::getpid()) + '-'), 0u) << name;
        remove_abandoned_memory();  // It is in use.
        EXPECT_TRUE(std::filesystem::exists(path));
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

// What SharedFile says of a path.
std::string refusal_of(const std::filesystem::path& path) {
    try {
        const SharedFile file(path);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(SharedFile, ReadsTheMemoryOfAnotherProgram) {
    const SharedMemory memory(100);
    std::memcpy(memory.bytes().data() + 90, "0123456789", 10);
    const SharedFile file(memory.path());
    EXPECT_EQ(file.size(), 100u);
    std::array<std::byte, 4> bytes{};
    file.read(93, bytes);
    EXPECT_EQ(std::memcmp(bytes.data(), "3456", 4), 0);
    ASSERT_EQ(::truncate(memory.path().c_str(), 95), 0);
    file.read(91, bytes);
    try {
        file.read(92, bytes);
        FAIL() << "it ends there";
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()),
                  "the shared memory \"" + memory.path().string() +
                      "\" ends before byte 96; keep the file as it is until the scene is "
                      "loaded");
    }
}

TEST(SharedFile, IsNoOtherFile) {
    const SharedMemory memory(100);
    const std::filesystem::path folder = memory.path().parent_path();
    const std::filesystem::path link = folder / ("candela-shared-link-" + std::to_string(::getpid()));
    std::filesystem::create_symlink(memory.path(), link);
    for (const std::filesystem::path& path :
         {std::filesystem::path("/etc/passwd"), std::filesystem::path("/"), std::filesystem::path(""), link,
          folder / "candela-shared-none", folder / ".." / folder.filename() / memory.path().filename(),
          std::filesystem::path(memory.path().filename())}) {
        EXPECT_EQ(refusal_of(path).find("no shared memory is called \"" + path.string() +
                                        "\": it must be a file of this user in /dev/shm or "),
                  0u)
            << path << ": " << refusal_of(path);
    }
    std::filesystem::remove(link);
    EXPECT_EQ(refusal_of(memory.path()), "");
}

TEST(SharedMemory, WhatAKilledProgramLeftIsRemoved) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        const SharedMemory memory(100);
        const std::string path = memory.path().string() + '\n';
        if (::write(ends[1], path.data(), path.size()) > 0) ::pause();
        ::_exit(1);
    }
    ::close(ends[1]);
    std::string path;
    for (char c = 0; ::read(ends[0], &c, 1) == 1 && c != '\n';)
        path += c;
    ::close(ends[0]);
    remove_abandoned_memory();
    EXPECT_TRUE(std::filesystem::exists(path)) << "it is in use by another program";
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_TRUE(std::filesystem::exists(path));
    remove_abandoned_memory();
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(SharedMemory, TooMuchIsAnError) {
    try {
        const SharedMemory memory(uint64_t{1} << 60);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
        EXPECT_NE(std::string(error.what()).find("cannot share 1152921504606846976 bytes of memory"),
                  std::string::npos);
    }
}

}  // namespace
}  // namespace candela
