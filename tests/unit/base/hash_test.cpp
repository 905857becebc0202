// The hash of bytes, and that of large arrays: the latter must notice every small change, above all those
// that are typical of floats.
#include "base/hash.h"

#include <array>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace candela {
namespace {

uint64_t hash_of(const std::vector<uint64_t>& words) {
    return hash_words(std::as_bytes(std::span(words)));
}

// 2016 pairs of bits among 64 chosen ones (each sign bit of 32 floats, and each lowest bit), and those alone:
// by chance, two of 2081 hashes would be the same with a probability of 1e-13.
TEST(HashWords, EveryBitAndEveryPairOfBitsChangesIt) {
    std::set<uint64_t> hashes{hash_of(std::vector<uint64_t>(16))};
    const auto flip = [](std::vector<uint64_t>& words, size_t i) {
        words[i / 4] ^= uint64_t{1} << std::vector<int>{0, 31, 32, 63}[i % 4];
    };
    for (size_t i = 0; i < 64; ++i) {
        for (size_t j = i; j < 64; ++j) {
            std::vector<uint64_t> words(16);
            flip(words, i);
            if (j != i) flip(words, j);
            EXPECT_TRUE(hashes.insert(hash_of(words)).second) << i << ' ' << j;
        }
    }
}

TEST(HashWords, OrderNumberAndWhatWasBeforeMatter) {
    const std::set<uint64_t> hashes{hash_of({}),
                                    hash_of({0}),
                                    hash_of({0, 0}),
                                    hash_of({1, 2}),
                                    hash_of({2, 1}),
                                    hash_of({1, 2, 0}),
                                    hash_words({}, hash_of({1, 2})),
                                    hash_words({}, 1u)};
    EXPECT_EQ(hashes.size(), 8u);
}

TEST(HashWords, BytesBeyondTheLastWholeWordMatter) {
    const std::array<unsigned char, 11> bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 0};
    std::set<uint64_t> hashes;
    for (size_t count = 0; count <= bytes.size(); ++count)
        hashes.insert(hash_words(std::as_bytes(std::span(bytes).first(count))));
    EXPECT_EQ(hashes.size(), 12u);
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
