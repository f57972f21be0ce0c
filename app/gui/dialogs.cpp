#include "gui/dialogs.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "editor/paint_commands.h"
#include "gui/actions.h"
#include "gui/app.h"
#include "gui/widgets.h"
#include "io/image_file.h"

namespace probewarp {

namespace {

constexpr ImGuiWindowFlags dialog_flags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                          ImGuiWindowFlags_NoSavedSettings |
                                          ImGuiWindowFlags_AlwaysAutoResize;

bool begin_dialog(const App& app, const char* title, float width) {
    if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({app.px(width), 0});
    return ImGui::BeginPopupModal(title, nullptr, dialog_flags);
}

bool escape_pressed() { return ImGui::IsKeyPressed(GLFW_KEY_ESCAPE) && !ImGui::IsAnyItemActive(); }

/// Puts the cursor where `count` buttons of `width` end at the right edge.
void align_buttons(const App& app, int count, float width) {
    const float all = float(count) * app.px(width) + float(count - 1) * ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetCursorPosX(ImGui::GetContentRegionMax().x - all);
}

/// What keeps the export from beginning, or nothing.
std::string export_trouble(const App& app) {
    const ExportDialog& dialog = app.export_dialog;
    const std::filesystem::path path = export_path(app);
    const ImageFormat* format = image_format_of(path);
    if (auto reason = why_not_deformed(app); !reason.empty()) return reason;
    if (!is_obj(path) && (!format || !format->encode))
        return "The name must end with .png, .jpg, .bmp, .tga or .obj.";
    std::error_code ignored;
    if (!std::filesystem::is_directory(path.parent_path(), ignored)) return "There is no such folder.";
    try {
        export_view(app.editor.deformation, dialog.settings);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

void begin_export(App& app) {
    ExportDialog& dialog = app.export_dialog;
    std::error_code ignored;
    if (std::filesystem::exists(export_path(app), ignored) && !dialog.overwrite_asked) {
        dialog.overwrite_asked = true;
        return;
    }
    dialog.open = false;
    ImGui::CloseCurrentPopup();
    export_to(app, export_path(app));
}

/// What the format of the file has to choose from.
void draw_format_settings(App& app, float width) {
    ExportDialog& dialog = app.export_dialog;
    const ImageFormat* format = image_format_of(export_path(app));
    if (format && format->name == "png") {
        const auto names = compressions();
        const auto chosen =
            std::ranges::find(names, dialog.encode.compression, &CompressionName::compression);
        row_label(app, "Compression", 92);
        if (begin_combo(app, "##compression", std::string(chosen->label).c_str(), width)) {
            for (const CompressionName& name : names)
                if (ImGui::Selectable(std::string(name.label).c_str(),
                                      name.compression == dialog.encode.compression))
                    dialog.encode.compression = name.compression;
            ImGui::EndCombo();
        }
        tooltip("The pixels are the same: written soon, or a small file");
    }
    if (format && format->name == "jpeg") {
        row_label(app, "Quality", 92);
        double quality = dialog.encode.quality;
        if (slider_field(app, "##quality", quality, "", width, 1, 100))
            dialog.encode.quality = int(std::lround(quality));
        row_label(app, "", 92);
        ImGui::TextDisabled(dialog.transparent ? "JPEG has no transparency: white is put behind." : "");
    }
}

void draw_export_settings(App& app) {
    ExportDialog& dialog = app.export_dialog;
    const float width = ImGui::GetContentRegionAvail().x - app.px(92);
    double percent = dialog.settings.scale * 100;
    row_label(app, "Scale", 92);
    if (number_field(app, "##scale", percent,
                     {.unit = "%",
                      .measure = NumberUnit::percent,
                      .width = width,
                      .step = 0.5,
                      .least = 0.1,
                      .most = 10000}))
        dialog.settings.scale = percent / 100;

    const int choices[] = {1, 2, 3, 4, 8};
    row_label(app, "Samples", 92);
    const auto text = [](int n) {
        return n == 1 ? std::string("1: exact pixels") : fmt::format("{0} × {0}: smooth edges", n);
    };
    if (begin_combo(app, "##samples", text(dialog.settings.samples).c_str(), width)) {
        for (const int n : choices)
            if (ImGui::Selectable(text(n).c_str(), n == dialog.settings.samples)) dialog.settings.samples = n;
        ImGui::EndCombo();
    }
    row_label(app, "Canvas", 92);
    const char* const canvases[] = {"The picture's rectangle", "All of the deformed picture"};
    if (begin_combo(app, "##canvas", canvases[int(dialog.settings.canvas)], width)) {
        for (const Canvas canvas : {Canvas::image, Canvas::fit})
            if (ImGui::Selectable(canvases[int(canvas)], canvas == dialog.settings.canvas))
                dialog.settings.canvas = canvas;
        ImGui::EndCombo();
    }

    row_label(app, "Background", 92);
    ImGui::Checkbox("Transparent", &dialog.transparent);
    if (!dialog.transparent) {
        ImGui::SameLine();
        ImGui::ColorEdit3("##background", dialog.background, ImGuiColorEditFlags_NoInputs);
    }
    dialog.settings.background.reset();
    const auto byte = [](float v) { return std::uint8_t(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); };
    if (!dialog.transparent)
        dialog.settings.background =
            Colour{byte(dialog.background[0]), byte(dialog.background[1]), byte(dialog.background[2])};

    draw_format_settings(app, width);
}

}  // namespace

void draw_questions(App& app) {
    if (app.questions.empty() || app.file_dialog.open || is_busy(app)) return;
    const Question question = app.questions.front();
    if (!begin_dialog(app, question.title.c_str(), 440)) return;
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(question.text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Dummy({0, app.px(8)});
    std::size_t chosen = question.answers.size();
    align_buttons(app, int(question.answers.size()), 108);
    for (std::size_t i = question.answers.size(); i-- > 0;) {
        const ImVec2 size{app.px(108), app.px(28)};
        const char* label = question.answers[i].label.c_str();
        if (i == 0 ? accent_button(app, label, size) : ImGui::Button(label, size)) chosen = i;
        if (i > 0) ImGui::SameLine();
    }
    if (escape_pressed()) chosen = question.answers.size() - 1;
    if (ImGui::IsKeyPressed(GLFW_KEY_ENTER, false)) chosen = 0;
    if (chosen < question.answers.size()) {
        ImGui::CloseCurrentPopup();
        app.questions.erase(app.questions.begin());
        if (question.answers[chosen].then) question.answers[chosen].then(app);
        app.wake();
    }
    ImGui::EndPopup();
}

void draw_export_dialog(App& app) {
    ExportDialog& dialog = app.export_dialog;
    if (!dialog.open || app.file_dialog.open) return;
    const bool appearing = !ImGui::IsPopupOpen("Export");
    if (!begin_dialog(app, "Export", 520)) return;
    row_label(app, "File", 92);
    if (appearing) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - app.px(96));
    const bool entered = ImGui::InputText(
        "##path", &dialog.path, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::IsItemEdited()) dialog.overwrite_asked = false;
    tab_stop(app);
    ImGui::SameLine();
    if (ImGui::Button("Browse…", {app.px(88), 0})) {
        ImGui::CloseCurrentPopup();
        ask_for_file(app, "Export to", "Choose", true, {".png", ".jpg", ".jpeg", ".bmp", ".tga", ".obj"},
                     dialog.path, [](App& a, const std::filesystem::path& path) {
                         a.export_dialog.path = path.string();
                         std::error_code ignored;  // where it exists, the file dialog has asked
                         a.export_dialog.overwrite_asked = std::filesystem::exists(path, ignored);
                     });
    }
    if (!is_obj(export_path(app))) draw_export_settings(app);

    const std::string trouble = export_trouble(app);
    ImGui::Dummy({0, app.px(2)});
    ImGui::PushStyleColor(ImGuiCol_Text, app.theme.muted);
    ImGui::PushTextWrapPos(0);
    if (!trouble.empty())
        ImGui::TextUnformatted(trouble.c_str());
    else if (dialog.overwrite_asked)
        ImGui::Text("This file exists and will be replaced. Press Export once more.");
    else {
        const View view = export_view(app.editor.deformation, dialog.settings);
        ImGui::Text("%d × %d pixels, %d bits a channel", view.width, view.height,
                    app.editor.document.picture->image.bits());
    }
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::Dummy({0, app.px(2)});
    align_buttons(app, 2, 108);
    const bool cancelled =
        ImGui::Button("Cancel", {app.px(108), app.px(28)}) || (!appearing && escape_pressed());
    ImGui::SameLine();
    if ((accent_button(app, "Export", {app.px(108), app.px(28)}, nullptr, trouble.empty()) || entered) &&
        trouble.empty())
        begin_export(app);
    if (cancelled) {
        dialog.open = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

void draw_levels_dialog(App& app) {
    LevelsDialog& dialog = app.levels_dialog;
    if (!dialog.open || !begin_dialog(app, "Levels", 360)) return;
    constexpr float label = 76;
    const float width = ImGui::GetContentRegionAvail().x - app.px(label);
    row_label(app, "Black", label);
    if (slider_field(app, "##black", dialog.black, "", width, 0, 0.99))
        dialog.white = std::max(dialog.white, dialog.black + 0.01);
    row_label(app, "White", label);
    if (slider_field(app, "##white", dialog.white, "", width, 0.01, 1))
        dialog.black = std::min(dialog.black, dialog.white - 0.01);
    row_label(app, "Gamma", label);
    slider_field(app, "##gamma", dialog.gamma, "", width, 0.1, 4);
    ImGui::TextDisabled("Weights up to black become 0, from white on 1.");
    ImGui::Dummy({0, app.px(4)});
    align_buttons(app, 2, 108);
    if (ImGui::Button("Cancel", {app.px(108), app.px(28)}) || escape_pressed()) dialog.open = false;
    ImGui::SameLine();
    if (accent_button(app, "Apply", {app.px(108), app.px(28)})) {
        dialog.open = false;
        level_paint(app.editor, float(dialog.black), float(dialog.white), float(dialog.gamma));
    }
    if (!dialog.open) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void draw_about(App& app) {
    if (!app.about_open || !begin_dialog(app, "About Probewarp", 460)) return;
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(
        "Deforms pictures with probes, by dual number linear blending of anti-commutative dual "
        "complex numbers (Matsuda, Kaji, Ochiai, arXiv 1601.01754).");
    ImGui::Text("Rendered by %s. MIT licence.", app.renderer_label.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Dummy({0, app.px(4)});
    align_buttons(app, 1, 108);
    if (accent_button(app, "Close", {app.px(108), app.px(28)}) || escape_pressed()) {
        app.about_open = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

}  // namespace probewarp
