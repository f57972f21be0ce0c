// gui/text_order: what runs from right to left, turned round and joined; everything else as it is.
#include <gtest/gtest.h>

#include "gui/text_order.h"

namespace probewarp {
namespace {

TEST(TextOrder, LeftToRightStaysAsItIs) {
    for (const char* text : {"", "plain.png", "Grüße – Жук.png", "写真 한국어 ภาพ.png", "चित्र.png"})
        EXPECT_EQ(visual_order(text), text);
}

TEST(TextOrder, HebrewIsTurnedRoundAndTheEndingStays) {
    EXPECT_EQ(visual_order("\u05D0\u05D1\u05D2.png"), "\u05D2\u05D1\u05D0.png");
    EXPECT_EQ(visual_order("a \u05D0\u05D1 12.png"), "a 12 \u05D1\u05D0.png")
        << "numbers keep their digits' order";
}

TEST(TextOrder, ArabicLettersJoin) {
    // Two times beh: its initial form stands at the right, its final one at the left.
    EXPECT_EQ(visual_order("\u0628\u0628"), "\uFE90\uFE91");
    // Lam and alef become one sign.
    EXPECT_EQ(visual_order("\u0644\u0627"), "\uFEFB");
}

}  // namespace
}  // namespace probewarp
