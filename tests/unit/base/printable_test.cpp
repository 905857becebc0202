// What files say is fit for a terminal, short, and counted.
#include "base/printable.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "load/quote.h"

namespace candela {
namespace {

using namespace std::string_literals;

TEST(Printable, LeavesWordsOfAnyLanguageAlone) {
    for (const std::string text :
         {"", "pot.obj:3: \"clay\" C:\\scenes", "Müller", "日本語", "עברית", "नमस्ते", "e\u0301", "👩\u200D🚀",
          "❤\uFE0F", "می\u200Cخواهم", "\U0002A6D6", "\U000E0100"})
        EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesWhatATerminalObeysOrDoesNotShow) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"\0"s, "\\u0000"},
        {"\a", "\\u0007"},
        {"a\nb\r\tc", "a\\nb\\r\\tc"},
        {"\x1B[31m", "\\u001b[31m"},
        {"\x7F", "\\u007f"},
        {"\u0080", "\\u0080"},
        {"\u0085", "\\u0085"},      // Next line.
        {"\u009B2J", "\\u009b2J"},  // A control sequence.
        {"\u009D", "\\u009d"},
        {"\u009F", "\\u009f"},
        {"\u00AD", "\\u00ad"},
        {"\u061C", "\\u061c"},
        {"\u200B", "\\u200b"},
        {"\u200E\u200F", "\\u200e\\u200f"},
        {"\u2028\u2029", "\\u2028\\u2029"},
        {"\u202A\u202E", "\\u202a\\u202e"},
        {"\u2060", "\\u2060"},
        {"\u2066\u2069", "\\u2066\\u2069"},
        {"\uFEFF", "\\ufeff"},
        {"\uFFFE", "\\ufffe"},
        {"\U000E0001\U000E007F", "\\udb40\\udc01\\udb40\\udc7f"},
    };
    for (const auto& [text, shown] : cases) {
        EXPECT_EQ(printable(text), shown);
        EXPECT_EQ(printable("x" + text + "é"), "x" + shown + "é");
        EXPECT_EQ(printable(shown), shown);  // What is fit stays as it is.
    }
}

TEST(Printable, ShowsBytesThatAreNotUtf8) {
    EXPECT_EQ(printable("\x80"), "\\x80");
    EXPECT_EQ(printable("\x9B"
                        "2J"),
              "\\x9b2J");  // What Latin-1 has for the control sequence.
    EXPECT_EQ(printable("M\xFCller"), "M\\xfcller");
    EXPECT_EQ(printable("\xC3"), "\\xc3");  // Cut off.
    EXPECT_EQ(printable("\xE2\x80"), "\\xe2\\x80");
    EXPECT_EQ(printable("\xC0\x9B"), "\\xc0\\x9b");           // Two bytes for U+001B.
    EXPECT_EQ(printable("\xE0\x82\x9B"), "\\xe0\\x82\\x9b");  // Three bytes for U+009B.
    EXPECT_EQ(printable("\xF0\x80\x82\x9B"), "\\xf0\\x80\\x82\\x9b");
    EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");           // A surrogate.
    EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // More than U+10FFFF.
    EXPECT_EQ(printable("\xFF"), "\\xff");
}

TEST(Printable, CutsTheMiddleAndNoCharacter) {
    const std::string digits = "0123456789012345678901234567890123456789";
    EXPECT_EQ(printable(digits, 40), digits);
    EXPECT_EQ(printable(digits + "x", 40), "0123456789012345678901234…90123456789x");
    // 25 bytes of room before the ellipsis and 12 behind.
    std::string umlauts;
    for (int i = 0; i < 30; ++i)
        umlauts += "ä";
    EXPECT_EQ(printable(umlauts, 40), "ääääääääääää…ääääää");
    EXPECT_EQ(printable(std::string(30, '\n'), 40),
              "\\n\\n\\n\\n\\n\\n\\n\\n\\n\\n\\n\\n…\\n\\n\\n\\n\\n\\n");
    const std::string escapes = printable(std::string(1000, '\x1B'), 40);
    EXPECT_EQ(escapes, "\\u001b\\u001b\\u001b\\u001b…\\u001b\\u001b");
    EXPECT_EQ(printable(escapes, 40), escapes);
    const std::string huge = std::string(10'000'000, 'a') + "; remedy";
    EXPECT_EQ(printable(huge, MAX_MESSAGE_BYTES).size(), MAX_MESSAGE_BYTES);
    EXPECT_TRUE(printable(huge, MAX_MESSAGE_BYTES).ends_with("; remedy"));
}

// All code points, one at a time: what is not escaped neither begins a control sequence nor is invalid.
TEST(Printable, IsWholeUtf8WithoutControls) {
    for (uint32_t code = 0; code < 0x110000; ++code) {
        std::string text;
        if (code < 0x80) {
            text = {char(code)};
        } else if (code < 0x800) {
            text = {char(0xC0 | code >> 6), char(0x80 | (code & 63))};
        } else if (code < 0x10000) {
            text = {char(0xE0 | code >> 12), char(0x80 | (code >> 6 & 63)), char(0x80 | (code & 63))};
        } else {
            text = {char(0xF0 | code >> 18), char(0x80 | (code >> 12 & 63)), char(0x80 | (code >> 6 & 63)),
                    char(0x80 | (code & 63))};
        }
        const std::string shown = printable(text);
        const bool is_control = code < 0x20 || (code >= 0x7F && code < 0xA0);
        const bool is_surrogate = code >= 0xD800 && code < 0xE000;
        const bool turns = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
        const bool is_tag = code >= 0xE0000 && code < 0xE0080;
        if (is_control || is_surrogate || turns || is_tag) {
            ASSERT_TRUE(std::ranges::all_of(shown, [](char c) { return c > 0x20 && c < 0x7F; })) << code;
        } else {
            ASSERT_TRUE(shown == text || shown[0] == '\\') << code;
        }
    }
}

TEST(PrintableJson, KeepsTheTextAndTheLines) {
    const nlohmann::json json = {{"a\u009B", "\u202E\U000E0001 Müller \n\x7F"}, {"b", {1, 2}}};
    const std::string shown = printable_json(json.dump(2));
    EXPECT_EQ(nlohmann::json::parse(shown), json);
    EXPECT_EQ(std::ranges::count(shown, '\n'), std::ranges::count(json.dump(2), '\n'));
    EXPECT_NE(shown.find("Müller"), std::string::npos);
    EXPECT_EQ(shown.find("\u009B"), std::string::npos);
    EXPECT_EQ(shown.find("\u202E"), std::string::npos);
    EXPECT_EQ(shown.find('\x7F'), std::string::npos);
}

TEST(Joined, SaysHowManyNamesItLeavesOut) {
    EXPECT_EQ(joined(std::vector<std::string>{}), "");
    EXPECT_EQ(joined(std::vector<std::string>{"a", "b\n"}), "a, b\\n");
    const std::vector<std::string> many(2010, "x");
    EXPECT_TRUE(joined(many).ends_with("x, x and 1990 more"));
    EXPECT_EQ(joined(many).size(), 20 * 3 - 2 + std::string(" and 1990 more").size());
    EXPECT_LE(joined(std::vector<std::string>{std::string(100'000, 'x')}).size(), MAX_NAME_BYTES);
}

TEST(Quote, ShowsATextAndJsonKeepsIt) {
    EXPECT_EQ(quote("a \"b\" \\ \n\u009B\xFF"), R"("a \"b\" \\ \n\u009b\xff")");
    EXPECT_EQ(quote(std::string(1'000'000, 'x')).size(), MAX_NAME_BYTES + 2);
    EXPECT_EQ(json_string("a \"b\" \\ \n"), R"("a \"b\" \\ \n")");
    EXPECT_EQ(json_string(std::string(1'000'000, 'x')).size(), 1'000'002u);
}

using Lines = std::vector<std::string>;

TEST(WarningSummary, CountsWhatDiffersOnlyInItsPlace) {
    Lines warnings;
    for (int i = 0; i < 16; ++i)
        warnings.push_back("a.glb#/meshes/" + std::to_string(i) + "/primitives/0: left out points");
    warnings.emplace_back("a.obj:3: odd");
    warnings.emplace_back("s.json:3:14: a.obj:5: odd");
    warnings.emplace_back("a.obj:77: odd");
    warnings.emplace_back("b.glb#/meshes/1: left out points");
    EXPECT_EQ(summary_of(warnings), (Lines{"a.glb#/meshes/0/primitives/0: left out points (16 times)",
                                           "b.glb#/meshes/1: left out points", "a.obj:3: odd (2 times)",
                                           "s.json:3:14: a.obj:5: odd"}));
}

TEST(WarningSummary, ShowsTheFirstThreeOfAKind) {
    Lines warnings;
    for (int i = 0; i < 2000; ++i) {
        const std::string number = std::to_string(i);
        warnings.push_back("a.mtl:" + number + ": material \"m \\\" " + number + "\": Ns " + number +
                           ".5 is read as 3");
        warnings.push_back("s.json:1:2: textures/" + number + ".png: it is animated");
    }
    warnings.emplace_back("a.mtl:9: something else");
    EXPECT_EQ(
        summary_of(warnings),
        (Lines{"a.mtl:0: material \"m \\\" 0\": Ns 0.5 is read as 3",
               "a.mtl:1: material \"m \\\" 1\": Ns 1.5 is read as 3",
               "a.mtl:2: material \"m \\\" 2\": Ns 2.5 is read as 3",
               "1997 more like the last, with other names or numbers",
               "s.json:1:2: textures/0.png: it is animated", "s.json:1:2: textures/1.png: it is animated",
               "s.json:1:2: textures/2.png: it is animated",
               "1997 more like the last, with other names or numbers", "a.mtl:9: something else"}));
}

TEST(WarningSummary, LeavesFewWarningsAsTheyAre) {
    const Lines warnings = {"a.obj: one", "a.obj: two 1", "a.obj: two 2", "it has no place",
                            "s.json: a \"quotation that does not end \\"};
    EXPECT_EQ(summary_of(warnings), warnings);
    EXPECT_EQ(summary_of({}), Lines{});
}

TEST(WarningSummary, HasABound) {
    Lines warnings;
    std::string word = "a";
    for (int i = 0; i < 5000; ++i) {  // Each is of a kind of its own.
        warnings.push_back(word);
        warnings.back().append(3000, 'x');
        for (size_t c = word.size(); c-- > 0 && ++word[c] > 'z';) {
            word[c] = 'a';
            if (c == 0) word.insert(0, 1, 'a');
        }
    }
    warnings.push_back(std::string(1'000'000, '\x1B'));
    const Lines summary = summary_of(warnings);
    size_t bytes = 0;
    for (const std::string& line : summary)
        bytes += line.size();
    EXPECT_LE(bytes, 65536u + 100);
    EXPECT_EQ(summary.size(), 22u);  // 21 messages of 3000 bytes fit into 64 KiB.
    EXPECT_EQ(summary.back(), "4980 more warnings");
}

}  // namespace
}  // namespace candela
