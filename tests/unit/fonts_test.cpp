// The fonts' characters: what of other scripts is loaded once it is to be shown, and how much of it.
#include "gui/fonts.h"

#include <gtest/gtest.h>
#include <imgui.h>

using namespace probewarp;

namespace {

struct FontsTest : testing::Test {
    FontsTest() { ImGui::CreateContext(); }
    ~FontsTest() override { ImGui::DestroyContext(); }
};

Characters asked(const char* text) {
    Glyphs glyphs;
    glyphs.ask(text);
    return glyphs.asked;
}

/// A sign of each of the scripts that script/bootstrap brings fonts for.
constexpr const char* scripts = "漢かカ한ع\u05D0กक বગਕಕខລമမଓසதఅ・！Ạ";

}  // namespace

TEST_F(FontsTest, UsualTextAsksForNothing) {
    EXPECT_EQ(asked("Grüße, Ελλάδα, Привет – 3 × 4 → 12 ●"), Characters());
    EXPECT_EQ(asked("a東b京c東"), (Characters{0x6771, 0x4EAC}));
    EXPECT_EQ(asked("\U0001F389"), Characters{0xFFFD});  // more than ImGui's characters hold
}

TEST_F(FontsTest, OtherScriptsComeWhenTheyAreAskedFor) {
    const Fonts before = load_fonts(1);
    EXPECT_EQ(before.text->FindGlyphNoFallback(0x6F22), nullptr);
    const Characters characters = asked(scripts);
    ASSERT_EQ(characters.size(), 23u);
    for (const float scale : {1.0f, 2.0f}) {
        const Fonts fonts = load_fonts_with(scale, characters);
        for (const ImWchar c : characters)
            for (const ImFont* font : {fonts.text, fonts.strong, fonts.small}) {
                const ImFontGlyph* glyph = font->FindGlyphNoFallback(c);
                ASSERT_NE(glyph, nullptr) << std::hex << c;
                EXPECT_GT(glyph->X1 - glyph->X0, 1) << std::hex << c;
            }
        EXPECT_NE(fonts.text->FindGlyphNoFallback('A'), nullptr);
    }
}

TEST_F(FontsTest, WhatNoFontHasIsNoFailure) {
    const Fonts fonts = load_fonts_with(1, {0x2FE0, 0x6F22});  // the first is nobody's
    EXPECT_EQ(fonts.text->FindGlyphNoFallback(0x2FE0), nullptr);
    EXPECT_NE(fonts.text->FindGlyphNoFallback(0x6F22), nullptr);
}

TEST(Glyphs, AreLoadedOnceAndStay) {
    Glyphs glyphs;
    EXPECT_FALSE(glyphs.update(1));
    glyphs.ask("東京");
    EXPECT_TRUE(glyphs.update(1));
    glyphs.ask("京");
    EXPECT_FALSE(glyphs.update(1));
    glyphs.ask("한");
    EXPECT_TRUE(glyphs.update(1));
    EXPECT_EQ(glyphs.loaded, (Characters{0x4EAC, 0x6771, 0xD55C}));
}

TEST(Glyphs, AreNeverMoreThanTheAtlasTakes) {
    for (const float scale : {1.0f, 4.0f}) {
        const std::size_t most = most_characters(scale);
        ASSERT_GT(most, 500u);  // a screen full of them
        Glyphs glyphs;
        for (int beginning = 0; beginning < 20000; beginning += 150) {
            for (int k = 0; k < 300; ++k) glyphs.asked.insert(ImWchar(0x4E00 + (beginning + k) % 20000));
            glyphs.update(scale);
            EXPECT_LE(glyphs.loaded.size(), most);
        }
        // More in one frame than fit: some are left out, and the atlas is not made anew for ever.
        for (int frame = 0; frame < 3; ++frame) {
            for (int k = 0; k < 20000; ++k) glyphs.asked.insert(ImWchar(0x4E00 + k));
            EXPECT_EQ(glyphs.update(scale), frame == 0);
            EXPECT_EQ(glyphs.loaded.size(), most);
        }
    }
}
