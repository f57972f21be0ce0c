#include "gui/shown_text.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gui/app.h"
#include "gui/text_order.h"
#include "gui/widgets.h"
#include "io/printable.h"

namespace probewarp {

namespace {

constexpr std::string_view ellipsis = "…";

float width_of(ImFont* font, const std::string& text) {
    return font->CalcTextSizeA(font->FontSize, FLT_MAX, 0, text.c_str()).x;
}

/// Where the characters of UTF-8 text begin, and its end.
std::vector<std::size_t> boundaries(const std::string& text) {
    std::vector<std::size_t> at;
    for (std::size_t i = 0; i < text.size(); ++i)
        if ((static_cast<unsigned char>(text[i]) & 0xC0u) != 0x80u) at.push_back(i);
    at.push_back(text.size());
    return at;
}

/// `kept` characters of the text: two thirds from its beginning, but its ending where there is room.
std::string with_ellipsis(const std::string& text, const std::vector<std::size_t>& at, std::size_t kept) {
    const std::size_t all = at.size() - 1, dot = text.rfind('.');
    std::size_t tail = kept / 3;
    if (dot != std::string::npos && text.size() - dot <= 12)
        tail = std::max(tail, std::min(kept / 2, text.size() - dot + 2));
    return text.substr(0, at[kept - tail]).append(ellipsis).append(text, at[all - tail]);
}

}  // namespace

std::string shown(App& app, std::string_view text) {
    std::string out = visual_order(printable(text));
    app.glyphs.ask(out);
    return out;
}

std::string shortened(const std::string& text, float width, ImFont* font) {
    if (width_of(font, text) <= width) return text;
    const std::vector<std::size_t> at = boundaries(text);
    std::size_t fits = 0, too_many = at.size();
    while (too_many - fits > 1) {
        const std::size_t middle = (fits + too_many) / 2;
        const bool fit = middle < at.size() && width_of(font, with_ellipsis(text, at, middle)) <= width;
        (fit ? fits : too_many) = middle;
    }
    if (fits == 0 && width_of(font, std::string(ellipsis)) > width) return {};
    return with_ellipsis(text, at, fits);
}

float draw_shown(App& app, ImVec2 at, float width, ImU32 ink, std::string_view text) {
    const std::string whole = shown(app, text), part = shortened(whole, width, ImGui::GetFont());
    ImGui::GetWindowDrawList()->AddText(at, ink, part.c_str());
    const ImVec2 size = ImGui::CalcTextSize(part.c_str());
    if (part != whole && ImGui::IsWindowHovered() &&
        ImGui::IsMouseHoveringRect(at, {at.x + size.x, at.y + size.y}))
        show_tooltip(whole);
    return size.x;
}

void draw_wrapped(App& app, std::string_view text, int lines, float right) {
    const float width = ImGui::GetContentRegionAvail().x - right;
    const std::string whole = shown(app, text);
    // A line ends at a space before its end: of several, each loses about a word.
    float room = width * float(lines);
    std::string part = whole;
    const float most = ImGui::GetTextLineHeight() * (float(lines) + 0.5f);
    while (room > width / 2 && ImGui::CalcTextSize(part.c_str(), nullptr, false, width).y > most) {
        part = shortened(whole, room, ImGui::GetFont());
        room -= width / 4;
    }
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
    ImGui::TextUnformatted(part.c_str());
    ImGui::PopTextWrapPos();
    if (part != whole && ImGui::IsItemHovered()) show_tooltip(whole);
}

}  // namespace probewarp
