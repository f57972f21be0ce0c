// The window's colours: what is read keeps the contrast that WCAG 2.1 asks for, in both themes.
#include "gui/theme.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

using namespace probewarp;

namespace {

constexpr double for_text = 4.5, for_disabled = 3;  // WCAG 2.1, 1.4.3; look: what is disabled may go to 3 : 1
constexpr ImU32 white = IM_COL32_WHITE, black = IM_COL32_BLACK;

const Theme* const themes[] = {&dark_theme(), &light_theme()};

std::string in(const Theme& theme) { return theme.is_light ? "in the light theme" : "in the dark theme"; }

}  // namespace

TEST(Contrast, IsThatOfTheStandard) {
    EXPECT_NEAR(contrast(white, black), 21, 1e-9);
    EXPECT_NEAR(contrast(black, white), 21, 1e-9);
    EXPECT_NEAR(contrast(white, white), 1, 1e-9);
    EXPECT_NEAR(contrast(IM_COL32(0x76, 0x76, 0x76, 255), white), 4.54, 0.005);  // the well-known grey
}

TEST(Theme, InkIsReadableOnWhateverItStandsOn) {
    for (const Theme* theme : themes)
        for (const ImU32 ground : {theme->canvas, theme->panel, theme->raised}) {
            for (const ImU32 ink : {theme->text, theme->soft, theme->muted, theme->accent, theme->warning})
                EXPECT_GE(contrast(ink, ground), for_text)
                    << in(*theme) << std::hex << " " << ink << " on " << ground;
            EXPECT_GE(contrast(theme->dim, ground), for_disabled) << in(*theme);
        }
}

TEST(Theme, ButtonsAreReadableUnderThePointer) {
    for (const Theme* theme : themes) {
        EXPECT_GE(contrast(theme->text, theme->over), for_text) << in(*theme);
        for (const ImU32 ground : {theme->accent, theme->accent_over, theme->accent_pressed})
            EXPECT_GE(contrast(theme->on_accent, ground), for_text) << in(*theme);
    }
}

TEST(Theme, WhatIsDisabledCanBeSeen) {
    for (const Theme* theme : themes)
        for (const ImU32 ink : {theme->text, theme->muted})
            EXPECT_GE(contrast(mixed(theme->panel, ink, disabled_opacity), theme->panel), for_disabled)
                << in(*theme);
}

TEST(Theme, LabelsOnThePictureAreReadableOnEveryPicture) {
    for (const ImU32 picture : {white, black, IM_COL32(255, 0, 0, 255), IM_COL32(0, 255, 255, 255)})
        for (const ImU32 ink : {on_picture::text, on_picture::hint})
            EXPECT_GE(contrast(ink, mixed(picture, on_picture::night, on_picture::label_opacity)), for_text);
}
