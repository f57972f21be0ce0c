#include "gui/messages.h"

#include <fmt/format.h>

#include <algorithm>

#include "gui/app.h"
#include "gui/widgets.h"

namespace probewarp {

namespace {

constexpr double slide_seconds = 0.18;

double lifetime(Tone tone) { return tone == Tone::done ? 4 : tone == Tone::hint ? 3 : 1e9; }

bool draw_one(App& app, Message& message, float right, float& bottom) {
    const double age = ImGui::GetTime() - message.shown_at;
    const float in = float(std::clamp(age / slide_seconds, 0.0, 1.0));
    const float width = app.px(340);
    ImGui::SetNextWindowPos({right - width * in, bottom}, ImGuiCond_Always, {0, 1});
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, app.px(260)});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, app.theme.raised);
    const std::string id = fmt::format("##message{}", static_cast<const void*>(&message));
    ImGui::Begin(id.c_str(), nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav);
    const char* symbol = message.tone == Tone::done   ? icon::done
                         : message.tone == Tone::hint ? icon::info
                                                      : icon::alert;
    const ImU32 colour = message.tone == Tone::error ? IM_COL32(0xff, 0x9d, 0x5c, 255) : app.theme.accent;
    ImGui::PushStyleColor(ImGuiCol_Text, app.theme.is_light && message.tone == Tone::error
                                             ? IM_COL32(0xb5, 0x4a, 0, 255)
                                             : colour);
    ImGui::PushFont(app.fonts.icons);
    ImGui::TextUnformatted(symbol);
    ImGui::PopFont();
    ImGui::PopStyleColor();
    ImGui::SameLine();
    const bool error = message.tone == Tone::error;
    ImGui::PushTextWrapPos(width - app.px(error ? 76 : 16));
    ImGui::TextUnformatted(message.text.c_str());
    ImGui::PopTextWrapPos();
    bool closed = false;
    if (error) {
        ImGui::SetCursorPos({width - app.px(68), app.px(8)});
        if (icon_button(app, "##copy", icon::copy, "Copy this message"))
            ImGui::SetClipboardText(message.text.c_str());
        ImGui::SetCursorPos({width - app.px(36), app.px(8)});
        closed = icon_button(app, "##close", icon::close, "Close");
    }
    bottom -= ImGui::GetWindowHeight() + app.px(8);
    app.overlays.push_back(
        {ImGui::GetWindowPos(), ImVec2(ImGui::GetWindowPos().x + ImGui::GetWindowWidth(),
                                       ImGui::GetWindowPos().y + ImGui::GetWindowHeight())});
    ImGui::End();
    ImGui::PopStyleColor();
    return !closed;
}

}  // namespace

void say(App& app, Tone tone, std::string text) {
    std::erase_if(app.messages, [&](const Message& m) { return m.text == text; });
    app.messages.push_back({std::move(text), tone, ImGui::GetTime()});
    app.wake();
}

void draw_messages(App& app) {
    std::erase_if(app.messages,
                  [](const Message& m) { return ImGui::GetTime() - m.shown_at > lifetime(m.tone); });
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    float bottom = display.y - app.px(look::status + 16);
    const float right = display.x - app.px(has_picture(app.editor) ? look::panel + 16 : 16);
    for (std::size_t i = app.messages.size(); i-- > 0;)
        if (!draw_one(app, app.messages[i], right, bottom)) {
            app.messages.erase(app.messages.begin() + std::ptrdiff_t(i));
            app.wake();
        }
}

double next_message_change(const App& app) {
    double next = -1;
    for (const Message& message : app.messages) {
        const double age = ImGui::GetTime() - message.shown_at;
        if (age < slide_seconds) return 0;
        if (message.tone == Tone::error) continue;
        const double left = std::max(0.0, lifetime(message.tone) - age) + 0.01;
        next = next < 0 ? left : std::min(next, left);
    }
    return next;
}

}  // namespace probewarp
