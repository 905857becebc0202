// The memory that `new` hands out: counted, and refused beyond a limit.
#include "base/memory_limit.h"

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/threads.h"
#include "unit/base/base_fixture.h"

namespace candela {
namespace {

constexpr uint64_t MEBI = uint64_t(1) << 20;

// As long as it lives, the process may allocate only that many bytes in addition to its current ones.
class LimitFromHere {
  public:
    explicit LimitFromHere(uint64_t bytes) { set_memory_limit(memory_in_use() + bytes); }
    LimitFromHere(const LimitFromHere&) = delete;
    LimitFromHere& operator=(const LimitFromHere&) = delete;
    ~LimitFromHere() { set_memory_limit(UINT64_MAX); }

  private:
    LimitedMemory limited_;
};

struct alignas(64) Aligned {
    char bytes[64];
};

// Compilers may leave out memory that nothing sees.
std::atomic<void*> seen = nullptr;

template <class T = char>
std::unique_ptr<T[]> take(uint64_t count) {
    auto memory = std::make_unique<T[]>(count);
    seen = memory.get();
    return memory;
}

TEST(MemoryLimit, CountsWhatIsTakenAndGivenBack) {
    const uint64_t before = memory_in_use();
    {
        const auto one = take(10 * MEBI);
        EXPECT_GE(memory_in_use(), before + 10 * MEBI);
        EXPECT_LE(memory_in_use(), before + 11 * MEBI);
        const auto aligned = take<Aligned>(MEBI / 64);
        EXPECT_GE(memory_in_use(), before + 11 * MEBI);
        std::thread([] { EXPECT_NE(take(MEBI), nullptr); }).join();
        const MemoryCharge charge(100 * MEBI);
        EXPECT_GE(memory_in_use(), before + 111 * MEBI);
    }
    EXPECT_LE(memory_in_use(), before + MEBI / 16);
}

TEST(MemoryLimit, IsRefusedBeforeItIsTaken) {
    const LimitFromHere limit(64 * MEBI);
    const uint64_t before = memory_in_use();
    EXPECT_NO_THROW(take(60 * MEBI));
    EXPECT_THROW(take(65 * MEBI), LimitReached);
    EXPECT_THROW(take<Aligned>(65 * MEBI / 64), LimitReached);
    EXPECT_THROW(MemoryCharge(65 * MEBI), LimitReached);
    // More than any machine has: nothing is touched.
    EXPECT_THROW(take(uint64_t(1) << 46), LimitReached);
    EXPECT_LE(memory_in_use(), before + MEBI / 16);
    // In small pieces, too.
    std::vector<std::unique_ptr<char[]>> pieces;
    pieces.reserve(MEBI);
    EXPECT_THROW(
        {
            while (pieces.size() < MEBI)
                pieces.push_back(take(1000));
        },
        LimitReached);
    EXPECT_LE(memory_in_use(), memory_limit() + 2 * MEBI);
}

TEST(MemoryLimit, HoldsOnlyWhereItIsAskedFor) {
    set_memory_limit(1);
    EXPECT_NO_THROW(take(MEBI));
    set_memory_limit(UINT64_MAX);
}

// A driver's threads beside one that reads a scene must not run out of memory; those that help it may.
TEST(MemoryLimit, HoldsForAThreadAndItsHelpersAlone) {
    const LimitFromHere limit(MEBI);
    std::thread([] { EXPECT_NO_THROW(take(4 * MEBI)); }).join();
    std::atomic<int> refused = 0;
    const auto work = [&] {
        try {
            take(4 * MEBI);
        } catch (const LimitReached&) {
            ++refused;
        }
    };
    EXPECT_EQ(start_helpers(2, work).size(), 2u);
    EXPECT_EQ(refused, 2);
}

TEST(MemoryLimit, TheErrorSaysWhatTakesHowMuch) {
    const LimitFromHere limit(64 * MEBI);
    const auto place = [] { return std::string("a.glb#/nodes/3"); };
    try {
        with_memory_for("what the node shows", place, [] {
            const auto one = take(40 * MEBI);
            return take(30 * MEBI);
        });
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
        const std::string message = error.what();
        EXPECT_TRUE(
            message.starts_with("a.glb#/nodes/3: there is not enough memory for what the node shows, which "
                                "needs at least 70 MiB, where "))
            << message;
        EXPECT_NE(message.find(" MiB are in use and --memory-limit allows "), std::string::npos) << message;
        EXPECT_TRUE(message.ends_with(" MiB; make it smaller, or use a larger machine")) << message;
    }
    // Where it is the machine that has no more.
    EXPECT_EQ(
        error_of([&] { with_memory_for("the tree", place, [] { throw std::bad_alloc(); }); }),
        "a.glb#/nodes/3: there is not enough memory for the tree; make it smaller, or use a larger machine");
}

TEST(MemoryLimit, IsASizeWithAUnit) {
    EXPECT_EQ(parse_memory_size("4096"), 4096u);
    EXPECT_EQ(parse_memory_size("500M"), 500'000'000u);
    EXPECT_EQ(parse_memory_size("1.5GB"), 1'500'000'000u);
    EXPECT_EQ(parse_memory_size("4GiB"), uint64_t(4) << 30);
    EXPECT_EQ(parse_memory_size("2KiB"), 2048u);
    EXPECT_EQ(parse_memory_size("1kB"), 1000u);
    EXPECT_EQ(parse_memory_size("1TiB"), uint64_t(1) << 40);
    for (const char* text :
         {"", "M", "-1M", "0", "0.1", "1X", "1Mi", "1MiBs", "1 M", "1e30", "nan", "inf", "1iB"})
        EXPECT_EQ(parse_memory_size(text), std::nullopt) << text;
}

TEST(MemoryLimit, IsByDefaultAShareOfTheMachines) {
    const auto machine = uint64_t(::sysconf(_SC_PHYS_PAGES)) * uint64_t(::sysconf(_SC_PAGESIZE));
    EXPECT_GT(default_memory_limit(), 0u);
    EXPECT_LE(default_memory_limit(), machine / 4 * 3);
}

}  // namespace
}  // namespace candela
