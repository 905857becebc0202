// The inputs of the fuzzers, in every build: those that they begin with, and those that once found something.
#include <filesystem>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/file.h"
#include "fuzz/targets.h"

namespace candela {
namespace {

TEST(FuzzCorpora, EveryInputIsUsedOrRefused) {
    for (const auto& [name, run] : fuzz::TARGETS) {
        size_t used = 0;
        for (const auto& entry :
             std::filesystem::directory_iterator(std::filesystem::path(CANDELA_CORPORA) / name)) {
            SCOPED_TRACE(entry.path());
            try {
                run(read_file(entry.path()));
                ++used;
            } catch (const Error&) {
            }
        }
        EXPECT_GT(used, 0u) << name << ": a fuzzer that begins with nothing that is right gets nowhere";
    }
}

}  // namespace
}  // namespace candela
