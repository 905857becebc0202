// The functions of C read what std::from_chars does, and no more of it.
#include "base/parse_float.h"

#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "probe/random.h"

namespace candela {
namespace {

template <class T>
void expect_same(const std::string& text) {
    SCOPED_TRACE(text);
    const char* const end = text.data() + text.size();
    T expected = T(7), found = T(7);
    const auto [stop, error] = parse_float(text.data(), end, expected);
    const auto [its_stop, its_error] = parse_float_by_c(text.data(), end, found);
    EXPECT_EQ(its_stop - text.data(), stop - text.data());
    EXPECT_EQ(its_error, error);
    EXPECT_EQ(std::isnan(found), std::isnan(expected));
    if (!std::isnan(expected)) {
        EXPECT_EQ(found, expected);
        EXPECT_EQ(std::signbit(found), std::signbit(expected));
    }
}

TEST(ParseFloat, ByCIsTheSame) {
    for (const char* text : {"0",
                             "-0",
                             "1",
                             "-1.5",
                             "1.",
                             ".5",
                             "-.5",
                             "1e3",
                             "1E-3",
                             "1e+3",
                             "1e",
                             "1e+",
                             "1e5x",
                             "0.1",
                             "0e5",
                             "0e999",
                             "1e-999",
                             "-1e-999",
                             "1e999",
                             "-1e999",
                             ".9e999",
                             "0x10",
                             "-0x10",
                             "0X",
                             "inf",
                             "-inf",
                             "INF",
                             "infinity",
                             "infinite",
                             "nan",
                             "-nan",
                             "NaN",
                             "nanx",
                             "",
                             "-",
                             "+",
                             "+1",
                             "--1",
                             "-+1",
                             " 1",
                             "\t1",
                             "- 1",
                             "1 2",
                             "0 2",
                             ".",
                             "e5",
                             "abc",
                             "1,5",
                             "3.4028235e38",
                             "3.5e38",
                             "1e-46",
                             "2.2250738585072011e-308"}) {
        expect_same<float>(text);
        expect_same<double>(text);
    }
}

TEST(ParseFloat, ByCRoundsTheSameNumbers) {
    Random random(1);
    for (int i = 0; i < 10000; ++i) {
        char text[64];
        const double size = std::pow(10.0, 60.0 * double(random.unit()) - 30.0);
        const double number = (random.unit() - 0.5) * size;
        std::snprintf(text, sizeof text, "%.*g", 1 + i % 20, number);
        expect_same<float>(text);
        expect_same<double>(text);
    }
}

}  // namespace
}  // namespace candela
