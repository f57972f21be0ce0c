// Numbers as people type and paste them.
#include "editor/number_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace probewarp {

namespace {

struct Case {
    const char* text;
    double value;
    NumberUnit unit = NumberUnit::none;
};

void expect_numbers(std::initializer_list<Case> cases) {
    for (const Case& c : cases) {
        const auto value = parse_number(c.text, c.unit);
        ASSERT_TRUE(value) << c.text;
        EXPECT_DOUBLE_EQ(*value, c.value) << c.text;
    }
}

void expect_none(std::initializer_list<const char*> texts, NumberUnit unit = NumberUnit::none) {
    for (const char* text : texts) EXPECT_FALSE(parse_number(text, unit)) << text;
}

void expect_pairs(std::initializer_list<const char*> texts, double first, double second,
                  NumberUnit unit = NumberUnit::none) {
    for (const char* text : texts) {
        const auto pair = parse_pair(text, unit);
        ASSERT_TRUE(pair) << text;
        EXPECT_DOUBLE_EQ((*pair)[0], first) << text;
        EXPECT_DOUBLE_EQ((*pair)[1], second) << text;
    }
}

}  // namespace

TEST(NumberText, IsDigitsWithASignAndAnExponent) {
    expect_numbers({{"0", 0},
                    {"300", 300},
                    {" 12 ", 12},
                    {"-7", -7},
                    {"+7", 7},
                    {"- 7", -7},
                    {"007", 7},
                    {"1e3", 1000},
                    {"2.5E-1", 0.25},
                    {"1e+2", 100},
                    {".5", 0.5},
                    {"5.", 5},
                    {"-.5", -0.5}});
}

TEST(NumberText, OneCommaOrPointIsDecimal) {
    expect_numbers({{"600.5", 600.5},
                    {"600,5", 600.5},
                    {"12,25", 12.25},
                    {"1,234", 1.234},
                    {"1.234", 1.234},
                    {"0,001", 0.001},
                    {",5", 0.5},
                    {"5,", 5},
                    {"-600,5", -600.5}});
}

TEST(NumberText, TheLastOfCommaAndPointIsDecimalAndTheOtherGroups) {
    expect_numbers({{"1,234.5", 1234.5},
                    {"1.234,5", 1234.5},
                    {"12,345,678.25", 12345678.25},
                    {"12.345.678,25", 12345678.25},
                    {"1,234,567", 1234567},
                    {"1.234.567", 1234567},
                    {"1 234,5", 1234.5},
                    {"1 234.5", 1234.5},
                    {"1 234 567", 1234567},
                    {"1'234.5", 1234.5},
                    {"1’234,5", 1234.5},
                    {"1\u00a0234,5", 1234.5},
                    {"1\u202f234,5", 1234.5},
                    {"1\u2009234.5", 1234.5}});
    expect_none({"1,23.5", "12,34,567", "1234,567,890", "1.2.3", "1,2,3", "1 23", "12 3456", "1 2",
                 "1'234 567", "1.5,000.5", "1,234.5.6", "1 234 5", "1,,2", "1..2", "0.123,456.7",
                 "1.234 567"});
}

TEST(NumberText, IsASum) {
    expect_numbers({{"100+20", 120},
                    {"1024/3", 1024.0 / 3},
                    {"2*3+4", 10},
                    {"2+3*4", 14},
                    {"(2+3)*4", 20},
                    {"10-3-2", 5},
                    {"100/10/2", 5},
                    {"2*-3", -6},
                    {"--3", 3},
                    {"-(2+3)", -5},
                    {" 1 + 2 ", 3},
                    {"600,5 + 0,25", 600.75},
                    {"1.234,5*2", 2469},
                    {"((((7))))", 7},
                    {"10 - -5", 15},
                    {"3-+2", 1}});
    expect_none({"1+", "*2", "/2", "(", ")", "(1", "1)", "()", "1(2)", "(1)(2)", "2 3 +", "1+*2", "1^2",
                 "1//2", "2 % 3"});
}

TEST(NumberText, UnderstandsTypographicSigns) {
    expect_numbers({{"\u221212", -12},
                    {"\u201312", -12},
                    {"\u201012", -12},
                    {"20 \u2212 5", 15},
                    {"3 × 4", 12},
                    {"3·4", 12},
                    {"12 ÷ 4", 3},
                    {"12\u20444", 3},
                    {"\uff11\uff12\uff0e\uff15", 12.5},
                    {"\u200e\u221212\u202c", -12},
                    {"\ufeff12", 12},
                    {"\u00a012\u202f", 12}});
}

TEST(NumberText, UnderstandsTheFieldsUnitAndNoOther) {
    using enum NumberUnit;
    expect_numbers({{"12px", 12, pixels},
                    {"12 px", 12, pixels},
                    {"12\u202fPX", 12, pixels},
                    {"100px+20px", 120, pixels},
                    {"(1+2) px", 3, pixels},
                    {"1 pixel", 1, pixels},
                    {"600,5 pixels", 600.5, pixels},
                    {"45°", 45, degrees},
                    {"45 deg", 45, degrees},
                    {"\u221245\u00a0°", -45, degrees},
                    {"90 degrees/2", 45, degrees},
                    {"1 degree", 1, degrees},
                    {"50%", 50, percent},
                    {"50 %", 50, percent},
                    {"50 % * 2", 100, percent},
                    {"2×", 2, times},
                    {"2 x", 2, times},
                    {"1,5\u00a0×", 1.5, times},
                    {"2 × 3", 6, times},
                    {"2× × 3×", 6, times},
                    {"2 ×+ 3", 5, times}});
    expect_none({"12 cm", "12°", "12 %", "12 p", "12 pxx", "12 px 3", "px", "px 12"}, pixels);
    expect_none({"45px", "45 %", "45 d", "45 rad"}, degrees);
    expect_none({"12px", "12°", "12%", "12×"});
}

TEST(NumberText, CountsWholeTurns) {
    using enum NumberUnit;
    expect_numbers({{"1 × + 90.0 °", 450, degrees},
                    {"1 × + 90", 450, degrees},
                    {"-1 × + -90.0 °", -450, degrees},
                    {"2×+0", 720, degrees},
                    {"2 × 45", 90, degrees}});
}

TEST(NumberText, RefusesWhatIsNoNumber) {
    expect_none({"",
                 " ",
                 "abc",
                 "12abc",
                 "nan",
                 "inf",
                 "-inf",
                 "infinity",
                 "0x10",
                 "1e",
                 "e5",
                 "1e5.5",
                 ".",
                 ",",
                 "-",
                 "+",
                 "--",
                 "#",
                 "12 #",
                 "1\t2",
                 "1\n2",
                 "½",
                 "\xff",
                 "1\xc3",
                 "\xe2\x88"
                 "12",
                 "1_000"});
}

TEST(NumberText, RefusesWhatIsNotFinite) {
    expect_none({"1/0", "0/0", "1/(2-2)", "1e999", "-1e999", "1e308*10", "1e308+1e308", "1/(1e308*1e308)",
                 "1e-9999"});
}

TEST(NumberText, HostileTextIsRefusedAtOnce) {
    EXPECT_TRUE(parse_number(std::string(60, '(') + "1" + std::string(60, ')')));
    EXPECT_FALSE(parse_number(std::string(65, '(') + "1" + std::string(65, ')')));
    EXPECT_FALSE(parse_number(std::string(max_number_text, '(')));
    EXPECT_TRUE(parse_number(std::string(max_number_text - 1, '-') + "1"));
    EXPECT_TRUE(parse_number(std::string(max_number_text, '0')));
    EXPECT_FALSE(parse_number(std::string(max_number_text + 1, '0')));
    EXPECT_FALSE(parse_number(std::string(1 << 20, '1')));
    EXPECT_FALSE(parse_pair(std::string(1 << 20, ',')));
    EXPECT_FALSE(is_unfinished_number(std::string(1 << 20, '(')));
    std::mt19937 random(1);
    const std::string signs = "0123456789.,' ()+-*/e%px;\t\xc3\x97\xe2\x88\x92";
    for (int k = 0; k < 20000; ++k) {
        std::string text;
        for (auto left = random() % 24; left > 0; --left) text += signs[random() % signs.size()];
        EXPECT_TRUE(std::isfinite(parse_number(text, NumberUnit::percent).value_or(0))) << text;
        parse_pair(text, NumberUnit::times);
        is_unfinished_number(text);
    }
}

TEST(NumberText, PairsAreSeparatedAsTheyAreCopied) {
    expect_pairs({"210.5\t77.25", "210,5\t77,25", "210.5\t77.25\r\n", "210.5\n77.25\n", "210.5\r77.25",
                  "210.5; 77.25", "210,5;77,25", "210.5, 77.25", "210,5, 77,25", "210.5,77.25", "210.5 77.25",
                  "210,5  77,25", "(210.5, 77.25)", "[210.5; 77.25]", "{ 210.5 77.25 }", "210,5,77,25",
                  " 210.5 ,  77.25 ", "200+10.5; 154.5/2"},
                 210.5, 77.25);
    expect_pairs({"210.5 px, 77.25 px", "210.5px\t77.25"}, 210.5, 77.25, NumberUnit::pixels);
    expect_pairs({"\u221212;\u22125", "-12, -5", "(-12 ; -5)"}, -12, -5);
    expect_pairs({"210, 77", "210 77", "210;77"}, 210, 77);
    expect_pairs({"1.234,5; 2", "1,234.5; 2", "1 234,5\t2"}, 1234.5, 2);
}

TEST(NumberText, RefusesWhatAreNotTwoNumbers) {
    for (const char* text : {"", "1", "1;", ";1", "1;2;3", "1,2,3", "1, 2, 3", "1 2 3", "a;b", "1;b",
                             "1\t\t2", "1/0; 2", "(1; 2", "x=1, y=2", "(1),(2"})
        EXPECT_FALSE(parse_pair(text)) << text;
}

TEST(NumberText, KnowsWhatMayGoOn) {
    for (const char* text : {"", " ", "-", "1+", "2 *", "(", "(1+2", "1.", ",", "\u2212", "3 ×"})
        EXPECT_TRUE(is_unfinished_number(text)) << text;
    for (const char* text : {"a", "1a", "12 3", "1)", "1..2"})
        EXPECT_FALSE(is_unfinished_number(text)) << text;
}

}  // namespace probewarp
