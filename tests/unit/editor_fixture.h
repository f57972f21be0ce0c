// An editor with a picture on a canvas, and a hand that presses, moves and releases.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <utility>

#include "editor/commands.h"
#include "editor/tools.h"
#include "pictures.h"

namespace probewarp::testing {

struct EditorTest : ::testing::Test {
    Editor editor;

    /// 400 x 300 pixels, seen at 200 per cent from canvas pixel (50, 40) on.
    void SetUp() override { open(blank_document(400, 300, 20)); }

    void open(Document document) {
        start(editor, std::move(document), {}, true);
        resize_canvas(editor, {900, 700}, 1);
        editor.view = {{50, 40}, 2};
        editor.fit_wanted = false;
    }
    /// Opens the present document with these probes on it instead of its own.
    void open_with(std::initializer_list<Probe> probes) {
        Document document = editor.document;
        document.probes = probes;
        for (std::size_t i = 0; i < document.probes.size(); ++i) document.probes[i].id = int(i) + 1;
        open(std::move(document));
    }
    static Probe probe_at(glm::dvec2 rest, glm::dvec2 now, double angle = 0, double radius = 50) {
        Probe probe;
        probe.name = "P";
        probe.rest = rest;
        probe.now = now;
        probe.angle = angle;
        probe.radius = radius;
        return probe;
    }

    Probe& probe(std::size_t i = 0) { return editor.document.probes.at(i); }
    std::size_t steps() const { return editor.history.steps.size() - 1; }
    std::string take_notice() { return std::exchange(editor.notice, ""); }
    glm::dvec2 on_canvas(glm::dvec2 image_point) const { return to_canvas(editor.view, image_point); }

    /// The button goes down at the first place, along the others, and up at the last. Keys as in `like`.
    void drag(std::initializer_list<glm::dvec2> way, PointerEvent like = {}) {
        like.at = *way.begin();
        press(editor, like);
        carry_on(way, like);
        release(editor, like);
    }
    void carry_on(std::initializer_list<glm::dvec2> way, PointerEvent& like) {
        for (const glm::dvec2 at : way) {
            like.at = at;
            move(editor, like);
        }
    }
    void double_click_at(glm::dvec2 image_point, PointerEvent like = {}) {
        like.at = on_canvas(image_point);
        press(editor, like);  // as a window has it: the first click, then the second
        release(editor, like);
        press(editor, like);
        double_click(editor, like);
        release(editor, like);
    }
};

inline PointerEvent with_shift() { return {.shift = true}; }
inline PointerEvent with_space() { return {.space = true}; }
inline PointerEvent with_alt() { return {.alt = true}; }
inline PointerEvent middle_button() { return {.button = Button::middle}; }

inline double distance(glm::dvec2 a, glm::dvec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace probewarp::testing
