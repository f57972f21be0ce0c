// The table of commands: keys that do not clash, reasons for what cannot be used, and what each of them does.
#include "editor/commands.h"

#include <set>

#include "editor_fixture.h"
#include "generators.h"

namespace probewarp {
namespace {

using testing::degrees;
using testing::distance;
using testing::EditorTest;
using testing::expect_always;
using testing::real;

TEST(Commands, EveryKeyMeansOneThing) {
    std::vector<Shortcut> keys{{key_escape},
                               {key_left},
                               {key_right},
                               {key_up},
                               {key_down},
                               {key_left, false, true},
                               {key_right, false, true},
                               {key_up, false, true},
                               {key_down, false, true}};
    for (const Command& command : commands())
        if (command.shortcut.key != 0) keys.push_back(command.shortcut);
    for (const Alias& alias : aliases()) keys.push_back(alias.key);
    for (const Tool& tool : tools()) keys.push_back({tool.key});
    for (std::size_t i = 0; i < keys.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) EXPECT_NE(keys[i], keys[j]) << to_text(keys[i]);
}

TEST(Commands, LabelsAreUniqueAndFound) {
    std::set<std::string_view> labels;
    for (const Command& command : commands()) {
        EXPECT_TRUE(labels.insert(command.label).second) << command.label;
        EXPECT_EQ(&find_command(command.label), &command);
        EXPECT_FALSE(command.menu.empty());
    }
    for (const Alias& alias : aliases()) EXPECT_TRUE(labels.contains(alias.label)) << alias.label;
}

TEST(Commands, KeysAreWrittenAsPeopleDo) {
    EXPECT_EQ(to_text({'S', true, true}), "Ctrl+Shift+S");
    EXPECT_EQ(to_text({'F'}), "F");
    EXPECT_EQ(to_text({key_delete}), "Del");
    EXPECT_EQ(to_text({}), "");
}

struct CommandsTest : EditorTest {
    void run(std::string_view label) { probewarp::run(editor, find_command(label)); }

    /// Runs every command that cannot be used: each must say why, and do nothing. Returns how many there
    /// were.
    int expect_reasons() {
        int disabled = 0;
        for (const Command& command : commands()) {
            const std::string why_not = command.why_not ? command.why_not(editor) : "";
            if (why_not.empty()) continue;
            ++disabled;
            const Editor before = editor;
            probewarp::run(editor, command);
            EXPECT_EQ(take_notice(), why_not + ".") << command.label;
            EXPECT_EQ(editor.document, before.document) << command.label;
            EXPECT_EQ(editor.history.steps.size(), before.history.steps.size()) << command.label;
            EXPECT_EQ(editor.history.at, before.history.at) << command.label;
            EXPECT_EQ(editor.selected, before.selected) << command.label;
            EXPECT_EQ(editor.requests, before.requests) << command.label;
            EXPECT_EQ(editor.view.zoom, before.view.zoom) << command.label;
            EXPECT_EQ(editor.view.corner, before.view.corner) << command.label;
            EXPECT_EQ(editor.fit_wanted, before.fit_wanted) << command.label;
        }
        return disabled;
    }
};

TEST_F(CommandsTest, WhatCannotBeUsedSaysWhy) {
    open_with({probe_at({100, 80}, {100, 80})});
    EXPECT_GT(expect_reasons(), 5);  // undo, redo, and what needs a chosen or a moved probe
    editor.selected = 1;
    EXPECT_EQ(expect_reasons(), 12);  // undo, redo, reset the pose, and nine that need paint
    probe().locked = true;
    EXPECT_EQ(expect_reasons(), 18);  // and deleting it, putting it back, and four that paint
    probe().now.x += 1;
    EXPECT_EQ(expect_reasons(), 18);  // still: what has moved is locked
    editor = Editor();
    EXPECT_GT(expect_reasons(), 15);
}

TEST_F(CommandsTest, WhatNeedsTheWindowAsksForIt) {
    const std::pair<Shortcut, Request> asked[] = {
        {{'N', true}, Request::new_document},   {{'O', true}, Request::open},
        {{'S', true}, Request::save},           {{'S', true, true}, Request::save_as},
        {{'E', true}, Request::export_picture}, {{'Q', true}, Request::quit}};
    for (const auto& [key, request] : asked) {
        editor.requests.clear();
        EXPECT_TRUE(press_key(editor, key));
        EXPECT_EQ(editor.requests, std::vector{request}) << to_text(key);
    }
    editor.requests.clear();
    for (const char* label : {"Import probes (CSV)…", "Replace picture…", "Light theme", "About Probewarp"})
        run(label);
    EXPECT_EQ(editor.requests, (std::vector{Request::import_probes, Request::replace_picture,
                                            Request::switch_theme, Request::about}));
}

TEST_F(CommandsTest, DeleteUndoAndRedo) {
    open_with({probe_at({100, 80}, {120, 80}, 1), probe_at({300, 80}, {300, 80})});
    const Document before = editor.document;
    for (const Shortcut key : {Shortcut{key_delete}, Shortcut{key_backspace}}) {
        editor.selected = 1;
        EXPECT_TRUE(press_key(editor, key));
        ASSERT_EQ(editor.document.probes.size(), 1u);
        EXPECT_EQ(probe().id, 2);
        EXPECT_EQ(editor.selected, 0);
        EXPECT_EQ(steps(), 1u);
        press_key(editor, {'Z', true});
        EXPECT_EQ(editor.document, before);
        press_key(editor, {'Z', true, true});
        EXPECT_EQ(editor.document.probes.size(), 1u);
        press_key(editor, {'Z', true});
        press_key(editor, {'Y', true});
        EXPECT_EQ(editor.document.probes.size(), 1u);
        press_key(editor, {'Z', true});
    }
    editor.selected = 2;
    press_key(editor, {'D', true});
    EXPECT_NE(editor.selected, 2);
    press_key(editor, {'Z', true});
    EXPECT_EQ(editor.selected, 0);  // the chosen one is gone with the step
}

TEST_F(CommandsTest, ADuplicateStandsBesideItsOriginalInTheSamePose) {
    open_with({probe_at({100, 80}, {120, 90}, 7, 40)});
    editor.selected = 1;
    run("Duplicate");
    ASSERT_EQ(editor.document.probes.size(), 2u);
    EXPECT_EQ(editor.selected, probe(1).id);
    EXPECT_NE(probe(1).id, probe(0).id);
    EXPECT_EQ(probe(1).now - probe(1).rest, probe(0).now - probe(0).rest);
    EXPECT_EQ(probe(1).angle, 7);
    EXPECT_EQ(probe(1).radius, 40);
    EXPECT_NE(probe(1).rest, probe(0).rest);
    EXPECT_EQ(steps(), 1u);
}

TEST_F(CommandsTest, LockAndUnlock) {
    open_with({probe_at({100, 80}, {100, 80})});
    editor.selected = 1;
    const Command& lock = find_command("Lock");
    EXPECT_FALSE(lock.on(editor));
    press_key(editor, {'L', true});
    EXPECT_TRUE(probe().locked && lock.on(editor));
    press_key(editor, {'L', true});
    EXPECT_FALSE(probe().locked || lock.on(editor));
    EXPECT_EQ(steps(), 2u);
}

TEST_F(CommandsTest, ALockedProbeIsKeptFromTheHand) {
    open_with({probe_at({100, 80}, {120, 80}, 1), probe_at({300, 80}, {310, 80})});
    probe().name = "Head";
    probe().locked = true;
    commit(editor, "Lock");
    const Document before = editor.document;
    editor.selected = 1;
    for (const Shortcut key : {Shortcut{key_delete}, Shortcut{key_backspace}, Shortcut{key_left},
                               Shortcut{key_down, false, true}, Shortcut{'R', true}}) {
        EXPECT_TRUE(press_key(editor, key));
        EXPECT_EQ(take_notice(), "Head is locked; unlock it first.") << to_text(key);
        EXPECT_EQ(editor.document, before);
    }
    EXPECT_EQ(editor.selected, 1);
    EXPECT_EQ(steps(), 1u);
    press_key(editor, {'L', true});
    press_key(editor, {key_delete});
    ASSERT_EQ(editor.document.probes.size(), 1u);
    EXPECT_EQ(probe().id, 2);
}

TEST_F(CommandsTest, WhatLockedProbesKeepIsSaid) {
    open_with({probe_at({100, 80}, {120, 90}), probe_at({200, 80}, {220, 90}), probe_at({300, 80}, {300, 80}),
               probe_at({50, 80}, {60, 80})});
    probe(0).name = "Head";
    probe(0).locked = probe(2).locked = true;  // the third has not moved: it keeps nothing
    commit(editor, "Lock");
    run("Reset the pose of all");
    EXPECT_EQ(take_notice(), "Head is locked and stays as it is.");
    EXPECT_EQ(probe(0).now, glm::dvec2(120, 90));
    EXPECT_TRUE(at_rest(probe(1)));
    undo_step(editor);
    probe(1).locked = true;
    commit(editor, "Lock");
    run("Reset the pose of all");
    EXPECT_EQ(take_notice(), "2 locked probes stay as they are.");
    EXPECT_TRUE(at_rest(probe(3)));
}

TEST_F(CommandsTest, BackToRest) {
    open_with({probe_at({100, 80}, {120, 90}, 7), probe_at({200, 80}, {220, 90}, 1),
               probe_at({300, 80}, {320, 90}, 2)});
    probe(2).locked = true;
    commit(editor, "Lock");
    editor.selected = 1;
    press_key(editor, {'R', true});
    EXPECT_TRUE(at_rest(probe(0)));
    EXPECT_FALSE(at_rest(probe(1)));
    press_key(editor, {'R', true});  // again: nothing happens, and no step says so
    EXPECT_EQ(steps(), 2u);
    press_key(editor, {'R', true, true});
    EXPECT_TRUE(at_rest(probe(1)));
    EXPECT_FALSE(at_rest(probe(2)));
    EXPECT_EQ(steps(), 3u);
}

TEST_F(CommandsTest, ArrowsNudgeByOneAndByTen) {
    open_with({probe_at({100, 80}, {100, 80})});
    press_key(editor, {key_left});  // no probe is chosen
    EXPECT_EQ(steps(), 0u);
    editor.selected = 1;
    for (const int key : {key_right, key_right, key_down, key_left}) press_key(editor, {key});
    EXPECT_EQ(probe().now, glm::dvec2(101, 81));
    for (const int key : {key_up, key_right, key_right, key_down, key_down, key_left})
        press_key(editor, {key, false, true});
    EXPECT_EQ(probe().now, glm::dvec2(111, 91));
    EXPECT_EQ(steps(), 10u);
}

TEST_F(CommandsTest, AHeldArrowIsOneStep) {
    open_with({probe_at({100, 80}, {100, 80}), probe_at({200, 80}, {200, 80})});
    editor.selected = 1;
    press_key(editor, {key_right});
    for (int k = 0; k < 20; ++k) press_key(editor, {key_right}, true);
    EXPECT_EQ(probe().now, glm::dvec2(121, 80));
    EXPECT_EQ(steps(), 1u);
    press_key(editor, {key_down});  // let go, and pressed anew
    press_key(editor, {key_down, false, true}, true);
    EXPECT_EQ(probe().now, glm::dvec2(121, 91));
    EXPECT_EQ(steps(), 2u);
    undo_step(editor);
    EXPECT_EQ(probe().now, glm::dvec2(121, 80));
    undo_step(editor);
    EXPECT_EQ(probe().now, glm::dvec2(100, 80));
}

TEST_F(CommandsTest, AHeldArrowChangesNoOtherStep) {
    open_with({probe_at({100, 80}, {100, 80}), probe_at({200, 80}, {200, 80})});
    editor.selected = 1;
    press_key(editor, {key_right}, true);  // a key that was held before: there is no step to go on with
    EXPECT_EQ(steps(), 1u);
    run("Duplicate");
    editor.selected = 1;
    press_key(editor, {key_right}, true);  // something else was done meanwhile
    EXPECT_EQ(steps(), 3u);
    editor.selected = 2;
    press_key(editor, {key_right}, true);  // another probe
    EXPECT_EQ(steps(), 4u);
    undo_step(editor);
    press_key(editor, {key_left}, true);  // undone: the present step is not the nudge's
    EXPECT_EQ(editor.history.at, 4u);
    press_key(editor, {key_right}, true);  // there and back is no step
    EXPECT_EQ(editor.history.at, 3u);
    press_key(editor, {key_left}, true);
    EXPECT_EQ(editor.history.at, 4u);
}

TEST_F(CommandsTest, WhatWasSavedUnderAHeldArrowIsNotSavedAnyMore) {
    open_with({probe_at({100, 80}, {100, 80})});
    editor.selected = 1;
    press_key(editor, {key_right});
    editor.history.saved = editor.history.at;
    press_key(editor, {key_right}, true);
    EXPECT_FALSE(is_saved(editor.history));
}

TEST_F(CommandsTest, AHundredPerCentIsExactlyThat) {
    expect_always("from every zoom", [this] {
        editor.view = {{*real(-500, 500), *real(-500, 500)}, std::pow(10, *real(-2, 1.8))};
        press_key(editor, {'1'});
        RC_ASSERT(editor.view.zoom == 1);
        // ... and on whole pixels, or the picture would be blurred.
        RC_ASSERT(editor.view.corner.x == std::round(editor.view.corner.x));
        RC_ASSERT(editor.view.corner.y == std::round(editor.view.corner.y));
    });
}

TEST_F(CommandsTest, ZoomingKeepsTheMiddleAndFittingShowsAll) {
    const glm::dvec2 middle = editor.canvas_size / 2.0, under = to_image(editor.view, middle);
    press_key(editor, {'='});
    EXPECT_EQ(editor.view.zoom, 3);
    EXPECT_LT(distance(to_image(editor.view, middle), under), 1e-10);  // roundings of numbers up to 1000
    press_key(editor, {'-'});
    EXPECT_NEAR(editor.view.zoom, 2, 1e-12);
    for (const char key : {'F', '0'}) {
        editor.view = {{-5000, 70}, 9};
        press_key(editor, {key});
        resize_canvas(editor, {300, 260}, 1);
        const glm::dvec2 top_left = on_canvas({0, 0}), bottom_right = on_canvas({400, 300});
        EXPECT_TRUE(top_left.x >= 0 && top_left.y >= 0 && bottom_right.x <= 300 && bottom_right.y <= 260);
        EXPECT_NEAR(top_left.x, 300 - bottom_right.x, 1);  // centred but for the rounding to whole pixels
        EXPECT_NEAR(top_left.y, 260 - bottom_right.y, 1);
        press_key(editor, {'='});  // from here on the view is the person's
        const CanvasView own = editor.view;
        resize_canvas(editor, {700, 600}, 1);
        EXPECT_EQ(editor.view.zoom, own.zoom);
    }
}

TEST_F(CommandsTest, SwitchesAndTools) {
    for (const Tool& tool : tools()) {
        EXPECT_TRUE(press_key(editor, {tool.key}));
        EXPECT_EQ(editor.tool, &tool);
        EXPECT_EQ(&find_tool(tool.name), &tool);
    }
    press_key(editor, {'H'});
    EXPECT_FALSE(editor.show_probes || find_command("Show probes").on(editor));
    press_key(editor, {'M'});
    EXPECT_TRUE(editor.show_mesh && find_command("Show mesh").on(editor));
    press_key(editor, {'W'});
    EXPECT_EQ(editor.shown_weights, ShownWeights::chosen);
    press_key(editor, {'W', false, true});
    EXPECT_EQ(editor.shown_weights, ShownWeights::all);
    press_key(editor, {'W', false, true});
    EXPECT_EQ(editor.shown_weights, ShownWeights::none);
    EXPECT_FALSE(press_key(editor, {'J'}));
    EXPECT_FALSE(press_key(editor, {'J', true}));
}

TEST_F(CommandsTest, OneOfThreeChoicesSaysWhoDeforms) {
    const std::vector<std::pair<const char*, DeformBy>> choices{
        {"Deform by the graphics card", DeformBy::shader},
        {"Deform by the processor", DeformBy::processor},
        {"Deform by whichever is quicker", DeformBy::automatic}};
    EXPECT_EQ(editor.deform_by, DeformBy::automatic);
    for (const auto& [label, by] : choices) {
        probewarp::run(editor, find_command(label));
        EXPECT_EQ(editor.deform_by, by);
        for (const auto& [other, ignored] : choices)
            EXPECT_EQ(find_command(other).on(editor), std::string_view(other) == label) << other;
    }
}

TEST_F(CommandsTest, NothingRunsWhileSomethingIsDragged) {
    open_with({probe_at({100, 80}, {120, 80})});
    press(editor, {.at = on_canvas({120, 80})});
    const Document before = editor.document;
    const Tool* tool = editor.tool;
    for (const Command& command : commands()) probewarp::run(editor, command);
    for (const Tool& other : tools()) press_key(editor, {other.key});
    press_key(editor, {key_left});
    EXPECT_TRUE(editor.gesture);
    EXPECT_EQ(editor.document, before);
    EXPECT_TRUE(editor.requests.empty());
    EXPECT_TRUE(editor.show_probes);
    EXPECT_EQ(editor.tool, tool);
    EXPECT_EQ(steps(), 0u);
}

}  // namespace
}  // namespace probewarp
