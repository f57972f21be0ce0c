#include "gui/samples.h"

#include <algorithm>
#include <cmath>

#include "editor/commands.h"
#include "gui/actions.h"
#include "gui/app.h"
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
    const ImVec2 text = ImGui::CalcTextSize(sample.title.c_str());
    list->AddText({std::round(from.x + (size.x - text.x) / 2), to.y - app.px(27)}, app.theme.text,
                  sample.title.c_str());
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

void draw_empty_state(App& app, float left, float top, float width, float height) {
    // The window first; and what is being opened goes before thumbnails that may never be seen.
    if (!app.samples.begun && is_busy(app)) return;
    if (!app.samples.begun && app.frames > 0) load_thumbnails(app);
    const auto centred = [&](ImFont* font, const char* text, ImU32 colour, float y) {
        const ImVec2 size = font->CalcTextSizeA(font->FontSize, FLT_MAX, 0, text);
        ImGui::GetWindowDrawList()->AddText(font, font->FontSize,
                                            {std::round(left + (width - size.x) / 2), y}, colour, text);
    };
    const ImVec2 card{app.px(168), app.px(184)};
    const float gap = app.px(16), block = app.px(140) + card.y;
    float y = top + std::max(0.0f, (height - block) / 2);
    centred(app.fonts.large, "Drop a picture here, or open one", app.theme.text, y);
    y += app.px(44);
    ImGui::SetCursorScreenPos({std::round(left + width / 2 - app.px(70)), y});
    if (accent_button(app, "Open a picture", {app.px(140), app.px(32)}, icon::folder))
        run(app.editor, find_command("Open…"));
    y += app.px(60);
    if (app.samples.list.empty()) return;
    centred(app.fonts.small, "or begin with a sample", app.theme.muted, y);
    y += app.px(28);
    const float count = float(app.samples.list.size());
    float x = left + (width - count * card.x - (count - 1) * gap) / 2;
    for (const Sample& sample : app.samples.list) {
        draw_sample(app, sample, {std::round(x), std::round(y)}, card);
        x += card.x + gap;
    }
}

}  // namespace probewarp
