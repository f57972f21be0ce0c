// Double-clicks, by times that are handed in.
#include "editor/clicks.h"

#include <gtest/gtest.h>

namespace probewarp {

namespace {

struct ClicksTest : ::testing::Test {
    ClickCounter clicks;

    bool press(double seconds, glm::dvec2 at = {10, 20}, Button button = Button::left, double scale = 1) {
        return is_double_click(clicks, {.at = at, .button = button}, {seconds, seconds}, scale);
    }
};

}  // namespace

TEST_F(ClicksTest, TwoClicksWithinHalfASecondAreADoubleClick) {
    for (const double way : {0.0, 0.05, 0.3, 0.35, 0.4, 0.5}) {
        clicks = {};
        EXPECT_FALSE(press(100));
        EXPECT_TRUE(press(100 + way)) << way;
    }
    clicks = {};
    EXPECT_FALSE(press(100));
    EXPECT_FALSE(press(100.51));
    EXPECT_TRUE(press(100.9));  // the slow one is the first of the next
}

TEST_F(ClicksTest, AThirdClickIsNoDoubleClick) {
    EXPECT_FALSE(press(1));
    EXPECT_TRUE(press(1.1));
    EXPECT_FALSE(press(1.2));
    EXPECT_TRUE(press(1.3));
}

TEST_F(ClicksTest, ClicksBelongTogetherWhereTheyAreInOnePlace) {
    press(1);
    EXPECT_FALSE(press(1.1, {16, 20}));
    EXPECT_TRUE(press(1.2, {18, 23}));
    press(2, {10, 20}, Button::left, 2);
    EXPECT_TRUE(press(2.1, {16, 20}, Button::left, 2));
}

TEST_F(ClicksTest, OnlyTheLeftButtonDoubleClicks) {
    press(1, {10, 20}, Button::right);
    EXPECT_FALSE(press(1.1, {10, 20}, Button::right));
    EXPECT_FALSE(press(1.2));
    EXPECT_FALSE(press(1.3, {10, 20}, Button::middle));
    EXPECT_FALSE(press(1.4));  // another button came between
}

TEST_F(ClicksTest, WhatABusyWindowLearnsLateIsStillADoubleClick) {
    is_double_click(clicks, {}, {0.9, 1}, 1);
    EXPECT_TRUE(is_double_click(clicks, {}, {1.45, 1.7}, 1));  // between 0.45 and 0.8 seconds later
    is_double_click(clicks, {}, {0.9, 1}, 1);
    EXPECT_FALSE(is_double_click(clicks, {}, {1.55, 1.7}, 1));
}

}  // namespace probewarp
