// What the pointer does: adding, dragging, turning, panning, zooming, and that each gesture is one step.
#include "editor/editor.h"

#include <gmock/gmock.h>

#include "editor_fixture.h"
#include "generators.h"

namespace probewarp {
namespace {

using testing::degrees;
using testing::distance;
using testing::EditorTest;
using testing::expect_always;
using ::testing::HasSubstr;
using testing::real;

constexpr double pi = std::numbers::pi;

TEST_F(EditorTest, AnotherDocumentIsSeenToBeAnother) {
    // What was drawn is kept by version: with the last document's numbers, its mesh would be taken for this
    // one's.
    refresh(editor);
    const auto mesh = editor.deformation.mesh_version, version = editor.deformation.version;
    open(testing::blank_document(300, 400, 20));
    refresh(editor);
    EXPECT_GT(editor.deformation.mesh_version, mesh);
    EXPECT_GT(editor.deformation.version, version);
}

TEST_F(EditorTest, ADoubleClickAddsAProbeAtRest) {
    double_click_at({100, 80});
    ASSERT_EQ(editor.document.probes.size(), 1u);
    EXPECT_LT(distance(probe().rest, {100, 80}), 1e-10);  // roundings in cells of 20 pixels
    EXPECT_EQ(editor.selected, probe().id);
    EXPECT_EQ(steps(), 1u);
    EXPECT_EQ(editor.history.steps[1].label, "Add Probe 1");
    double_click_at({100, 81});  // on the probe there is no room for another
    EXPECT_EQ(editor.document.probes.size(), 1u);
    EXPECT_EQ(steps(), 1u);
}

TEST_F(EditorTest, OnAnUndeformedPictureAProbeIsPutExactlyAtRest) {
    expect_always("wherever it is put, so that an export still equals its input", [this] {
        open(testing::blank_document(400, 300, 7));
        editor.view.zoom = *real(0.1, 8);
        double_click_at({*real(0, 400), *real(0, 300)});
        RC_ASSERT(editor.document.probes.size() == 1u);
        RC_ASSERT(at_rest(probe()));
    });
}

TEST_F(EditorTest, BesideThePictureNothingIsAdded) {
    double_click_at({-5, 80});
    EXPECT_EQ(take_notice(), "There is no picture there to put a probe on.");
    double_click_at({100, 80}, {.button = Button::right});
    double_click_at({100, 80}, testing::with_space());
    EXPECT_TRUE(editor.document.probes.empty());
    EXPECT_EQ(steps(), 0u);
    editor.tool = &find_tool("add");
    drag({on_canvas({100, 400})});
    EXPECT_EQ(take_notice(), "There is no picture there to put a probe on.");
    EXPECT_FALSE(editor.gesture);
    Editor empty;
    double_click(empty, {});
    press(empty, {});
    EXPECT_TRUE(empty.document.probes.empty());
}

TEST_F(EditorTest, AddingToAPictureThatOneProbeMovedMovesNoVertex) {
    open_with({probe_at({100, 80}, {160, 120}, 400 * degrees)});
    refresh(editor);
    const auto before = editor.deformation.now;
    double_click_at({200, 150});
    ASSERT_EQ(editor.document.probes.size(), 2u);
    refresh(editor);
    EXPECT_NEAR(probe(1).angle, 400 * degrees, 1e-12);  // unwrapped, as its neighbour's
    for (std::size_t v = 0; v < before.size(); ++v)
        // The place at rest is read off vertices that are floats (3e-5 of 400 pixels), several times.
        ASSERT_LT(distance(editor.deformation.now[v], before[v]), 1e-3);
}

/// Where the deformed mesh shows a point of the picture.
glm::dvec2 shown_at(const Deformation& deformation, glm::dvec2 rest) {
    const auto at = locate(mesh_of(deformation), mesh_of(deformation).rest, rest);
    glm::dvec2 sum{0};
    for (int k = 0; k < 3; ++k)
        sum += at.value().barycentric[k] * glm::dvec2(deformation.now[at.value().corners[std::size_t(k)]]);
    return sum;
}

TEST_F(EditorTest, AddingToADeformedPictureMovesNothingUnderThePointer) {
    open(testing::blank_document(400, 300, 400));  // cells of a pixel
    open_with({probe_at({50, 50}, {60, 70}, 0.3), probe_at({350, 60}, {330, 90}, -0.2),
               probe_at({200, 250}, {220, 240}, 0.5)});
    for (const glm::dvec2 point : {glm::dvec2{180, 120}, {120, 170}, {260, 150}}) {
        refresh(editor);
        const auto before = pose_at(editor.deformation, point);
        ASSERT_TRUE(before);
        double_click_at(point);
        const Probe added = editor.document.probes.back();
        EXPECT_EQ(steps(), editor.document.probes.size() - 3);
        EXPECT_EQ(added.now, point);
        EXPECT_EQ(added.rest, before->rest);
        EXPECT_EQ(added.angle, before->angle);
        refresh(editor);
        // The vertices around the point are within 1.5 pixels of the new probe and 50 or more from the
        // others, which keep (1.5/50)^2 = 0.1 per cent of the weight there, of differences of a few tens of
        // pixels.
        EXPECT_LT(distance(shown_at(editor.deformation, added.rest), point), 0.05);
        const auto after = pose_at(editor.deformation, point);
        ASSERT_TRUE(after);
        EXPECT_LT(distance(after->rest, before->rest), 0.05);
        EXPECT_NEAR(after->angle, before->angle, 0.01);
    }
}

TEST_F(EditorTest, DraggingADiscMovesTheProbeByAsMuch) {
    open_with({probe_at({100, 80}, {100, 80}, 1)});
    const glm::dvec2 held = on_canvas({100, 80}) + glm::dvec2(5, -3);  // not in the middle of it
    drag({held, held + glm::dvec2(30, 0), held + glm::dvec2(300, 200), held + glm::dvec2(31, 14)});
    EXPECT_LT(distance(probe().now, {115.5, 87}), 1e-12);  // (31, 14) at 200 per cent
    EXPECT_EQ(probe().rest, glm::dvec2(100, 80));
    EXPECT_EQ(probe().angle, 1);
    EXPECT_EQ(steps(), 1u);
    EXPECT_EQ(editor.history.steps[1].label, "Move P");
    EXPECT_FALSE(editor.gesture);
    undo_step(editor);
    EXPECT_EQ(probe().now, glm::dvec2(100, 80));
    redo_step(editor);
    EXPECT_LT(distance(probe().now, {115.5, 87}), 1e-12);
}

TEST_F(EditorTest, AfterADragThePictureIsExactlyTheDocuments) {
    open_with({probe_at({100, 80}, {100, 80}, 1), probe_at({300, 200}, {280, 220}, 2)});
    refresh(editor);
    PointerEvent pointer;
    pointer.at = on_canvas({100, 80});
    press(editor, pointer);
    for (const double x : {30, 31, 35}) {
        pointer.at = on_canvas({100, 80}) + glm::dvec2(x, 14);
        move(editor, pointer);
        refresh(editor);
        EXPECT_TRUE(editor.deformation.dragged);
    }
    release(editor, pointer);
    refresh(editor);
    Deformation anew;
    update(anew, editor.document);
    EXPECT_EQ(editor.deformation.now, anew.now);
}

TEST_F(EditorTest, AClickThatTremblesMovesNothing) {
    open_with({probe_at({100, 80}, {100, 80})});
    const glm::dvec2 held = on_canvas({100, 80});
    drag({held, held + glm::dvec2(2, 2), held + glm::dvec2(-1, 0)});
    EXPECT_EQ(probe().now, glm::dvec2(100, 80));
    EXPECT_EQ(steps(), 0u);
    EXPECT_EQ(editor.selected, 1);
    // Once it has moved it follows exactly, also back to where it was.
    drag({held, held + glm::dvec2(20, 0), held + glm::dvec2(1, 0)});
    EXPECT_EQ(probe().now, glm::dvec2(100.5, 80));
    EXPECT_EQ(steps(), 1u);
}

TEST_F(EditorTest, ShiftKeepsADragOnOneAxis) {
    open_with({probe_at({100, 80}, {100, 80})});
    const glm::dvec2 held = on_canvas({100, 80});
    drag({held, held + glm::dvec2(40, 22)}, testing::with_shift());
    EXPECT_EQ(probe().now, glm::dvec2(120, 80));
    drag({held + glm::dvec2(40, 0), held + glm::dvec2(50, -60)}, testing::with_shift());
    EXPECT_EQ(probe().now, glm::dvec2(120, 50));
}

TEST_F(EditorTest, EscapeTakesADragBack) {
    open_with({probe_at({100, 80}, {100, 80}), probe_at({300, 80}, {300, 80})});
    const Document before = editor.document;
    PointerEvent hand{.at = on_canvas({100, 80})};
    press(editor, hand);
    carry_on({hand.at + glm::dvec2(50, 50)}, hand);
    EXPECT_NE(editor.document, before);
    EXPECT_TRUE(press_key(editor, {key_escape}));
    EXPECT_EQ(editor.document, before);
    EXPECT_FALSE(editor.gesture);
    carry_on({{500, 500}}, hand);  // the hand goes on
    release(editor, hand);
    EXPECT_EQ(editor.document, before);
    EXPECT_EQ(steps(), 0u);
    EXPECT_EQ(editor.selected, 1);
    press_key(editor, {key_escape});  // without a drag it unselects
    EXPECT_EQ(editor.selected, 0);
}

TEST_F(EditorTest, TheAddToolAddsAndDragsInOneStep) {
    editor.tool = &find_tool("add");
    const glm::dvec2 at = on_canvas({100, 80});
    drag({at, at + glm::dvec2(40, 20)});
    ASSERT_EQ(editor.document.probes.size(), 1u);
    EXPECT_LT(distance(probe().rest, {100, 80}), 1e-10);  // roundings in cells of 20 pixels
    EXPECT_LT(distance(probe().now, {120, 90}), 1e-10);
    EXPECT_EQ(steps(), 1u);
    PointerEvent hand{.at = on_canvas({300, 200})};
    press(editor, hand);
    EXPECT_EQ(editor.document.probes.size(), 2u);
    cancel(editor);
    EXPECT_EQ(editor.document.probes.size(), 1u);
    EXPECT_EQ(editor.selected, 0);
    EXPECT_EQ(steps(), 1u);
}

struct Turning : EditorTest {
    glm::dvec2 middle{};
    PointerEvent hand;

    void take_the_knob(double angle = 0) {
        open_with({probe_at({100, 80}, {100, 80}, angle)});
        middle = on_canvas({100, 80});
        hand.at = knob_position(editor, probe());
        press(editor, hand);
    }
    /// Round the probe, at a distance that changes, in steps of 10 degrees.
    void turn_by(double turned) {
        const glm::dvec2 from = hand.at - middle;
        const double start = std::atan2(from.y, from.x);
        const int count = int(std::ceil(std::abs(turned) / (10 * degrees)));
        for (int i = 1; i <= count; ++i) {
            const double a = start + turned * i / count;
            carry_on({middle + (30.0 + i % 50) * glm::dvec2(std::cos(a), std::sin(a))}, hand);
        }
    }
};

TEST_F(Turning, ThreeTimesRoundIsThreeTurns) {
    for (const double turns : {3.0, -3.0}) {
        take_the_knob(0.5);
        turn_by(turns * 2 * pi);
        release(editor, hand);
        EXPECT_NEAR(probe().angle, 0.5 + turns * 2 * pi, 1e-12);  // 108 steps, each rounded by 1e-15
        EXPECT_EQ(probe().now, glm::dvec2(100, 80));
        EXPECT_EQ(steps(), 1u);
        EXPECT_EQ(editor.history.steps[1].label, "Turn P");
    }
}

TEST_F(Turning, TheKnobIsWhereTheAngleSays) {
    open_with({probe_at({100, 80}, {100, 80})});
    EXPECT_EQ(knob_position(editor, probe()), on_canvas({100, 80}) + glm::dvec2(0, -stem_length));  // up
    probe().angle = 90 * degrees;  // clockwise as seen: to the right
    EXPECT_LT(distance(knob_position(editor, probe()), on_canvas({100, 80}) + glm::dvec2(stem_length, 0)),
              1e-12);
    editor.scale = 2;
    EXPECT_LT(distance(knob_position(editor, probe()), on_canvas({100, 80}) + glm::dvec2(2 * stem_length, 0)),
              1e-12);
}

TEST_F(Turning, ShiftSnapsToFifteenDegreesAndLetsGoAgain) {
    take_the_knob();
    hand.shift = true;
    turn_by(37 * degrees);
    EXPECT_NEAR(probe().angle, 30 * degrees, 1e-12);  // roundings of a few steps
    turn_by(1 * degrees);
    EXPECT_NEAR(probe().angle, 45 * degrees, 1e-12);
    turn_by(362 * degrees);
    EXPECT_NEAR(probe().angle, 405 * degrees, 1e-12);
    hand.shift = false;
    turn_by(1 * degrees);
    EXPECT_NEAR(probe().angle, 401 * degrees, 1e-12);
}

TEST_F(Turning, ThroughTheMiddleThereIsNoDirection) {
    take_the_knob();
    carry_on({middle + glm::dvec2(0, -20), middle + glm::dvec2(0.5, 0.5), middle, middle + glm::dvec2(1, -1),
              middle + glm::dvec2(20, 0)},
             hand);
    EXPECT_NEAR(probe().angle, 90 * degrees, 1e-12);  // from up to the right, whatever lay between
    cancel(editor);
    EXPECT_EQ(probe().angle, 0);
    EXPECT_EQ(steps(), 0u);
}

TEST_F(EditorTest, PullingTheReachOfTheChosenProbe) {
    open_with({probe_at({100, 80}, {200, 150}, 0, 60)});
    const glm::dvec2 middle = on_canvas({200, 150});
    drag({middle + glm::dvec2(120, 0), middle + glm::dvec2(0, 50)});
    EXPECT_EQ(probe().radius, 60);  // nothing is chosen: no circle is there
    editor.selected = 1;
    drag({middle + glm::dvec2(120, 0), middle + glm::dvec2(50, 0), middle + glm::dvec2(0, 90)});
    EXPECT_NEAR(probe().radius, 45, 1e-12);
    EXPECT_EQ(steps(), 1u);
    drag({middle + glm::dvec2(90, 0), middle});
    EXPECT_EQ(probe().radius, 1);  // never none
}

TEST_F(EditorTest, ADoubleClickOnAReachAddsAProbe) {
    open_with({probe_at({100, 80}, {100, 80}, 0, 60)});
    editor.selected = 1;
    ASSERT_EQ(hit_test(editor, on_canvas({160, 80})), (Hit{Part::reach, 1}));
    double_click_at({160, 80});
    ASSERT_EQ(editor.document.probes.size(), 2u);
    EXPECT_EQ(probe(1).rest, glm::dvec2(160, 80));
    EXPECT_EQ(probe(0).radius, 60);
    EXPECT_EQ(steps(), 1u);
    editor.selected = 1;
    double_click_at({100, 80 - stem_length / 2});  // on the knob, at 200 per cent
    EXPECT_EQ(editor.document.probes.size(), 2u);
}

TEST_F(EditorTest, LockedProbesStay) {
    open_with({probe_at({100, 80}, {110, 80}, 1)});
    probe().locked = true;
    commit(editor, "Lock");
    const Document before = editor.document;
    drag({on_canvas({110, 80}), on_canvas({200, 200})});
    EXPECT_EQ(editor.selected, 1);  // it can be chosen
    EXPECT_THAT(take_notice(), HasSubstr("P is locked"));
    drag({knob_position(editor, probe()), on_canvas({200, 200})});
    press_key(editor, {key_left});
    press_key(editor, {key_up, false, true});
    run(editor, find_command("Put back to rest"));
    run(editor, find_command("Reset the pose of all"));
    EXPECT_EQ(editor.document, before);
    EXPECT_EQ(steps(), 1u);
}

TEST_F(EditorTest, TheChosenProbeIsHitFirstThenTheTopmost) {
    open_with(
        {probe_at({100, 80}, {100, 80}), probe_at({102, 80}, {102, 80}), probe_at({104, 80}, {104, 80})});
    const glm::dvec2 at = on_canvas({102, 80});
    EXPECT_EQ(hit_test(editor, at), (Hit{Part::disc, 3}));
    editor.selected = 1;
    EXPECT_EQ(hit_test(editor, at), (Hit{Part::disc, 1}));
    drag({at});
    EXPECT_EQ(editor.selected, 1);
    // Also its knob, where another's disc lies over it.
    probe(2).now = {100, 80 - stem_length / 2};
    EXPECT_EQ(hit_test(editor, knob_position(editor, probe(0))), (Hit{Part::knob, 1}));
    editor.selected = 0;
    EXPECT_EQ(hit_test(editor, knob_position(editor, probe(0))), (Hit{Part::disc, 3}));
    probe(2).now = {104, 80};
    EXPECT_EQ(hit_test(editor, at), (Hit{Part::disc, 3}));
    probe(2).visible = false;
    EXPECT_EQ(hit_test(editor, at), (Hit{Part::disc, 2}));
    editor.show_probes = false;
    EXPECT_EQ(hit_test(editor, at), Hit{});
}

TEST_F(EditorTest, HoveringAndClickingBeside) {
    open_with({probe_at({100, 80}, {100, 80})});
    move(editor, {.at = on_canvas({100, 80})});
    EXPECT_EQ(editor.hover, (Hit{Part::disc, 1}));
    EXPECT_EQ(editor.pointer, on_canvas({100, 80}));
    move(editor, {.at = on_canvas({300, 280})});
    EXPECT_EQ(editor.hover, Hit{});
    editor.selected = 1;
    drag({on_canvas({300, 280})});
    EXPECT_EQ(editor.selected, 0);
    EXPECT_EQ(steps(), 0u);
}

TEST_F(EditorTest, ASecondButtonDoesNotEndADrag) {
    open_with({probe_at({100, 80}, {100, 80})});
    PointerEvent hand{.at = on_canvas({100, 80})};
    press(editor, hand);
    press(editor, {.at = {0, 0}, .button = Button::middle});
    release(editor, {.at = {0, 0}, .button = Button::middle});
    ASSERT_TRUE(editor.gesture);
    press_key(editor, {'Z', true});  // nor does a command
    carry_on({on_canvas({150, 80})}, hand);
    release(editor, hand);
    EXPECT_EQ(probe().now, glm::dvec2(150, 80));
    EXPECT_EQ(steps(), 1u);
}

TEST_F(EditorTest, TheMiddleButtonAndSpacePan) {
    open_with({probe_at({100, 80}, {100, 80})});
    const Document before = editor.document;
    const glm::dvec2 at = on_canvas({100, 80});  // on a probe, which stays
    drag({at, at + glm::dvec2(13, -7)}, testing::middle_button());
    EXPECT_EQ(editor.view.corner, glm::dvec2(63, 33));
    drag({at, at + glm::dvec2(1, 1)}, testing::with_space());
    EXPECT_EQ(editor.view.corner, glm::dvec2(64, 34));
    PointerEvent hand = testing::middle_button();
    press(editor, hand);
    carry_on({{300, 300}}, hand);
    cancel(editor);
    EXPECT_EQ(editor.view.corner, glm::dvec2(64, 34));
    EXPECT_EQ(editor.view.zoom, 2);
    EXPECT_EQ(editor.document, before);
    EXPECT_EQ(steps(), 0u);
}

TEST_F(EditorTest, TheZoomToolZoomsWithClicksAndPansWithDrags) {
    editor.tool = &find_tool("zoom");
    const glm::dvec2 at{333, 222}, under = to_image(editor.view, at);
    drag({at});
    EXPECT_EQ(editor.view.zoom, 4);
    EXPECT_LT(distance(to_image(editor.view, at), under), 1e-10);  // roundings of numbers up to 1000
    drag({at}, testing::with_alt());
    drag({at}, testing::with_alt());
    EXPECT_EQ(editor.view.zoom, 1);
    const CanvasView before = editor.view;
    drag({at, at + glm::dvec2(200, 0), at + glm::dvec2(1, 0)});  // away and back is no click
    EXPECT_EQ(editor.view.zoom, 1);
    EXPECT_EQ(editor.view.corner, before.corner + glm::dvec2(1, 0));
    drag({at}, testing::middle_button());  // nor is another button
    EXPECT_EQ(editor.view.zoom, 1);
}

TEST_F(EditorTest, TheWheelKeepsWhatIsUnderThePointer) {
    expect_always("the image point under the pointer stays, the zoom keeps within its limits", [this] {
        editor.view = {{*real(-2000, 2000), *real(-2000, 2000)}, std::pow(2, *real(-6, 6))};
        const glm::dvec2 at{*real(0, 900), *real(0, 700)}, under = to_image(editor.view, at);
        scroll(editor, {.at = at}, *rc::gen::element(-100.0, -3.0, -1.0, -0.1, 0.1, 1.0, 3.0, 100.0));
        RC_ASSERT(editor.view.zoom >= least_zoom && editor.view.zoom <= most_zoom);
        // Roundings of canvas coordinates up to 1e7 (2000 pixels times the zoom's range).
        RC_ASSERT(distance(to_canvas(editor.view, under), at) < 1e-8);
    });
    editor.view.zoom = 2;
    press(editor, testing::middle_button());
    scroll(editor, {}, 1);  // not while something is dragged
    EXPECT_EQ(editor.view.zoom, 2);
}

TEST_F(EditorTest, WhatFailedInTheMiddleIsTakenBack) {
    open_with({probe_at({100, 80}, {100, 80})});
    refresh(editor);
    const Document before = editor.document;
    const unsigned long version = editor.deformation.version, mesh_version = editor.deformation.mesh_version;
    editor.selected = 7;  // as it was about to be chosen
    probe().now.x = 123;
    editor.document.probes.push_back(probe());
    restore(editor);
    EXPECT_EQ(editor.document, before);
    EXPECT_EQ(editor.selected, 0);
    EXPECT_FALSE(editor.gesture);
    EXPECT_EQ(steps(), 0u);
    refresh(editor);
    EXPECT_TRUE(is_deformed(editor));
    EXPECT_GT(editor.deformation.version, version);
    EXPECT_GT(editor.deformation.mesh_version, mesh_version);
}

TEST_F(EditorTest, EditingAFieldIsOneStep) {
    open_with({probe_at({100, 80}, {100, 80})});
    const Document before = editor.document;
    for (const double x : {1.0, 12.0, 123.0}) {
        begin_field(editor);  // a panel says so in every frame
        probe().now.x = x;
    }
    end_field(editor, "Edit x");
    EXPECT_EQ(steps(), 1u);
    EXPECT_EQ(editor.history.steps[1].label, "Edit x");
    EXPECT_EQ(probe().now.x, 123);
    begin_field(editor);
    end_field(editor, "Edit nothing");
    EXPECT_EQ(steps(), 1u);
    for (const double x : {7.0, 77.0}) {
        begin_field(editor);
        probe().now.x = x;
    }
    move(editor, {.at = {10, 10}});  // the pointer has nothing to do with it
    release(editor, {.at = {10, 10}});
    EXPECT_TRUE(editor.gesture);
    cancel(editor);
    EXPECT_EQ(probe().now.x, 123);
    undo_step(editor);
    EXPECT_EQ(editor.document, before);
}

TEST_F(EditorTest, AnotherDocumentBeginsAnew) {
    open_with({probe_at({100, 80}, {100, 80})});
    drag({on_canvas({100, 80}), on_canvas({120, 80})});
    press(editor, {.at = on_canvas({120, 80})});
    start(editor, testing::blank_document(10, 10), "a.probewarp", false);
    EXPECT_FALSE(editor.gesture);
    EXPECT_EQ(editor.selected, 0);
    EXPECT_EQ(steps(), 0u);
    EXPECT_FALSE(is_saved(editor.history));
    EXPECT_TRUE(editor.fit_wanted);
    EXPECT_EQ(editor.path, "a.probewarp");
}

TEST_F(EditorTest, MoreProbesThanFitAreRefusedWithTheReason) {
    open(testing::blank_document(100, 100, 1000));  // 1001^2 vertices: 66 probes
    for (int i = 0; i < 66; ++i) editor.document.probes.push_back(new_probe(editor.document, {i, i}));
    commit(editor, "Import");
    editor.selected = 5;
    run(editor, find_command("Duplicate"));
    EXPECT_THAT(take_notice(), HasSubstr("coarser mesh"));
    EXPECT_FALSE(add_probe(editor, new_probe(editor.document, {50, 50})));
    EXPECT_EQ(editor.document.probes.size(), 66u);
    EXPECT_EQ(editor.selected, 5);
    EXPECT_EQ(steps(), 1u);
}

}  // namespace
}  // namespace probewarp
