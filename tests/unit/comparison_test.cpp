// Two blends side by side: the divider is dragged, the other side is only looked at.
#include "editor/comparison.h"

#include "editor_fixture.h"

namespace probewarp {
namespace {

struct ComparisonTest : testing::EditorTest {
    /// The canvas is 900 pixels wide, so the divider begins at 450.
    void SetUp() override {
        EditorTest::SetUp();
        open_with({probe_at({100, 150}, {100, 150}), probe_at({300, 150}, {310, 150}, 2.5)});
        refresh(editor);
    }
};

TEST_F(ComparisonTest, TheMenuTurnsItOnAndOffAndTakesAnotherBlendThanTheDocuments) {
    EXPECT_FALSE(divider(editor));
    press_key(editor, {'2'});
    ASSERT_TRUE(editor.comparison);
    EXPECT_EQ(editor.comparison->blend, "linear");
    EXPECT_EQ(divider(editor), 450);
    press_key(editor, {'2'});
    EXPECT_FALSE(editor.comparison);
    editor.document.blend = "linear";
    press_key(editor, {'2'});
    EXPECT_EQ(editor.comparison->blend, "dlb");
    EXPECT_EQ(steps(), 0u);  // it is no step of the history
}

TEST_F(ComparisonTest, PositionsAreTheOtherBlendsOfTheSamePose) {
    compare_with(editor, "spiral");
    const std::vector<glm::vec2> other(compared_positions(editor).begin(), compared_positions(editor).end());
    EXPECT_NE(other, editor.deformation.now);
    Document document = editor.document;
    document.blend = "spiral";
    Deformation alone;
    update(alone, document);
    EXPECT_EQ(other, alone.now);
    // ... and follow the pose, and the choice.
    editor.document.probes[1].now.x += 20;
    refresh(editor);
    EXPECT_NE(std::vector<glm::vec2>(compared_positions(editor).begin(), compared_positions(editor).end()),
              other);
    compare_with(editor, editor.document.blend);
    EXPECT_EQ(std::vector<glm::vec2>(compared_positions(editor).begin(), compared_positions(editor).end()),
              editor.deformation.now);
}

TEST_F(ComparisonTest, TheDividerIsDraggedWithinTheCanvasAndEscapePutsItBack) {
    compare_with(editor, "linear");
    drag({{452, 600}, {600, 620}});
    EXPECT_EQ(divider(editor), 600);
    EXPECT_TRUE(is_compared(editor, {600, 0}));
    EXPECT_FALSE(is_compared(editor, {599, 0}));
    drag({{600, 600}, {2000, 600}});
    EXPECT_EQ(divider(editor), 900 - 24);
    drag({{876, 600}, {-50, 600}});
    EXPECT_EQ(divider(editor), 24);
    press(editor, {{24, 600}});
    move(editor, {{300, 600}});
    EXPECT_EQ(divider(editor), 300);
    cancel(editor);
    EXPECT_EQ(divider(editor), 24);
    EXPECT_EQ(steps(), 0u);
    drag({{31, 600}, {300, 600}});  // 7 pixels beside it: pans instead
    EXPECT_EQ(divider(editor), 24);
    // The choice of another blend leaves it where it is.
    compare_with(editor, "spiral");
    EXPECT_EQ(divider(editor), 24);
}

TEST_F(ComparisonTest, TheOtherSideIsOnlyLookedAt) {
    compare_with(editor, "linear");
    const Document before = editor.document;
    for (const char* tool : {"add", "brush", "pin"}) {
        choose_tool(editor, find_tool(tool));
        press(editor, {{700, 200}});
        release(editor, {{700, 200}});
        EXPECT_EQ(take_notice(), "This side only compares: work on the picture at the left of the divider.")
            << tool;
        EXPECT_EQ(editor.document, before) << tool;
    }
    choose_tool(editor, find_tool("select"));
    double_click(editor, {{700, 200}});
    EXPECT_NE(take_notice(), "");
    EXPECT_EQ(editor.document, before);
    double_click(editor, {{200, 200}});
    EXPECT_EQ(take_notice(), "");
    EXPECT_EQ(editor.document.probes.size(), 3u);
}

TEST_F(ComparisonTest, ProbesAreDraggedOnBothSides) {
    compare_with(editor, "linear");
    const glm::dvec2 at = on_canvas(probe(1).now);  // 670, 340
    drag({at, at + glm::dvec2(20, 0)});
    EXPECT_DOUBLE_EQ(probe(1).now.x, 320);
    EXPECT_EQ(steps(), 1u);
}

}  // namespace
}  // namespace probewarp
