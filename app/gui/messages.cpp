#include "gui/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gui/app.h"
#include "gui/shown_text.h"
#include "gui/widgets.h"
#include "io/printable.h"

namespace probewarp {

namespace {

constexpr double fade_seconds = 0.18;
constexpr int most_lines = 8;  // of one message; the whole is in its tooltip and can be copied

double lifetime(Tone tone) { return tone == Tone::done ? 4 : tone == Tone::hint ? 3 : 1e9; }

/// Where messages may lie: [min, max] in window pixels.
using Area = ImRect;

float height_of(const Area& area) { return area.Max.y - area.Min.y; }

/// The lower right of the canvas; where a dialog is open the widest strip beside it.
Area area_of(const App& app) {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float gap = app.px(8), margin = app.px(16);
    const float panel = has_picture(app.editor) ? app.px(look::panel) : 0;
    const float width = std::min(app.px(340), display.x - panel - app.px(look::tools) - margin);
    const float hint = has_picture(app.editor) ? app.px(32) : 0;  // at the canvas's lower edge
    const float right = display.x - panel - gap, bottom = display.y - app.px(look::status) - hint - gap;
    Area area{{right - width, app.px(look::menu) + gap}, {right, bottom}};
    const ImRect& dialog = app.dialog_box;
    if (dialog.GetWidth() <= 0 || !area.Overlaps(dialog)) return area;
    if (display.x - dialog.Max.x >= width + 2 * gap)  // beside it, over the panel, which rests meanwhile
        return {{display.x - gap - width, area.Min.y}, {display.x - gap, bottom}};
    const Area below{{area.Min.x, dialog.Max.y + gap}, {area.Max.x, display.y - gap}};
    const Area above{{area.Min.x, gap}, {area.Max.x, dialog.Min.y - gap}};
    return height_of(below) >= height_of(above) ? below : above;
}

float text_width(const App& app, const Message& message, const Area& area) {
    return area.GetWidth() - app.px(44) - app.px(message.tone == Tone::error ? 72 : 12);
}

float height_of(const App& app, const Message& message, const Area& area) {
    const float width = text_width(app, message, area), line = ImGui::GetTextLineHeight();
    const float text = ImGui::CalcTextSize(message.text.c_str(), nullptr, false, width).y;
    return std::max(app.px(42), std::min(text, line * most_lines) + app.px(24));
}

void draw_symbol(App& app, Tone tone) {
    const char* symbol = tone == Tone::done ? icon::done : tone == Tone::hint ? icon::info : icon::alert;
    const ImVec2 at = ImGui::GetWindowPos();
    draw_icon(app.fonts.icons, {at.x + app.px(22), at.y + app.px(21)},
              tone == Tone::error ? app.theme.warning : app.theme.accent, symbol);
}

/// The two buttons of an error. Returns whether it is to be closed: a click beside its buttons does that too.
bool draw_error_buttons(App& app, const Message& message, float width) {
    ImGui::SetCursorPos({width - app.px(68), app.px(8)});
    if (icon_button(app, "##copy", icon::copy, "Copy this message"))
        ImGui::SetClipboardText(message.text.c_str());
    ImGui::SetCursorPos({width - app.px(36), app.px(8)});
    if (icon_button(app, "##close", icon::close, "Close (Escape)")) return true;
    return ImGui::IsWindowHovered() && !ImGui::IsAnyItemHovered() && ImGui::IsMouseClicked(0);
}

/// Whether nothing lies over the dialog that is open: a list or a menu would be hidden by a box in front.
bool is_dialog_on_top() {
    const ImVector<ImGuiPopupData>& open = ImGui::GetCurrentContext()->OpenPopupStack;
    return !open.empty() && open.back().Window && (open.back().Window->Flags & ImGuiWindowFlags_Modal) != 0;
}

/// A box of that height whose lower edge is at `bottom`.
void begin_box(App& app, const std::string& id, const Area& area, float bottom, float height) {
    ImGui::SetNextWindowPos({area.Min.x, bottom - height});
    ImGui::SetNextWindowSize({area.GetWidth(), height});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, app.theme.raised);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin(id.c_str(), nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
    if (is_dialog_on_top()) ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    app.overlays.emplace_back(ImVec2(area.Min.x, bottom - height), ImVec2(area.Max.x, bottom));
}

/// Returns whether it stays.
bool draw_one(App& app, const Message& message, const Area& area, float bottom, float height) {
    const double age = ImGui::GetTime() - message.shown_at;
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha, float(std::clamp(age / fade_seconds, 0.05, 1.0)));
    begin_box(app, fmt::format("##message{}", message.number), area, bottom, height);
    draw_symbol(app, message.tone);
    ImGui::SetCursorPos({app.px(44), app.px(12)});
    const float right = ImGui::GetContentRegionAvail().x - text_width(app, message, area);
    const int lines = std::max(1, int((height - app.px(20)) / ImGui::GetTextLineHeight()));
    draw_wrapped(app, message.text, lines, right);
    const bool closed = message.tone == Tone::error && draw_error_buttons(app, message, area.GetWidth());
    ImGui::End();
    ImGui::PopStyleVar();
    return !closed;
}

/// Of those that there is no room for: how many.
void draw_rest(App& app, std::size_t count, const Area& area, float bottom, float height) {
    begin_box(app, "##more", area, bottom, height);
    ImGui::SetCursorPos({app.px(16), (height - ImGui::GetFontSize()) / 2});
    ImGui::PushStyleColor(ImGuiCol_Text, app.theme.muted);
    ImGui::TextUnformatted(fmt::format("{} earlier {}", count, count == 1 ? "message" : "messages").c_str());
    ImGui::PopStyleColor();
    ImGui::End();
}

}  // namespace

void say(App& app, Tone tone, std::string text) {
    static unsigned long numbers = 0;
    text = printable(text);
    std::erase_if(app.messages, [&](const Message& m) { return m.text == text; });
    app.messages.push_back({std::move(text), tone, ImGui::GetTime(), ++numbers});
    app.wake();
}

void keep_messages_off(App& app) {
    const ImRect box = ImGui::GetCurrentWindow()->Rect();
    if (app.dialog_box.GetWidth() > 0)
        app.dialog_box.Add(box);
    else
        app.dialog_box = box;
}

bool close_error(App& app) {
    const auto newest = std::find_if(app.messages.rbegin(), app.messages.rend(),
                                     [](const Message& m) { return m.tone == Tone::error; });
    if (newest == app.messages.rend()) return false;
    app.messages.erase(std::next(newest).base());
    return true;
}

void draw_messages(App& app) {
    std::erase_if(app.messages,
                  [](const Message& m) { return ImGui::GetTime() - m.shown_at > lifetime(m.tone); });
    const Area area = area_of(app);
    app.dialog_box = {};
    const float gap = app.px(8), rest = app.px(30);
    float bottom = area.Max.y;
    for (std::size_t i = app.messages.size(); i-- > 0;) {
        Message& message = app.messages[i];
        const float room = bottom - area.Min.y - (i > 0 ? rest + gap : 0);
        const float height = std::min(height_of(app, message, area), std::max(room, 0.0f));
        if (height < app.px(42) || (i + 1 < app.messages.size() && height < height_of(app, message, area))) {
            // Its time begins when it can be read.
            for (std::size_t k = 0; k <= i; ++k) app.messages[k].shown_at = ImGui::GetTime() - fade_seconds;
            if (bottom - rest >= area.Min.y) draw_rest(app, i + 1, area, bottom, rest);
            return;
        }
        if (!draw_one(app, message, area, bottom, height)) {
            app.messages.erase(app.messages.begin() + std::ptrdiff_t(i));
            app.wake();
        }
        bottom -= height + gap;
    }
}

double next_message_change(const App& app) {
    double next = -1;
    for (const Message& message : app.messages) {
        const double age = ImGui::GetTime() - message.shown_at;
        if (age < fade_seconds) return 0;
        if (message.tone == Tone::error) continue;
        const double left = std::max(0.0, lifetime(message.tone) - age) + 0.01;
        next = next < 0 ? left : std::min(next, left);
    }
    return next;
}

}  // namespace probewarp
