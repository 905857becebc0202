// What the tests of MTL files share: libraries and materials from texts, and their warnings.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "load/obj/mtl.h"
#include "unit/load/scene_fixture.h"

namespace candela {

class Mtl : public testing::Test {
  protected:
    MtlLibrary load(const std::string& text) {
        folder_.write("m.mtl", text);
        return load_mtl(folder_.path() / "m.mtl", FileReach(folder_.path() / "m.obj"));
    }

    // The one material of a file, whose statements are `text`, from line 2 on.
    MtlMaterial material(const std::string& text) { return load("newmtl a\n" + text).materials.at("a"); }

    template <class Model>
    Model model(const std::string& text) {
        return std::get<Model>(material(text).material.model);
    }

    void expect_error(const std::string& text, const std::string& message) {
        SCOPED_TRACE(text);
        EXPECT_EQ(folder_.without_folder(error_of([&] { load(text); })), message);
    }

    // Checks the one warning of a material, after its place and name.
    void expect_warning(const std::string& text, const std::string& warning) {
        SCOPED_TRACE(text);
        const std::vector<MtlWarning> warnings = material(text).warnings;
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_EQ(folder_.without_folder(warnings[0].text), "m.mtl:1: material \"a\": " + warning);
    }

    // Checks the warnings of a file.
    void expect_library_warnings(const std::string& text, const std::vector<std::string>& expected) {
        SCOPED_TRACE(text);
        const std::vector<std::string> warnings = load(text).warnings;
        ASSERT_EQ(warnings.size(), expected.size());
        for (size_t i = 0; i < expected.size(); ++i)
            EXPECT_EQ(folder_.without_folder(warnings[i]), expected[i]);
    }

    SceneFolder folder_;
};

}  // namespace candela
