// Painting with the mouse: strokes of the editor as document, history and deformation see them.
#include "editor/painting.h"

#include "editor/paint_commands.h"
#include "editor_fixture.h"
#include "model/paint_ops.h"

namespace probewarp {
namespace {

using testing::blank_document;
using testing::with_alt;
using testing::with_shift;

struct PaintingTest : testing::EditorTest {
    void SetUp() override {
        EditorTest::SetUp();
        open_with({probe_at({100, 150}, {100, 150}), probe_at({300, 150}, {320, 150}),
                   probe_at({200, 40}, {200, 40})});
        editor.selected = 1;
        choose_tool(editor, find_tool("brush"));
        editor.brush.radius = 20;
        editor.brush.hardness = 1;
    }
    /// The paint of a probe at a place of the picture at rest.
    Paint paint_at(std::size_t i, glm::dvec2 point) {
        const PaintPtr& paint = probe(i).paint;
        return paint ? sample(*paint, to_texels(*paint, frame_of(editor.document.picture->image), point))
                     : Paint{};
    }
    void click(glm::dvec2 image_point, PointerEvent like = {}) { drag({on_canvas(image_point)}, like); }
    void run_tasks() {
        for (const Task& task : std::exchange(editor.tasks, {})) {
            editor.document = task.run();
            commit(editor, task.label);
        }
    }
};

TEST_F(PaintingTest, AClickIsADabAndOneStep) {
    click({100, 100});
    EXPECT_EQ(steps(), 1u);
    EXPECT_EQ(editor.history.steps[1].label, "Paint P");
    EXPECT_EQ(paint_at(0, {100, 100}), (Paint{1, 1}));
    EXPECT_EQ(paint_at(0, {118, 100}), (Paint{1, 1}));
    EXPECT_EQ(paint_at(0, {125, 100}), (Paint{}));
    EXPECT_FALSE(probe(1).paint || probe(2).paint);
    refresh(editor);
    const auto at = locate_at_rest(mesh_of(editor.deformation), {100, 100});
    EXPECT_NEAR(shares_at(editor.deformation, *at)[0], 1, 1e-6);  // three floats
}

TEST_F(PaintingTest, AStrokeIsOneStepThatUndoTakesBackWhole) {
    const Document before = editor.document;
    drag({on_canvas({60, 60}), on_canvas({120, 60}), on_canvas({200, 100})});
    EXPECT_EQ(steps(), 1u);
    const Document painted = editor.document;
    for (const double x : {60.0, 90.0, 120.0, 160.0, 200.0})
        EXPECT_EQ(paint_at(0, {x, x < 120 ? 60 : 60 + (x - 120) / 2}).coverage, 1) << x;
    undo_step(editor);
    EXPECT_EQ(editor.document, before);
    redo_step(editor);
    EXPECT_EQ(editor.document, painted);  // the same tiles
}

TEST_F(PaintingTest, EscapeTakesAStrokeBack) {
    const Document before = editor.document;
    press(editor, {.at = on_canvas({100, 100})});
    move(editor, {.at = on_canvas({150, 100})});
    EXPECT_FALSE(editor.document == before);
    cancel(editor);
    EXPECT_EQ(editor.document, before);
    EXPECT_EQ(steps(), 0u);
}

TEST_F(PaintingTest, StrokesFallWhereThePictureIsSeen) {
    probe(0).now = {150, 190};  // the picture under the first probe is elsewhere now
    commit(editor, "move");
    refresh(editor);
    click({150, 190});
    EXPECT_EQ(paint_at(0, {100, 150}), (Paint{1, 1}));
    EXPECT_EQ(paint_at(0, {150, 190}).coverage, 0);
}

TEST_F(PaintingTest, UnderShownWeightsThePictureStandsStillWhileItIsPainted) {
    probe(0).now = {100, 200};
    commit(editor, "move");
    refresh(editor);
    const std::vector<glm::vec2> before = editor.deformation.now;
    press(editor, {.at = on_canvas({200, 150})});
    move(editor, {.at = on_canvas({205, 150})});
    refresh(editor);
    EXPECT_NE(editor.deformation.now, before);
    const auto shown = shown_positions(editor);
    EXPECT_TRUE(std::equal(shown.begin(), shown.end(), before.begin(), before.end()));
    release(editor, {.at = on_canvas({205, 150})});
    EXPECT_EQ(shown_positions(editor).data(), editor.deformation.now.data());
    editor.shown_weights = ShownWeights::none;
    press(editor, {.at = on_canvas({250, 150})});
    EXPECT_EQ(shown_positions(editor).data(), editor.deformation.now.data());
}

TEST_F(PaintingTest, CtrlPaintsTheOppositeAndErasingEverythingLeavesNothing) {
    editor.brush.value = 0.75;
    click({100, 100}, {.ctrl = true});
    EXPECT_NEAR(paint_at(0, {100, 100}).value, 0.25, 1e-5);  // 1/65535
    editor.brush.mode = BrushMode::erase;
    editor.brush.radius = 60;
    click({100, 100});
    EXPECT_EQ(probe(0).paint, nullptr);
}

TEST_F(PaintingTest, AddStartsFromTheShareThatIsSeen) {
    refresh(editor);
    const auto at = locate_at_rest(mesh_of(editor.deformation), {200, 150});
    const double before = shares_at(editor.deformation, *at)[0];
    ASSERT_GT(before, 0.2);
    ASSERT_LT(before, 0.6);
    editor.brush.mode = BrushMode::add;
    editor.brush.value = 0.25;
    click({200, 150});
    EXPECT_NEAR(paint_at(0, {200, 150}).value, before + 0.25, 1e-3);  // a share bent by a cell of 20 pixels
}

TEST_F(PaintingTest, ShiftDragSizesAndKeysSizeAndSetTheStrength) {
    drag({on_canvas({100, 100}), on_canvas({115, 100})}, with_shift());
    EXPECT_NEAR(editor.brush.radius, 35, 1e-9);
    EXPECT_EQ(steps(), 0u);
    press_key(editor, {']'});
    EXPECT_GT(editor.brush.radius, 36);
    press_key(editor, {'['});
    press_key(editor, {'['});
    EXPECT_LT(editor.brush.radius, 35);
    press_key(editor, {'4'});
    EXPECT_EQ(editor.brush.strength, 0.4);
    press_key(editor, {'0'});
    EXPECT_EQ(editor.brush.strength, 1);
    press(editor, {.at = on_canvas({100, 100}), .shift = true});
    move(editor, {.at = on_canvas({140, 100}), .shift = true});
    cancel(editor);
    EXPECT_LT(editor.brush.radius, 35);
}

TEST_F(PaintingTest, MirroredStrokesFallOnTheProbeOfTheOtherSide) {
    editor.mirror = true;  // about x = 200: the first probe's rest falls on the second's
    click({60, 150});
    EXPECT_EQ(paint_at(0, {60, 150}), (Paint{1, 1}));
    EXPECT_EQ(paint_at(0, {340, 150}), (Paint{}));
    EXPECT_EQ(paint_at(1, {340, 150}).coverage, 1);
    EXPECT_EQ(paint_at(1, {60, 150}), (Paint{}));
    editor.selected = 3;  // its own mirror image
    click({160, 40});
    EXPECT_EQ(paint_at(2, {160, 40}).coverage, 1);
    EXPECT_EQ(paint_at(2, {240, 40}).coverage, 1);
}

TEST_F(PaintingTest, TheAxisIsDraggedByItsGrip) {
    editor.mirror = true;
    const glm::dvec2 grip = axis_grip(editor);
    drag({grip, grip + glm::dvec2(30, 5)});
    EXPECT_NEAR(mirror_axis(editor).point.x, 215, 1e-9);
    EXPECT_EQ(steps(), 0u);
    EXPECT_FALSE(probe(0).paint);
}

TEST_F(PaintingTest, ThePinPaintsStiffnessAndCtrlTakesItAway) {
    choose_tool(editor, find_tool("pin"));
    editor.selected = 0;
    click({100, 100});
    ASSERT_TRUE(editor.document.stiffness);
    EXPECT_EQ(editor.history.steps[1].label, "Paint stiffness");
    editor.brush.radius = 60;
    click({100, 100}, {.ctrl = true});
    EXPECT_EQ(editor.document.stiffness, nullptr);
}

TEST_F(PaintingTest, WithoutAProbeOrOnALockedOneItSaysWhy) {
    editor.selected = 0;
    click({100, 100});
    EXPECT_NE(take_notice().find("Choose a probe"), std::string::npos);
    editor.selected = 1;
    probe(0).locked = true;
    click({100, 100});
    EXPECT_NE(take_notice().find("locked"), std::string::npos);
    EXPECT_EQ(steps(), 0u);
    drag({on_canvas({320, 150})}, with_alt());  // chooses
    EXPECT_EQ(editor.selected, 2);
    EXPECT_EQ(steps(), 0u);
}

TEST_F(PaintingTest, LockedProbesKeepTheirShareUnderStrokesOfOthers) {
    probe(2).locked = true;
    commit(editor, "lock");
    refresh(editor);
    const auto at = locate_at_rest(mesh_of(editor.deformation), {200, 100});
    const double before = shares_at(editor.deformation, *at)[2];
    editor.brush.radius = 50;
    click({200, 100});
    refresh(editor);
    const auto after = shares_at(editor.deformation, *at);
    EXPECT_NEAR(after[2], before, 1e-6);  // floats
    EXPECT_NEAR(after[0], 1 - before, 1e-6);
}

TEST_F(PaintingTest, TheBrushShowsTheWeightsWhileItIsInTheHand) {
    EXPECT_EQ(editor.shown_weights, ShownWeights::chosen);
    choose_tool(editor, find_tool("select"));
    EXPECT_EQ(editor.shown_weights, ShownWeights::none);
    press_key(editor, {'W'});
    choose_tool(editor, find_tool("brush"));
    choose_tool(editor, find_tool("select"));
    EXPECT_EQ(editor.shown_weights, ShownWeights::chosen);  // asked for by hand
}

TEST_F(PaintingTest, CommandsPaintTheWholeMap) {
    editor.brush.value = 0.25;
    fill_paint(editor);
    EXPECT_NEAR(paint_at(0, {5, 5}).value, 0.25, 1e-5);  // 1/65535, as below
    invert_paint(editor);
    run_tasks();
    EXPECT_NEAR(paint_at(0, {395, 295}).value, 0.75, 1e-4);
    level_paint(editor, 0.5f, 1, 1);
    run_tasks();
    EXPECT_NEAR(paint_at(0, {200, 100}).value, 0.5, 1e-4);
    blur_paint(editor);
    run_tasks();
    EXPECT_NEAR(paint_at(0, {200, 100}).value, 0.5, 1e-4);
    copy_paint(editor);
    editor.selected = 2;
    paste_paint(editor);
    EXPECT_EQ(probe(1).paint, probe(0).paint);
    EXPECT_EQ(steps(), 5u);
    normalise_paint(editor);
    run_tasks();
    clear_paint(editor);
    EXPECT_FALSE(probe(1).paint);
    clear_all_paint(editor);
    EXPECT_FALSE(probe(0).paint);
}

TEST_F(PaintingTest, CommandsWaitForTheWeights) {
    click({100, 100});
    editor.deforms_elsewhere = true;  // and nobody does
    Document document = editor.document;
    document.probes.erase(document.probes.begin());
    editor.document = document;
    editor.selected = 2;
    invert_paint(editor);
    EXPECT_TRUE(editor.tasks.empty());
    EXPECT_NE(take_notice().find("still being worked out"), std::string::npos);
    editor.deformation = {};
    invert_paint(editor);
    EXPECT_TRUE(editor.tasks.empty());
}

/// On a mesh whose weights are not settled at once.
struct LargeMeshTest : PaintingTest {
    void SetUp() override {
        PaintingTest::SetUp();
        editor.document.mesh.cells = 1000;
        for (int i = 0; i < 6; ++i) {
            editor.document.probes.push_back(probe_at({50 + 40 * i, 80}, {50 + 40 * i, 80}));
            editor.document.probes.back().id = i + 4;
        }
        editor.deformation = elsewhere();
        editor.deforms_elsewhere = true;
    }
    /// As the window works it out.
    Deformation elsewhere() {
        Deformation made;
        if (is_bound(editor.deformation.binding.get(), editor.document))
            pose(made, editor.document, editor.deformation.binding);
        else
            update(made, editor.document);
        return made;
    }
};

TEST_F(LargeMeshTest, WeightsAreSettledElsewhereAndTheOldOnesGoOnDeforming) {
    const auto version = editor.deformation.version, mesh = editor.deformation.mesh_version;
    const auto unpainted = editor.deformation.now;
    Deformation late = editor.deformation;

    editor.brush.value = 0.5;
    fill_paint(editor);
    refresh(editor);
    EXPECT_FALSE(is_deformed(editor));
    EXPECT_FALSE(editor.deformation.refined) << "that would have taken long";
    EXPECT_EQ(editor.deformation.now, unpainted);
    Deformation filled = elsewhere();

    // Whatever the weights are, the pose is the document's own.
    editor.document.probes[1].now.x += 30;
    Document posed = editor.document;
    for (Probe& probe : posed.probes) probe.paint = nullptr;
    refresh(editor);
    EXPECT_FALSE(is_deformed(editor));
    EXPECT_EQ(editor.deformation.source, posed);
    EXPECT_NE(editor.deformation.now, unpainted);

    // What comes is taken, although the probe has moved meanwhile.
    editor.next_deformation = filled;
    refresh(editor);
    EXPECT_TRUE(is_deformed(editor));
    EXPECT_FALSE(editor.next_deformation);
    EXPECT_GT(editor.deformation.version, version);
    EXPECT_EQ(editor.deformation.mesh_version, mesh);
    EXPECT_EQ(editor.deformation.now, elsewhere().now);

    // A dab is settled at once.
    click({100, 100});
    refresh(editor);
    EXPECT_TRUE(is_deformed(editor));

    // What comes too late is not.
    const auto now = editor.deformation.now;
    editor.next_deformation = std::move(late);
    refresh(editor);
    EXPECT_TRUE(is_deformed(editor));
    EXPECT_EQ(editor.deformation.now, now);
    EXPECT_FALSE(editor.next_deformation);
}

TEST_F(LargeMeshTest, WhatComesLateIsTakenWhileThePaintGoesOnChanging) {
    // With stiffness every change is one of all weights.
    editor.document.stiffness =
        std::make_shared<const PaintMap>(filled(map_of(editor.document, nullptr), 0.2f));
    editor.deformation = elsewhere();
    for (const double value : {0.2, 0.4, 0.6}) {
        editor.brush.value = value;
        fill_paint(editor);
        Deformation late = elsewhere();
        editor.brush.value = value + 0.1;
        fill_paint(editor);
        const Document document = late.source;
        editor.next_deformation = std::move(late);
        refresh(editor);
        EXPECT_EQ(editor.deformation.source, document);
    }
}

TEST_F(LargeMeshTest, AStrokeWaitsForTheWeightsThatItAddsTo) {
    fill_paint(editor);
    const Document filled_document = editor.document;
    click({100, 100});
    EXPECT_NE(take_notice().find("still being worked out"), std::string::npos);
    EXPECT_EQ(editor.document, filled_document);
    editor.next_deformation = elsewhere();
    editor.brush.value = 0.25;
    click({100, 100});
    EXPECT_EQ(take_notice(), "");
    EXPECT_NE(editor.document, filled_document);
}

TEST_F(LargeMeshTest, CommandsSettleTheWeightsThatTheyNeedThemselves) {
    editor.brush.value = 0.25;
    fill_paint(editor);
    invert_paint(editor);
    ASSERT_EQ(editor.tasks.size(), 1u);
    run_tasks();
    EXPECT_NEAR(paint_at(0, {200, 100}).value, 0.75, 1e-4);
}

TEST_F(PaintingTest, LockedProbesKeepTheirPaint) {
    editor.mirror = true;
    click({60, 150});  // the first and the second, its mirror image
    const PaintPtr first = probe(0).paint, second = probe(1).paint;
    probe(1).locked = true;
    commit(editor, "lock");
    const std::string stays = probe(1).name + " is locked and stays as it is.";
    click({60, 120});
    EXPECT_EQ(take_notice(), stays);
    mirror_left_to_right(editor);
    EXPECT_EQ(take_notice(), stays);
    run_tasks();
    limit_paint(editor);
    EXPECT_EQ(take_notice(), stays);
    run_tasks();
    normalise_paint(editor);
    EXPECT_EQ(take_notice(), stays);
    run_tasks();
    clear_all_paint(editor);
    EXPECT_EQ(take_notice(), stays);
    EXPECT_EQ(probe(1).paint, second);
    EXPECT_NE(probe(0).paint, first);
    editor.selected = 2;
    const std::string locked = probe(1).name + " is locked; unlock it first";
    EXPECT_EQ(find_command("Clear the probe's paint").why_not(editor), locked);
    EXPECT_EQ(find_command("Mirror left to right").why_not(editor), locked);
    EXPECT_EQ(find_command("Clear all paint").why_not(editor), "Every probe that has paint is locked");
}

TEST_F(PaintingTest, AStrokeKeepsTheBrushItBeganWith) {
    press(editor, {.at = on_canvas({60, 100})});
    editor.brush.value = 0;
    editor.brush.radius = 2;
    move(editor, {.at = on_canvas({120, 100}), .ctrl = true});
    release(editor, {.at = on_canvas({120, 100})});
    EXPECT_EQ(paint_at(0, {120, 115}), (Paint{1, 1}));
}

TEST_F(PaintingTest, OneSideIsMirroredOntoTheOther) {
    editor.selected = 3;
    click({160, 40});
    mirror_left_to_right(editor);
    run_tasks();
    EXPECT_EQ(paint_at(2, {160, 40}).coverage, 1);
    EXPECT_EQ(paint_at(2, {240, 40}).coverage, 1);
    editor.selected = 1;
    click({60, 150});
    mirror_left_to_right(editor);
    run_tasks();
    EXPECT_EQ(paint_at(1, {340, 150}).coverage, 1);
    EXPECT_FALSE(paint_at(0, {340, 150}).coverage > 0);  // the other side is the other probe's
}

TEST_F(PaintingTest, PaintOutlivesTheMeshTheSchemeAndTheProbesPlace) {
    click({100, 100});
    const PaintPtr paint = probe(0).paint;
    editor.document.mesh.cells = 37;
    editor.document.weights.scheme = "gaussian";
    probe(0).rest += glm::dvec2(15, 3);
    refresh(editor);
    EXPECT_EQ(probe(0).paint, paint);
    const auto at = locate_at_rest(mesh_of(editor.deformation), {100, 100});
    EXPECT_NEAR(shares_at(editor.deformation, *at)[0], 1, 1e-6);
}

}  // namespace
}  // namespace probewarp
