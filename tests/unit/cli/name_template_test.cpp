// The names of pictures: fields in braces.
#include "cli/name_template.h"

#include <gtest/gtest.h>

#include "unit/base/base_fixture.h"

namespace candela {
namespace {

const NameFields FIELDS{.stem = "chair",
                        .name = "chair.v2.glb",
                        .folder = "models",
                        .camera = "front",
                        .scene = "Scene 1",
                        .variant = "red",
                        .view = 7,
                        .frame = 12345};

std::optional<std::string> name(const std::string& text, const NameFields& fields = FIELDS) {
    return NameTemplate(text).name(fields);
}

std::string with_camera(const std::string& camera, const std::string& text = "out/{camera}.png") {
    NameFields fields = FIELDS;
    fields.camera = camera;
    return *name(text, fields);
}

TEST(NameTemplate, IsFilledWithFields) {
    EXPECT_EQ(name("plain.png"), "plain.png");
    EXPECT_EQ(name("{folder}/{stem}-{camera}.exr"), "models/chair-front.exr");
    EXPECT_EQ(name("{name}.png"), "chair.v2.glb.png");
    EXPECT_EQ(name("{scene}_{variant}{view}.png"), "Scene 1_red7.png");
    EXPECT_EQ(name("{view:03}.png"), "007.png");
    EXPECT_EQ(name("{frame:04}{frame}.png"), "1234512345.png");
    EXPECT_EQ(name("{{{stem}}}.png"), "{chair}.png");
}

TEST(NameTemplate, TakesTheFieldsOfAFileFromItsPath) {
    const NameFields fields = fields_of("models/a/chair.v2.glb");
    EXPECT_EQ(fields.stem, "chair.v2");
    EXPECT_EQ(fields.name, "chair.v2.glb");
    EXPECT_EQ(fields.folder, "a");
    EXPECT_EQ(fields_of("a.glb").folder, std::filesystem::current_path().filename());
    EXPECT_EQ(fields_of("models/a/../b/./c.glb").folder, "b");
}

TEST(NameTemplate, WaitsForTheCamera) {
    NameFields fields = FIELDS;
    fields.camera.reset();
    EXPECT_EQ(name("{camera}.png", fields), std::nullopt);
    EXPECT_EQ(name("{stem}.png", fields), "chair.png");
}

// Names of cameras come from files of strangers.
TEST(NameTemplate, NoFieldLeavesItsFolder) {
    EXPECT_EQ(with_camera("a/b\\c"), "out/a_b_c.png");
    EXPECT_EQ(with_camera("../../etc/x"), "out/_._.._etc_x.png");
    EXPECT_EQ(with_camera("..", "out/{camera}/a.png"), "out/_./a.png");
    EXPECT_EQ(with_camera(".", "out/.{camera}/a.png"), "out/._/a.png");
    EXPECT_EQ(with_camera("/etc/x", "{camera}.png"), "_etc_x.png");
    EXPECT_EQ(with_camera("", "out/{camera}/a.png"), "out/_/a.png");
    EXPECT_EQ(with_camera(std::string("a\0b\n\x7f", 5)), "out/a_b__.png");
    EXPECT_EQ(with_camera("{stem}"), "out/{stem}.png");
    EXPECT_EQ(with_camera("Kamera ä.1"), "out/Kamera ä.1.png");
}

TEST(NameTemplate, KnowsWhichFieldsItUsesAndWhere) {
    const NameTemplate name("out/{stem}/{view:03}.png");
    EXPECT_TRUE(name.uses("stem"));
    EXPECT_TRUE(name.uses("view"));
    EXPECT_FALSE(name.uses("camera"));
    EXPECT_TRUE(name.names_folders());
    EXPECT_FALSE(NameTemplate("out/{stem}.png").names_folders());
    EXPECT_FALSE(NameTemplate("out/a.png").names_folders());
}

TEST(NameTemplate, RefusesWhatItCannotFill) {
    const auto refused = [](const std::string& text, const NameFields& fields = FIELDS) {
        return error_of([&] { NameTemplate(text).name(fields); });
    };
    const std::string fields = "{stem}, {name}, {folder}, {camera}, {view}, {frame}, {scene}, {variant}";
    EXPECT_EQ(refused("{sten}.png"),
              "-o: \"{sten}.png\" has the unknown field {sten}; the fields are " + fields);
    EXPECT_EQ(refused("{}.png"), "-o: \"{}.png\" has the unknown field {}; the fields are " + fields);
    for (const std::string text : {"a{stem.png", "a}.png", "{{stem}.png"}) {
        EXPECT_EQ(refused(text),
                  "-o: \"" + text +
                      "\" has a single brace; write {{ or }} for a brace of the name, or one of " + fields);
    }
    for (const std::string field :
         {"{stem:04}", "{view:4}", "{view:0}", "{view:010}", "{frame:}", "{frame:0x}"}) {
        EXPECT_EQ(refused(field),
                  "-o: cannot use " + field +
                      "; only {view} and {frame} can have a number of digits, from {view:01} to "
                      "{view:09}");
    }
    EXPECT_EQ(refused("{variant}.png", {}),
              "-o: {variant} is what --variant names; give --variant, or leave it out");
    EXPECT_EQ(refused("{scene}.png", {}), "-o: {scene} is what --scene names; give --scene, or leave it out");
}

}  // namespace
}  // namespace candela
