// Dear ImGui's triangles drawn on the host. Without that library there is nothing to test.
#ifdef CANDELA_VIEW

#include "window/rasterise.h"

#include <gtest/gtest.h>
#include <imgui.h>

namespace candela {
namespace {

constexpr uvec2 WINDOW(40, 24);  // [pixels]

// A frame of Dear ImGui without a window, which holds what a test draws.
class Rasterise : public testing::Test {
  protected:
    Rasterise() {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = ImVec2(float(WINDOW.x), float(WINDOW.y));
        io.Fonts->GetTexDataAsAlpha8(&alpha_, &width_, &height_);
        // Without soft edges, every pixel is inside or not.
        ImGui::GetStyle().AntiAliasedFill = false;
        ImGui::NewFrame();
    }
    ~Rasterise() override { ImGui::DestroyContext(); }

    static ImDrawList& list() { return *ImGui::GetBackgroundDrawList(); }
    void render() {
        ImGui::Render();
        rasterise(*ImGui::GetDrawData(), alpha_, uvec2(width_, height_), WINDOW, overlay_);
    }
    // A pixel of the window; 0 where the overlay does not reach.
    uint32_t at(uint32_t x, uint32_t y) const {
        const PixelRect& rect = overlay_.rect;
        if (x < rect.x0 || x >= rect.x1 || y < rect.y0 || y >= rect.y1) return 0;
        return overlay_.pixels.at(size_t(y - rect.y0) * rect.width() + (x - rect.x0));
    }

    unsigned char* alpha_ = nullptr;
    int width_ = 0;
    int height_ = 0;
    Overlay overlay_;
};

TEST_F(Rasterise, ARectangleFillsItsPixelsAndNoOther) {
    list().AddRectFilled(ImVec2(3, 2), ImVec2(20, 9), IM_COL32(10, 20, 30, 255));
    render();
    for (uint32_t y = 0; y < WINDOW.y; ++y) {
        for (uint32_t x = 0; x < WINDOW.x; ++x) {
            const bool inside = x >= 3 && x < 20 && y >= 2 && y < 9;
            ASSERT_EQ(at(x, y), inside ? IM_COL32(10, 20, 30, 255) : 0u) << x << ' ' << y;
        }
    }
}

// A rectangle is two triangles: a pixel on their common edge would be darker if both covered it, and missing
// if neither did. The sizes bring pixel centres onto the edge.
TEST_F(Rasterise, ATranslucentRectangleHasNoSeam) {
    for (const float size : {7.0f, 8.0f, 12.0f, 21.0f}) {
        list().AddRectFilled(ImVec2(1, 1), ImVec2(1 + size, 1 + size), IM_COL32(255, 0, 0, 51));
        render();
        for (uint32_t y = 1; y < 1 + uint32_t(size); ++y) {
            for (uint32_t x = 1; x < 1 + uint32_t(size); ++x)
                ASSERT_EQ(at(x, y), IM_COL32(51, 0, 0, 51)) << x << ' ' << y;  // Premultiplied.
        }
        ImGui::NewFrame();
    }
    ImGui::EndFrame();
}

// Code values 200 under alpha 51/255 = 1/5 of 100: 4/5 200 + 1/5 100 = 180.
TEST_F(Rasterise, WhatIsDrawnLaterLiesAbove) {
    list().AddRectFilled(ImVec2(0, 0), ImVec2(8, 8), IM_COL32(200, 200, 200, 255));
    list().AddRectFilled(ImVec2(4, 0), ImVec2(8, 8), IM_COL32(100, 100, 100, 51));
    render();
    EXPECT_EQ(at(3, 4), IM_COL32(200, 200, 200, 255));
    EXPECT_EQ(at(4, 4), IM_COL32(180, 180, 180, 255));
}

TEST_F(Rasterise, CutsAtTheClipRectangleAndTheWindow) {
    list().PushClipRect(ImVec2(5, 5), ImVec2(10, 10));
    list().AddRectFilled(ImVec2(-10, -10), ImVec2(100, 100), IM_COL32_WHITE);
    list().PopClipRect();
    render();
    EXPECT_EQ(overlay_.rect, (PixelRect{0, 0, WINDOW.x, WINDOW.y}));
    size_t covered = 0;
    for (const uint32_t pixel : overlay_.pixels)
        covered += pixel != 0;
    EXPECT_EQ(covered, 25u);
    EXPECT_EQ(at(5, 5), IM_COL32_WHITE);
    EXPECT_EQ(at(9, 9), IM_COL32_WHITE);
}

// Letters at whole pixels show the texels of the font as they are.
TEST_F(Rasterise, LettersAreTheFontsTexels) {
    const ImFontGlyph& glyph = *ImGui::GetFont()->FindGlyph('B');
    list().AddText(ImVec2(4, 4), IM_COL32(255, 255, 255, 255), "B");
    render();
    size_t dark = 0;
    size_t bright = 0;
    for (int y = 0; y < int(glyph.Y1 - glyph.Y0); ++y) {
        for (int x = 0; x < int(glyph.X1 - glyph.X0); ++x) {
            const int u = int(glyph.U0 * float(width_) + 0.5f) + x;
            const int v = int(glyph.V0 * float(height_) + 0.5f) + y;
            const uint32_t texel = alpha_[v * width_ + u];
            ASSERT_EQ(at(uint32_t(4 + int(glyph.X0) + x), uint32_t(4 + int(glyph.Y0) + y)),
                      texel * 0x01010101u);
            ++(texel == 0 ? dark : bright);
        }
    }
    EXPECT_GT(dark, 5u);
    EXPECT_GT(bright, 5u);
}

TEST_F(Rasterise, NothingDrawnIsAnEmptyOverlay) {
    render();
    EXPECT_EQ(overlay_.rect.width() * overlay_.rect.height(), 0u);
    EXPECT_TRUE(overlay_.pixels.empty());
}

}  // namespace
}  // namespace candela

#endif
