#include "gui/samples.h"

#include <algorithm>
#include <cmath>

#include "editor/commands.h"
#include "gui/actions.h"
#include "gui/app.h"
#include "gui/shown_text.h"
#include "gui/widgets.h"
#include "io/project.h"
#include "raster/mipmaps.h"

namespace probewarp {

namespace {

constexpr int thumbnail_side = 320;

/// The mipmaps from the smallest that is still at least as large as a thumbnail.
std::vector<Image> thumbnail(const Image& image) {
    std::vector<Image> levels = smaller_levels(image);
    levels.insert(levels.begin(), image);
    const auto large = [](const Image& level) {
        return std::max(level.width, level.height) >= thumbnail_side;
    };
    const auto first_small = std::find_if_not(levels.begin() + 1, levels.end(), large);
    levels.erase(levels.begin(), first_small - 1);
    return levels;
}

void load_thumbnails(App& app) {
    app.samples.begun = true;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(samples_folder(), ignored)) {
        const std::string ending = entry.path().extension().string();
        // A sample project stands for the picture it holds.
        const bool covered =
            ending == ".png" &&
            std::filesystem::exists(std::filesystem::path(entry.path()).replace_extension(project_extension),
                                    ignored);
        if ((ending == ".png" && !covered) || ending == project_extension)
            app.samples.list.push_back({entry.path(), entry.path().stem().string(), 0, 0, {}});
    }
    std::sort(app.samples.list.begin(), app.samples.list.end(),
              [](const auto& a, const auto& b) { return a.path < b.path; });
    for (const Sample& sample : app.samples.list)
        start_job(app, "", JobKind::background, [path = sample.path](Job&) -> std::function<void(App&)> {
            const auto small =
                std::make_shared<const std::vector<Image>>(thumbnail(read_document(path).picture->image));
            return [small, path](App& a) {
                for (Sample& s : a.samples.list)
                    if (s.path == path) {
                        s.texture = preview_texture(*small);
                        s.width = small->front().width;
                        s.height = small->front().height;
                    }
            };
        });
}

void draw_sample(App& app, const Sample& sample, ImVec2 from, ImVec2 size) {
    ImGui::SetCursorScreenPos(from);
    ImGui::PushID(&sample);
    const bool clicked = ImGui::InvisibleButton("##sample", size);
    const bool hovered = ImGui::IsItemHovered();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 to{from.x + size.x, from.y + size.y};
    list->AddRectFilled(from, to, hovered ? app.theme.raised : app.theme.panel, app.px(8));
    list->AddRect(from, to, hovered ? app.theme.accent : app.theme.line, app.px(8));
    const float room_x = size.x - app.px(20), room_y = size.y - app.px(44);
    if (sample.texture.name() != 0) {
        const float fit = std::min(room_x / float(sample.width), room_y / float(sample.height));
        const ImVec2 half{float(sample.width) * fit / 2, float(sample.height) * fit / 2};
        const ImVec2 middle{from.x + size.x / 2, from.y + app.px(10) + room_y / 2};
        list->AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t(sample.texture.name())),
                       {middle.x - half.x, middle.y - half.y}, {middle.x + half.x, middle.y + half.y});
    }
    const float room = size.x - app.px(16), text = ImGui::CalcTextSize(sample.title.c_str()).x;
    draw_shown(app, {std::round(from.x + (size.x - std::min(room, text)) / 2), to.y - app.px(27)}, room + 1,
               app.theme.text, sample.title);
    ImGui::PopID();
    if (hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (clicked) open_path(app, sample.path);
}

}  // namespace

std::filesystem::path samples_folder() {
    std::error_code ignored;
    const std::filesystem::path program =
        std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
    for (const std::filesystem::path& candidate :
         {program / "../share/probewarp/images", program / "../../../images",
          std::filesystem::path(PROBEWARP_DATA_DIR) / "images"})
        if (std::filesystem::is_directory(candidate, ignored))
            return std::filesystem::canonical(candidate, ignored);
    return {};
}

namespace {

/// The samples' cards in rows, within `room` pixels: smaller where it is tight, then fewer.
struct Cards {
    ImVec2 size{0, 0};
    float gap = 0;
    int columns = 0, rows = 0;
};

Cards cards_within(const App& app, ImVec2 room, int count) {
    Cards cards;
    cards.gap = app.px(16);
    for (float part = 1; part >= 0.45f; part -= 0.1f) {
        cards.size = {std::round(app.px(168) * part), std::round(app.px(184) * part)};
        cards.columns =
            std::clamp(int((room.x + cards.gap) / (cards.size.x + cards.gap)), 1, std::max(1, count));
        cards.rows = (count + cards.columns - 1) / cards.columns;
        if (float(cards.rows) * (cards.size.y + cards.gap) - cards.gap <= room.y) return cards;
    }
    cards.rows = std::max(0, int((room.y + cards.gap) / (cards.size.y + cards.gap)));
    return cards;
}

void draw_cards(App& app, const Cards& cards, float middle, float top) {
    const int count = std::min(int(app.samples.list.size()), cards.rows * cards.columns);
    for (int i = 0; i < count; ++i) {
        const int row = i / cards.columns, in_row = std::min(cards.columns, count - row * cards.columns);
        const float width = float(in_row) * (cards.size.x + cards.gap) - cards.gap;
        const float x = middle - width / 2 + float(i % cards.columns) * (cards.size.x + cards.gap);
        const float y = top + float(row) * (cards.size.y + cards.gap);
        draw_sample(app, app.samples.list[std::size_t(i)], {std::round(x), std::round(y)}, cards.size);
    }
}

}  // namespace

void draw_empty_state(App& app, float left, float top, float width, float height) {
    // The window first; and what is being opened goes before thumbnails that may never be seen.
    if (!app.samples.begun && is_busy(app)) return;
    if (!app.samples.begun && app.frames > 0) load_thumbnails(app);
    const auto centred = [&](ImFont* font, const char* text, ImU32 colour, float y) {
        const ImVec2 size = font->CalcTextSizeA(font->FontSize, FLT_MAX, 0, text);
        ImGui::GetWindowDrawList()->AddText(font, font->FontSize,
                                            {std::round(left + (width - size.x) / 2), y}, colour, text);
    };
    const float head = app.px(132);  // what stands above the cards
    const Cards cards =
        cards_within(app, {width - app.px(32), height - head - app.px(24)}, int(app.samples.list.size()));
    const float block = head + float(cards.rows) * (cards.size.y + cards.gap);
    float y = top + std::max(app.px(8), (height - block) / 2);
    centred(app.fonts.large, "Drop a picture here, or open one", app.theme.text, y);
    y += app.px(44);
    ImGui::SetCursorScreenPos({std::round(left + width / 2 - app.px(70)), y});
    if (accent_button(app, "Open a picture", {app.px(140), app.px(32)}, icon::folder))
        run(app.editor, find_command("Open…"));
    y += app.px(60);
    if (app.samples.list.empty()) return;
    centred(app.fonts.small, "or begin with a sample", app.theme.muted, y);
    draw_cards(app, cards, left + width / 2, y + app.px(28));
}

}  // namespace probewarp
