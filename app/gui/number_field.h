// Fields for numbers: a click types, a drag changes, Tab goes from one to the next.
#pragma once

#include <imgui.h>

#include <array>
#include <string>
#include <vector>

#include "editor/number_text.h"

namespace probewarp {

struct App;

/// What a key does to the field that is typed in: Return, Tab, Shift+Tab, Escape, and a click elsewhere.
enum class FieldKey { none, take, next, previous, take_back, leave };

/// The field that a person types or drags in. One at a time; it lasts from frame to frame.
struct NumberEdit {
    ImGuiID id = 0;       ///< typed in; 0: none
    ImGuiID pressed = 0;  ///< held by the mouse; 0: none
    ImGuiID wanted = 0;   ///< to be typed in as soon as it is drawn; 0: none
    ImGuiID last = 0;     ///< typed in last: Tab goes on from there

    std::array<char, max_number_text + 1> text{};  ///< as typed, UTF-8
    std::string first_text;                        ///< as it was when typing began
    double before = 0, partner_before = 0;         ///< the values then
    bool starts = false;                           ///< it takes the keyboard in this frame
    bool refused = false;                          ///< Return or Tab was pressed and the text is no number
    FieldKey key = FieldKey::none;                 ///< pressed since the last frame
    unsigned long opened = 0;                      ///< the document, and the probe, whose number it is
    int selected = 0;

    bool drags = false;      ///< the mouse has moved further than a click may tremble
    double dragged = 0;      ///< what the drag has made of the value, not rounded
    bool took_back = false;  ///< Escape: what the field did to the document is no step
    bool scrolled = false;   ///< to the wanted field
    int drawn = 0;           ///< the frame that last had the field

    struct Stop {
        ImGuiID window, id;  ///< the outermost window, and the field
    };
    std::vector<Stop> stops, arriving;  ///< where Tab stops: in the last frame, in this one so far
};

struct NumberField {
    const char* unit = "";  ///< shown in the field at the right
    NumberUnit measure = NumberUnit::none;
    float width = 0;  ///< window pixels
    double step = 1;  ///< of a drag by one pixel of the design
    double least = 0, most = 1;
    int decimals = 1;           ///< shown while nobody types
    bool bare = false;          ///< without a frame, its text at the right: beside a slider
    bool when_left = false;     ///< taken when typing ends, not with every key
    double* partner = nullptr;  ///< takes the second of a pasted pair, with the same limits; may be null
};

/// A number that can be dragged, or typed after one click. Returns whether it or its partner changed; gives
/// values within the limits only. What is no number is refused: the value stays.
bool number_field(App& app, const char* id, double& value, const NumberField& field);

/// Call after a text field, so that Tab stops there as well.
void tab_stop(App& app);

/// Whether keys are text now, of a number or of any other field, or will be when a field has been drawn.
bool is_typing(const App& app);
/// What Tab does while nobody types: in a dialog, or right after a number was typed, it goes to a field.
bool tab_into_field(App& app, bool back);
/// Whether the active field is one that Tab leaves by tab_from_field.
bool is_at_tab_stop(const App& app);
void tab_from_field(App& app, bool back);

void begin_number_fields(App& app);
void end_number_fields(App& app);

/// The clipboard as a number field takes it: on one line, and not too long to be refused.
std::string pasted_number(std::string text);

}  // namespace probewarp
