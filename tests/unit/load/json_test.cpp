// The JSON document with places: what it accepts, where it says that values are, and what it says of bad
// text.
#include "load/json.h"

#include <gtest/gtest.h>

#include "unit/load/scene_fixture.h"

namespace candela {
namespace {

std::string place_of(const json::Value& value) {
    return std::to_string(value.place.line) + ':' + std::to_string(value.place.column);
}

const json::Value& member(const json::Value& object, const std::string& key) {
    for (const json::Member& m : std::get<json::Object>(object.data)) {
        if (m.key == key) return m.value;
    }
    throw std::logic_error("no key " + key);
}

void expect_error(std::string text, const std::string& message) {
    SCOPED_TRACE(text);
    const std::string place = take_mark(text);
    EXPECT_EQ(error_of([&] { json::parse(text, "x.json"); }), "x.json:" + place + ": " + message);
}

TEST(Json, KeepsValuesAndOrder) {
    const json::Value root =
        json::parse(R"({"z": [1, -2.5, 1e3], "a": "\u00e9\n", "t": true, "n": null})", "x.json");
    const auto& object = std::get<json::Object>(root.data);
    ASSERT_EQ(object.size(), 4u);
    EXPECT_EQ(object[0].key, "z");
    EXPECT_EQ(object[3].key, "n");
    const auto& array = std::get<json::Array>(object[0].value.data);
    ASSERT_EQ(array.size(), 3u);
    EXPECT_EQ(std::get<double>(array[1].data), -2.5);
    EXPECT_EQ(std::get<double>(array[2].data), 1000.0);
    EXPECT_EQ(std::get<std::string>(object[1].value.data), "\xC3\xA9\n");
    EXPECT_TRUE(std::get<bool>(object[2].value.data));
    EXPECT_TRUE(std::holds_alternative<std::nullptr_t>(object[3].value.data));
}

TEST(Json, KnowsThePlaceOfEveryValue) {
    const json::Value root = json::parse(
        "// one { [ \"\n/* two\n ** , : */ {\"a\" : /*x*/[ 1 ,\r\n\t-2e1, {}],\"b\\\"}\":"
        "\"\\\\\"//end\n ,\"c\":false,\"d\":7/**/}",
        "x.json");
    EXPECT_EQ(place_of(root), "3:12");
    const auto& array = std::get<json::Array>(member(root, "a").data);
    EXPECT_EQ(place_of(member(root, "a")), "3:24");
    EXPECT_EQ(place_of(array[0]), "3:26");
    EXPECT_EQ(place_of(array[1]), "4:2");
    EXPECT_EQ(place_of(array[2]), "4:8");
    EXPECT_EQ(place_of(member(root, "b\"}")), "4:19");
    EXPECT_EQ(place_of(member(root, "c")), "5:7");
    EXPECT_EQ(place_of(member(root, "d")), "5:17");
    EXPECT_EQ(std::get<json::Object>(root.data)[2].place.column, 3u);
}

TEST(Json, CountsColumnsInCodePoints) {
    const json::Value root = json::parse("[\"\xC3\xA9\xE2\x82\xAC\xF0\x9F\x92\xA1\", 1]", "x.json");
    EXPECT_EQ(place_of(std::get<json::Array>(root.data)[1]), "1:9");
}

TEST(Json, SaysWhatIsWrongAndWhere) {
    const std::string value = "syntax error while parsing value - ";
    expect_error("{\"a\": @}", value + "unexpected '}'; expected '[', '{', or a literal");
    expect_error("[1,@,2]", value + "unexpected ','; expected '[', '{', or a literal");
    expect_error("[1, // one\n@]", value + "unexpected ']'; expected '[', '{', or a literal");
    expect_error("{\"a\": @tru}", value + "invalid literal");
    expect_error("[@\"abc\n\"]",
                 value + "invalid string: control character U+000A (LF) must be escaped to \\u000A or \\n");
    expect_error("[@\"\xFF\"]", value + "invalid string: ill-formed UTF-8 byte");
    expect_error("[1] @[2]", value + "unexpected '['; expected end of input");
    expect_error("{\"a\" @1}",
                 "syntax error while parsing object separator - unexpected number literal; expected ':'");
    expect_error("{\"a\": 1 @\"b\": 2}",
                 "syntax error while parsing object - unexpected string literal; expected '}'");
    expect_error("{@a: 1}", "syntax error while parsing object key - invalid literal");
    expect_error("[1 @/* open", "syntax error while parsing array - invalid comment; missing closing '*/'");
    expect_error("[1, @1e999]", "the number is too large; write one below 1.8e308");
    expect_error("{\"a\": 1,\n @\"a\": 2}", "duplicate key \"a\"; keep one of the two");
}

TEST(Json, RefusesTruncatedText) {
    expect_error(
        "[1,@",
        "syntax error while parsing value - unexpected end of input; expected '[', '{', or a literal");
    expect_error("{\"a\": {\n@",
                 "syntax error while parsing object key - unexpected end of input; expected string literal");
    expect_error("[@\"ab", "syntax error while parsing value - invalid string: missing closing quote");
    expect_error(
        "  // nothing\n@",
        "syntax error while parsing value - unexpected end of input; expected '[', '{', or a literal");
}

TEST(Json, RefusesWhatIsNotText) {
    expect_error("@", "the file is empty; a scene is a JSON object { ... }");
    expect_error("@\xEF\xBB\xBF{}", "the file begins with a byte order mark; save it as UTF-8 without one");
    expect_error(std::string("{\n @\0}", 6),
                 "found a byte of value 0: this is not text; a scene is JSON in UTF-8");
    expect_error("@\xFF\xFE{", "syntax error while parsing value - invalid literal");
}

TEST(Json, LimitsNesting) {
    const std::string open(256, '[');
    EXPECT_NO_THROW(json::parse(open + std::string(256, ']'), "x.json"));
    expect_error(open + "@" + std::string(100000, '['),
                 "arrays and objects are nested deeper than 256; nest them less");
}

TEST(Json, TellsPlacesByLinesOrPointers) {
    json::Document document{"x.json", json::parse("{\"a/b\": [1,\n {\"~\": true}]}", "x.json")};
    const json::Value& inner = std::get<json::Array>(member(document.root, "a/b").data)[1];
    EXPECT_EQ(json::place_of(document, member(inner, "~")), "x.json:2:8");
    document.places = json::Document::Places::pointers;
    EXPECT_EQ(json::place_of(document, member(inner, "~")), "x.json#/a~1b/1/~0");
    EXPECT_EQ(json::place_of(document, document.root), "x.json#");
    document.root = json::parse("{\"" + std::string(1'000'000, 'x') + "\\u001b\": 1}", "x.json");
    const std::string cut = json::place_of(document, std::get<json::Object>(document.root.data)[0].value);
    EXPECT_LT(cut.size(), 150u);
    EXPECT_TRUE(cut.ends_with("xxx\\u001b")) << cut;
}

TEST(Json, DescribesValuesForMessages) {
    const auto description = [](const char* text) { return json::describe(json::parse(text, "x.json")); };
    EXPECT_EQ(description("null"), "null");
    EXPECT_EQ(description("0.5"), "0.5");
    EXPECT_EQ(description(R"("a\nb")"), R"("a\nb")");
    EXPECT_EQ(description("[1, 2]"), "[1, 2]");
    EXPECT_EQ(description("[1, []]"), "an array of 2");
    EXPECT_EQ(description("[1, 2, 3, 4, 5]"), "an array of 5");
    EXPECT_EQ(description("{}"), "an object");
}

TEST(Json, FindsEachOfManyKeysAndNoOther) {
    for (const int count : {1, 16, 17, 1000}) {
        std::string text = "{";
        for (int i = 0; i < count; ++i)
            text += (i == 0 ? "\"k" : ", \"k") + std::to_string(7 * i % count) + "\": " + std::to_string(i);
        const json::Value value = json::parse(text + "}", "f");
        const auto& object = std::get<json::Object>(value.data);
        for (int i = 0; i < count; ++i) {
            const json::Member* member = object.find("k" + std::to_string(7 * i % count));
            ASSERT_NE(member, nullptr);
            EXPECT_EQ(std::get<double>(member->value.data), double(i));
        }
        for (const char* other : {"", "k", "k1000", "kk", "l"})
            EXPECT_EQ(object.find(other), nullptr) << other;
    }
}

}  // namespace
}  // namespace candela
