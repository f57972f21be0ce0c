// The editor: what a person is doing to a document, without a window. It takes pointer and key events as
// plain structs and knows neither the toolkit nor the file system; what it needs from them it asks for by a
// Request.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "editor/view.h"
#include "model/brush.h"
#include "model/deform_by.h"
#include "model/deformation.h"
#include "model/history.h"

namespace probewarp {

enum class Button { left, middle, right };

struct PointerEvent {
    glm::dvec2 at{0};  ///< canvas pixels
    Button button = Button::left;
    bool shift = false, ctrl = false, alt = false, space = false;
};

/// Sizes of a probe's glyph at scale 1, pixels (look.md).
inline constexpr double disc_radius = 15, stem_length = 34, knob_radius = 6;

enum class Part { none, disc, knob, reach };

struct Hit {
    Part part = Part::none;
    int probe = 0;  ///< id; 0 for none
    friend bool operator==(const Hit&, const Hit&) = default;
};

struct PaintStroke;

/// What lasts from press to release: the document before it, and what is dragged.
struct Gesture {
    enum class Kind { pan, move, turn, reach, field, paint, brush_size, axis, divider } kind = Kind::pan;
    Document before;
    int probe = 0;
    PointerEvent pressed;                 ///< what began it
    glm::dvec2 last{0};                   ///< canvas pixels: where the pointer was at the last event
    glm::dvec2 start_corner{0};           ///< pan: the view's corner then
    double raw_angle = 0;                 ///< turn: radians, unwrapped, before snapping
    double start_radius = 0;              ///< brush_size: the brush's then, image pixels
    double start_divider = 0;             ///< divider: where it was then
    std::shared_ptr<PaintStroke> stroke;  ///< paint
    std::string label;                    ///< of the step it becomes
    bool moved = false;                   ///< further than a click may tremble
};

/// Another blend beside the document's own; see comparison.h.
struct Comparison {
    std::string blend;           ///< its name
    double divider = 0.5;        ///< where it begins, of the canvas's width
    unsigned long version = 0;   ///< of the deformation that `now` is of; 0: of none
    std::vector<glm::vec2> now;  ///< #vertices, image pixels
};

/// What the editor asks of its surroundings.
enum class Request {
    new_document,
    open,
    save,
    save_as,
    export_picture,
    import_probes,
    replace_picture,
    switch_theme,
    levels,
    about,
    quit,
};

/// Work too long for the window's thread: `run` gives the document that becomes a step of that label.
struct Task {
    std::string label;
    std::function<Document()> run;
};

/// The step that the last press of an arrow key made.
struct Nudge {
    int probe = 0;         ///< id; 0: none
    std::size_t step = 0;  ///< of the history
};

struct Tool;

/// What of the weights is shown over the picture.
enum class ShownWeights { none, chosen, all };

struct Editor {
    History history;
    Document document;  ///< what is shown: the present step, or what a gesture makes of it
    Deformation deformation;
    std::filesystem::path path;  ///< of the project; empty before it was saved
    unsigned long opened = 0;    ///< counts the documents begun with

    CanvasView view;
    glm::dvec2 canvas_size{0};
    double scale = 1;        ///< screen pixels per pixel of the design
    bool fit_wanted = true;  ///< the whole picture is to be shown, until it is zoomed or panned

    const Tool* tool = nullptr;
    int selected = 0;  ///< probe id; 0 for none
    Hit hover;
    std::optional<glm::dvec2> pointer;  ///< canvas pixels; empty while it is elsewhere
    std::optional<Gesture> gesture;
    Nudge nudge;
    bool show_probes = true, show_mesh = false, show_folds = false;
    ShownWeights shown_weights = ShownWeights::none;
    bool shown_by_brush = false;  ///< they go when the brush is put down
    bool iso_lines = false;
    float weights_opacity = 0.65f;
    std::optional<Comparison> comparison;  ///< empty: the canvas shows one blend

    Brush brush;
    bool mirror = false;             ///< strokes are painted on both sides of the axis
    std::optional<MirrorAxis> axis;  ///< empty: upright through the picture's middle
    PaintPtr copied_paint;           ///< null: nothing was copied

    DeformBy deform_by = DeformBy::automatic;

    /// The window works bindings and large tables of weights out beside itself; without one refresh does, at
    /// once.
    bool deforms_elsewhere = false;
    std::optional<Deformation> next_deformation;  ///< the newest from there; taken by the next refresh

    std::vector<Request> requests;  ///< taken and emptied by the window
    std::vector<Task> tasks;        ///< likewise
    std::string notice;             ///< a sentence to show once; taken and emptied by the window

    Editor();
};

bool has_picture(const Editor& editor);
Probe* selected_probe(Editor& editor);

/// Begins with another document: opened from `path` (a project) or from nothing.
void start(Editor& editor, Document document, std::filesystem::path path, bool saved);

/// Whether refresh settles the weights by itself even where there is a window: it takes some 20 ms at most.
/// Requires a binding that fits the document.
bool settles_at_once(const Editor& editor);

/// Brings the deformation up to date with the document, as far as that goes without the window's help. Called
/// before drawing.
void refresh(Editor& editor);

/// Whether the deformation is the document's own, rather than one that waits for its weights.
bool is_deformed(const Editor& editor);

/// Takes the document back to the present step, after something failed in the middle of a change, and forgets
/// what was worked out from it.
void restore(Editor& editor);

/// Makes `document` a step of the history, unless nothing changed. Ends a gesture.
void commit(Editor& editor, std::string label);
/// Takes back what the gesture did. Without one, unselects.
void cancel(Editor& editor);

void undo_step(Editor& editor);
void redo_step(Editor& editor);

/// Pointer events, in canvas pixels.
void press(Editor& editor, const PointerEvent& event);
void move(Editor& editor, const PointerEvent& event);
void release(Editor& editor, const PointerEvent& event);
void double_click(Editor& editor, const PointerEvent& event);
void scroll(Editor& editor, const PointerEvent& event, double steps);

/// A field of a panel is being edited: changes to `document` until end_field are one step.
void begin_field(Editor& editor);
void end_field(Editor& editor, std::string label);

/// Puts a probe on the picture under the pointer, with the picture's own pose there, so that nothing jumps.
/// Not committed. Returns its id, or 0 where none can be put; the notice then says why.
int put_probe(Editor& editor, glm::dvec2 at);
/// Adds the probe and chooses it, not committed. False, with a notice, where the weights would be too many.
bool add_probe(Editor& editor, Probe probe);

/// Makes a notice of which probes stay as they are because they are locked, of those that a change of several
/// would otherwise change; none where there are none.
void say_locked_stay(Editor& editor, const std::function<bool(const Probe&)>& would_change);

/// What is under the pointer, the chosen probe first, then the topmost.
Hit hit_test(const Editor& editor, glm::dvec2 at);
/// Where the knob of a probe is, canvas pixels.
glm::dvec2 knob_position(const Editor& editor, const Probe& probe);

/// Tells how large the canvas is; a picture that is shown whole stays so.
void resize_canvas(Editor& editor, glm::dvec2 size, double scale);
void zoom_canvas(Editor& editor, glm::dvec2 fixed, double factor);

}  // namespace probewarp
