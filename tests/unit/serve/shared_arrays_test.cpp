// Arrays in memory that a client shares; tests/python/shared_test.py has what they are used for, and what is
// refused.
#include "serve/shared_arrays.h"

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "load/json.h"
#include "load/node.h"
#include "serve/shared_memory.h"

namespace candela::serve {
namespace {

TEST(SharedArrays, AreWhereTheRequestSays) {
    const SharedMemory memory(64);
    const std::array<float, 4> numbers{1.0f, 2.0f, 3.0f, 4.0f};
    std::memcpy(memory.bytes().data() + 8, numbers.data(), sizeof numbers);
    const std::string file = R"({"file": ")" + memory.path().generic_string() + '"';
    const json::Document document{"request",
                                  json::parse("{\"a\": " + file +
                                                  R"(, "offset": 8, "type": "float32", "shape": [2, 2]},
                                                         "b": )" +
                                                  file + R"(, "type": "float64", "shape": [3, 0, 1]},
                                                         "c": )" +
                                                  file + R"(, "type": "uint8", "shape": [64]}})",
                                              "request")};
    const SharedArrays arrays{Node(document)};
    EXPECT_EQ(arrays.names(), (std::vector<std::string>{"a", "b", "c"}));
    EXPECT_EQ(arrays.find("d"), nullptr);
    ASSERT_NE(arrays.find("a"), nullptr);
    EXPECT_EQ(arrays.find("a")->type, NumberType::float32);
    EXPECT_EQ(arrays.find("b")->shape, (std::vector<uint64_t>{3, 0, 1}));
    EXPECT_EQ(arrays.needed(), 4 * sizeof(float) + 64);
    std::array<float, 2> read{};
    arrays.read("a", 4, std::as_writable_bytes(std::span(read)));
    EXPECT_EQ(read, (std::array<float, 2>{2.0f, 3.0f}));
}

}  // namespace
}  // namespace candela::serve
