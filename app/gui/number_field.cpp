#include "gui/number_field.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "gui/app.h"
#include "gui/widgets.h"

namespace probewarp {

namespace {

constexpr double drag_slack = 3;  // pixels at scale 1 that a click may tremble

double rounded(double value, int decimals) {
    const double unit = std::pow(10, decimals);
    return std::round(value * unit) / unit;
}

std::string shown_number(double value, int decimals) {
    std::string text = fmt::format("{:.{}f}", value, decimals);
    const bool zero = text.find_first_not_of("-0.") == std::string::npos;
    if (zero && text[0] == '-') text.erase(0, 1);
    return text;
}

/// With as many decimals as the value has, up to six: what is typed in begins as it.
std::string text_to_type(double value, int decimals) {
    for (; decimals < 6; ++decimals)
        if (std::abs(rounded(value, decimals) - value) < 1e-9) break;
    return shown_number(value, decimals);
}

struct Typed {
    double value = 0;
    std::optional<double> partner;  ///< empty: it keeps what it had before
};

std::optional<Typed> typed_value(const NumberEdit& edit, const NumberField& field) {
    const auto within = [&](double value) { return std::clamp(value, field.least, field.most); };
    const std::string_view text(edit.text.data());
    if (text == edit.first_text) return Typed{edit.before, {}};
    if (const auto number = parse_number(text, field.measure)) return Typed{within(*number), {}};
    if (!field.partner) return {};
    if (const auto pair = parse_pair(text, field.measure))
        return Typed{within((*pair)[0]), within((*pair)[1])};
    return {};
}

/// Returns whether something changed.
bool put(double& value, const NumberEdit& edit, const NumberField& field, const Typed& typed) {
    bool changed = std::exchange(value, typed.value) != typed.value;
    if (field.partner) {
        const double partner = typed.partner.value_or(edit.partner_before);
        changed |= std::exchange(*field.partner, partner) != partner;
    }
    return changed;
}

bool put_back(double& value, const NumberEdit& edit, const NumberField& field) {
    return put(value, edit, field, {edit.before, {}});
}

void begin_typing(App& app, ImGuiID id, double value, const NumberField& field) {
    NumberEdit& edit = app.number;
    edit.id = id;
    edit.wanted = edit.pressed = 0;
    edit.before = value;
    edit.partner_before = field.partner ? *field.partner : 0;
    edit.first_text = text_to_type(value, field.decimals);
    edit.text = {};
    std::copy(edit.first_text.begin(), edit.first_text.end(), edit.text.begin());
    edit.starts = true;
    edit.refused = edit.scrolled = false;
    edit.key = FieldKey::none;
    edit.opened = app.editor.opened;
    edit.selected = app.editor.selected;
    app.wake();
}

/// The first characters of what was typed, for a message.
std::string shortened(const char* text) {
    const char* end = text;
    for (int k = 0; k < 40 && *end; ++k) {
        unsigned point = 0;
        end += ImTextCharFromUtf8(&point, end, nullptr);
    }
    return std::string(text, end) + (*end ? "…" : "");
}

/// Typing ends; what is no number is given up, and a hint says so.
bool end_typing(App& app, double& value, const NumberField& field) {
    NumberEdit& edit = app.number;
    edit.last = std::exchange(edit.id, 0);
    app.wake();
    if (const auto typed = typed_value(edit, field)) return put(value, edit, field, *typed);
    say(app, Tone::hint,
        fmt::format("“{}” is no number: {} stays.", shortened(edit.text.data()),
                    shown_number(edit.before, field.decimals)));
    return put_back(value, edit, field);
}

/// The stop after or before another one of the same window, round and round; 0 where it has none.
ImGuiID neighbour(const NumberEdit& edit, ImGuiID window, ImGuiID of, bool back) {
    std::vector<ImGuiID> stops;
    for (const NumberEdit::Stop& stop : edit.stops)
        if (stop.window == window) stops.push_back(stop.id);
    if (stops.empty()) return 0;
    const auto at = std::find(stops.begin(), stops.end(), of);
    if (at == stops.end()) return back ? stops.back() : stops.front();
    if (back) return at == stops.begin() ? stops.back() : *(at - 1);
    return at + 1 == stops.end() ? stops.front() : *(at + 1);
}

ImGuiID window_of(const NumberEdit& edit, ImGuiID id) {
    const auto found = std::ranges::find(edit.stops, id, &NumberEdit::Stop::id);
    return found == edit.stops.end() ? 0 : found->window;
}

void want_neighbour(App& app, ImGuiID window, ImGuiID of, bool back) {
    app.number.wanted = neighbour(app.number, window, of, back);
    app.number.scrolled = false;
    app.wake();
}

/// Does what a key asks of the field that is typed in. Returns whether the value changed.
bool obey_key(App& app, double& value, const NumberField& field) {
    NumberEdit& edit = app.number;
    const FieldKey key = std::exchange(edit.key, FieldKey::none);
    if (key == FieldKey::none) return false;
    if (key != FieldKey::take_back && key != FieldKey::leave && !typed_value(edit, field)) {
        edit.refused = true;
        return false;
    }
    const ImGuiID id = edit.id;
    bool changed = false;
    if (key == FieldKey::take_back) {
        changed = put_back(value, edit, field);
        edit.last = std::exchange(edit.id, 0);
        edit.took_back = true;
    } else {
        changed = end_typing(app, value, field);
    }
    if (key == FieldKey::next || key == FieldKey::previous)
        want_neighbour(app, window_of(edit, id), id, key == FieldKey::previous);
    if (ImGui::GetActiveID() == id) ImGui::ClearActiveID();
    return changed;
}

void draw_unit(App& app, const NumberField& field, ImVec2 from, ImVec2 to, float text_width) {
    ImFont* font = app.fonts.small;
    const float width = font->CalcTextSizeA(font->FontSize, FLT_MAX, 0, field.unit).x;
    const float left = to.x - width - app.px(8);
    if (left < from.x + app.px(12) + text_width) return;
    ImGui::GetWindowDrawList()->AddText(font, font->FontSize,
                                        {left, std::round((from.y + to.y - font->FontSize) / 2)},
                                        faded(app.theme.muted, ImGui::GetStyle().Alpha), field.unit);
}

/// Below the field, so that it hides none of what is typed, and within the window.
void explain_refusal(App& app, const NumberField& field, ImVec2 from, ImVec2 to) {
    const std::string text = fmt::format("This is no number. Escape brings {} back.",
                                         shown_number(app.number.before, field.decimals));
    const float width = ImGui::CalcTextSize(text.c_str()).x + app.px(28);
    ImGui::SetNextWindowPos({std::min(from.x, ImGui::GetIO().DisplaySize.x - width), to.y + app.px(4)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {app.px(10), app.px(6)});
    ImGui::BeginTooltip();
    ImGui::TextUnformatted(text.c_str());
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

bool type_number(App& app, const char* name, double& value, const NumberField& field) {
    NumberEdit& edit = app.number;
    const std::string_view text(edit.text.data());
    const bool wrong = edit.refused || (!typed_value(edit, field) && !is_unfinished_number(text));
    if (std::exchange(edit.starts, false)) {
        GImGui->NavActivateInputId = edit.id;
        GImGui->NavActivateFlags = ImGuiActivateFlags_None;
    }
    const float above = (app.px(look::field) - ImGui::GetFontSize()) / 2;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {app.px(field.bare ? 4 : 8), above});
    ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, app.px(1.5));
    ImGui::PushStyleColor(ImGuiCol_Border, wrong ? app.theme.warning : app.theme.accent);
    ImGui::PushStyleColor(ImGuiCol_FrameBg, app.theme.canvas);
    ImGui::PushStyleColor(ImGuiCol_TextSelectedBg, faded(app.theme.accent, 0.35f));
    ImGui::SetNextItemWidth(field.width);
    const bool edited =
        ImGui::InputText(name, edit.text.data(), edit.text.size(), ImGuiInputTextFlags_AutoSelectAll);
    ImGui::PopStyleColor(3);
    ImGui::PopStyleVar(2);
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    if (!field.bare) draw_unit(app, field, from, to, ImGui::CalcTextSize(edit.text.data()).x);
    bool changed = false;
    if (edited) {
        edit.refused = false;
        if (const auto typed = typed_value(edit, field); typed && !field.when_left)
            changed = put(value, edit, field, *typed);
        else
            changed = put_back(value, edit, field);
    }
    if (!ImGui::IsItemActive()) return end_typing(app, value, field) || changed;
    if (edit.refused) explain_refusal(app, field, from, to);
    return changed;
}

/// What the mouse does that holds the field. Returns whether the value changed.
bool drag_number(App& app, double& value, const NumberField& field) {
    NumberEdit& edit = app.number;
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemActivated()) {
        edit.pressed = ImGui::GetItemID();
        edit.before = edit.dragged = value;
        edit.partner_before = field.partner ? *field.partner : 0;
        edit.drags = false;
        edit.key = FieldKey::none;
    }
    if (std::exchange(edit.key, FieldKey::none) == FieldKey::take_back) {
        ImGui::ClearActiveID();
        edit.pressed = 0;
        edit.took_back = true;
        return put_back(value, edit, field);
    }
    edit.drags = edit.drags || ImGui::IsMouseDragging(0, app.px(drag_slack));
    if (!edit.drags) return false;
    ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    const double pace = (io.KeyShift ? 10 : 1) * (io.KeyAlt ? 0.1 : 1);
    const double way = double(io.MouseDelta.x / app.scale) * field.step * pace;
    if (way == 0) return false;
    edit.dragged = std::clamp(edit.dragged + way, field.least, field.most);
    const double next = std::clamp(rounded(edit.dragged, field.decimals), field.least, field.most);
    return std::exchange(value, next) != next;
}

void draw_resting(App& app, double value, const NumberField& field) {
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float alpha = ImGui::GetStyle().Alpha;
    const bool disabled = (ImGui::GetItemFlags() & ImGuiItemFlags_Disabled) != 0;
    const bool hovered = ImGui::IsItemHovered() || ImGui::IsItemActive();
    const float line = std::max(1.0f, std::floor(app.px(1)));
    if (!field.bare) list->AddRectFilled(from, to, disabled ? app.theme.panel : app.theme.canvas, app.px(5));
    if (!field.bare || hovered)
        list->AddRect(from, to, hovered ? app.theme.muted : app.theme.line, app.px(5), 0, line);
    std::string text = shown_number(value, field.decimals);
    if (text[0] == '-') text.replace(0, 1, "\u2212");
    if (field.bare && *field.unit) text += fmt::format(" {}", field.unit);
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    const float left = field.bare ? to.x - width - app.px(4) : from.x + app.px(8);
    list->AddText({std::round(left), std::round((from.y + to.y - ImGui::GetFontSize()) / 2)},
                  faded(app.theme.text, alpha), text.c_str());
    if (!field.bare) draw_unit(app, field, from, to, width);
}

/// Not typed in: it can be pressed, and is where Tab may be on its way to.
bool rest_number(App& app, const char* name, double& value, const NumberField& field) {
    NumberEdit& edit = app.number;
    const bool released = ImGui::InvisibleButton(name, {field.width, app.px(look::field)});
    const ImGuiID id = ImGui::GetItemID();
    bool changed = false;
    if (ImGui::IsItemActive()) {
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
        changed = drag_number(app, value, field);
    } else if (edit.pressed == id) {
        edit.pressed = 0;
        if (released && !edit.drags) edit.wanted = id;
    }
    draw_resting(app, value, field);
    if (edit.wanted != id) return changed;
    const ImGuiWindow* window = ImGui::GetCurrentWindow();
    if (!window->ClipRect.Contains(GImGui->LastItemData.Rect) && !edit.scrolled) {
        edit.scrolled = true;
        ImGui::SetScrollHereY(0.5f);
        app.wake();
    } else {
        begin_typing(app, id, value, field);
    }
    return changed;
}

void add_stop(App& app, ImGuiID id) {
    if ((ImGui::GetItemFlags() & ImGuiItemFlags_Disabled) == 0)
        app.number.arriving.push_back({ImGui::GetCurrentWindow()->RootWindow->ID, id});
}

/// The field's text is active. ImGui's own flag for that comes a frame later.
bool is_text_active() {
    const ImGuiContext& g = *GImGui;
    return g.ActiveId != 0 && g.ActiveId == g.InputTextState.ID;
}

}  // namespace

bool number_field(App& app, const char* name, double& value, const NumberField& field) {
    NumberEdit& edit = app.number;
    const ImGuiID id = ImGui::GetID(name);
    if (edit.id == id && (edit.opened != app.editor.opened || edit.selected != app.editor.selected)) {
        edit.id = 0;  // the number is another one by now
        if (ImGui::GetActiveID() == id) ImGui::ClearActiveID();
    }
    bool changed = false;
    if (edit.id == id) {
        edit.drawn = ImGui::GetFrameCount();
        changed = obey_key(app, value, field);
    }
    changed |= edit.id == id ? type_number(app, name, value, field) : rest_number(app, name, value, field);
    if (edit.id == id) edit.drawn = ImGui::GetFrameCount();
    add_stop(app, id);
    return changed;
}

void tab_stop(App& app) {
    const ImGuiID id = ImGui::GetItemID();
    add_stop(app, id);
    if (app.number.wanted != id) return;
    app.number.wanted = 0;
    ImGui::SetKeyboardFocusHere(-1);
    app.wake();
}

bool is_typing(const App& app) { return app.number.id != 0 || app.number.wanted != 0 || is_text_active(); }

bool is_at_tab_stop(const App& app) {
    return is_text_active() && window_of(app.number, ImGui::GetActiveID()) != 0;
}

void tab_from_field(App& app, bool back) {
    const ImGuiID id = ImGui::GetActiveID();
    want_neighbour(app, window_of(app.number, id), id, back);
    if (app.number.wanted == id) app.number.wanted = 0;
}

bool tab_into_field(App& app, bool back) {
    NumberEdit& edit = app.number;
    ImGuiID window = window_of(edit, edit.last);
    if (app.modal && GImGui->NavWindow) window = GImGui->NavWindow->RootWindow->ID;
    if (window == 0) return false;
    want_neighbour(app, window, edit.last, back);
    return edit.wanted != 0;
}

void begin_number_fields(App& app) { app.number.arriving.clear(); }

void end_number_fields(App& app) {
    NumberEdit& edit = app.number;
    edit.stops = edit.arriving;
    // A field that is not there any more is typed in no longer.
    if (edit.id != 0 && edit.drawn != ImGui::GetFrameCount()) edit.id = 0;
    if (edit.id == 0) edit.starts = false;
    if (edit.wanted != 0 && window_of(edit, edit.wanted) == 0) edit.wanted = 0;
    edit.key = FieldKey::none;
}

std::string pasted_number(std::string text) {
    const std::size_t from = text.find_first_not_of(" \t\r\n");
    if (from == std::string::npos) return {};
    text = text.substr(from, text.find_last_not_of(" \t\r\n") + 1 - from);
    // The toolkit drops tabs and ends of lines, and would join the numbers that they part.
    for (std::size_t at = 0; (at = text.find_first_of("\t\r\n", at)) != std::string::npos; at += 2) {
        const std::size_t end = std::min(text.find_first_not_of("\t\r\n", at), text.size());
        text.replace(at, end - at, "; ");
    }
    // What does not fit is not cut off, which would leave another number.
    return text.size() <= max_number_text ? text : "…";
}

}  // namespace probewarp
