// Shortcuts on keyboards of several countries.
#include "editor/keys.h"

#include <gtest/gtest.h>

namespace probewarp {

namespace {

LayoutKey latin(int position, char32_t label) { return {position, label, true}; }
LayoutKey other(int position, char32_t label) { return {position, label, false}; }

Shortcut ctrl(int key, bool shift = false) { return {key, true, shift}; }

}  // namespace

TEST(Keys, WithCtrlTheLabelCounts) {
    EXPECT_EQ(shortcut_of_key(latin('Z', 'z'), true, false), ctrl('Z'));       // US
    EXPECT_EQ(shortcut_of_key(latin('Y', 'z'), true, true), ctrl('Z', true));  // German
    EXPECT_EQ(shortcut_of_key(latin('W', 'z'), true, false), ctrl('Z'));       // French
    EXPECT_EQ(shortcut_of_key(latin('/', 'z'), true, false), ctrl('Z'));       // Dvorak
    EXPECT_EQ(shortcut_of_key(latin('Z', ';'), true, false), ctrl(';'));       // Dvorak
    EXPECT_EQ(shortcut_of_key(latin('I', U'ı'), true, false), ctrl('I'));      // Turkish
    EXPECT_EQ(shortcut_of_key(latin('1', '&'), true, false), ctrl('1'));       // French
    EXPECT_EQ(shortcut_of_key(latin('1', '7'), true, false), ctrl('7'));
    EXPECT_EQ(shortcut_of_key(latin('S', 0), true, false), ctrl('S'));
}

TEST(Keys, WithoutLatinLettersTheUsPlaceCounts) {
    EXPECT_EQ(shortcut_of_key(other('Z', U'я'), true, false), ctrl('Z'));  // Russian
    EXPECT_EQ(shortcut_of_key(other('Z', U'ζ'), true, false), ctrl('Z'));  // Greek
    EXPECT_EQ(shortcut_of_key(other('Q', '/'), true, false), ctrl('Q'));   // Hebrew
    EXPECT_EQ(shortcut_of_character(U'ц', other('W', U'ц'), false), Shortcut{'W'});
    EXPECT_EQ(shortcut_of_character(U'Ц', other('W', U'ц'), true), (Shortcut{'W', false, true}));
    EXPECT_EQ(shortcut_of_character('\'', other('W', '\''), false), Shortcut{'W'});  // Hebrew
    EXPECT_EQ(shortcut_of_character(U'х', other('[', U'х'), false), Shortcut{'['});
    EXPECT_EQ(shortcut_of_character('2', other('2', '2'), false), Shortcut{'2'});
    EXPECT_EQ(shortcut_of_character('.', other('/', '.'), false), Shortcut{'.'});
    EXPECT_EQ(shortcut_of_character(U'۲', other('2', U'۲'), false), Shortcut{'2'});  // Persian
    EXPECT_EQ(shortcut_of_character(U'я', other(key_left, 0), false), Shortcut{});
}

TEST(Keys, DigitsAndSignsAreWhatWasTyped) {
    EXPECT_EQ(shortcut_of_character('[', latin('8', '8'), false), Shortcut{'['});  // German, with AltGr
    EXPECT_EQ(shortcut_of_character('2', latin('2', U'é'), true), Shortcut{'2'});  // French, with Shift
    EXPECT_EQ(shortcut_of_character('=', latin('0', '0'), true), Shortcut{'='});   // German, with Shift
    EXPECT_EQ(shortcut_of_character('-', latin('/', '-'), false), Shortcut{'-'});  // German
    EXPECT_EQ(shortcut_of_character('+', latin('=', '='), true), Shortcut{'+'});
    EXPECT_EQ(shortcut_of_character('&', latin('1', '&'), false), Shortcut{'&'});
    EXPECT_EQ(shortcut_of_character(U'ü', latin('[', U'ü'), false), Shortcut{});  // no bracket of a German
    EXPECT_EQ(shortcut_of_character(U'é', latin('2', U'é'), false), Shortcut{});
    EXPECT_EQ(shortcut_of_character(' ', latin(' ', ' '), false), Shortcut{});
}

TEST(Keys, LettersCountWithShiftButNotWithCapsLock) {
    EXPECT_EQ(shortcut_of_character('w', latin('W', 'w'), false), Shortcut{'W'});
    EXPECT_EQ(shortcut_of_character('W', latin('W', 'w'), true), (Shortcut{'W', false, true}));
    EXPECT_EQ(shortcut_of_character('W', latin('W', 'w'), false), Shortcut{'W'});
    EXPECT_EQ(shortcut_of_character('w', latin('W', 'w'), true), (Shortcut{'W', false, true}));
    EXPECT_EQ(shortcut_of_character('m', latin(';', 'm'), false), Shortcut{'M'});  // French
}

TEST(Keys, KeysThatWriteNothingAreThemselves) {
    for (const bool shift : {false, true})
        for (const int key : {key_left, key_escape, key_delete, key_backspace})
            EXPECT_EQ(shortcut_of_key(latin(key, 0), false, shift), (Shortcut{key, false, shift}));
}

TEST(Keys, LayoutsAreLatinByTheirLetters) {
    std::array<char32_t, 26> labels{};
    EXPECT_FALSE(writes_latin(labels));
    for (std::size_t i = 0; i < 26; ++i) labels[i] = char32_t('a' + i);
    EXPECT_TRUE(writes_latin(labels));
    for (const std::size_t i : {4u, 16u, 22u, 25u}) labels[i] = '\'';  // Dvorak has signs on four of them
    EXPECT_TRUE(writes_latin(labels));
    for (std::size_t i = 0; i < 26; ++i) labels[i] = char32_t(0x430 + i);
    EXPECT_FALSE(writes_latin(labels));
}

}  // namespace probewarp
