#include "gui/dialogs.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "editor/paint_commands.h"
#include "gui/actions.h"
#include "gui/app.h"
#include "gui/shown_text.h"
#include "gui/widgets.h"
#include "io/image_file.h"
#include "io/obj.h"

namespace probewarp {

namespace {

constexpr ImGuiWindowFlags dialog_flags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                          ImGuiWindowFlags_NoSavedSettings |
                                          ImGuiWindowFlags_AlwaysAutoResize;

/// As wide as that, or as the window has room for; what is too high for it scrolls.
bool begin_dialog(App& app, const char* title, float width, ImGuiWindowFlags more = 0) {
    if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float wide = std::min(app.px(width), display.x - app.px(24));
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({wide, 0}, {wide, display.y - app.px(24)});
    if (!ImGui::BeginPopupModal(title, nullptr, dialog_flags | more)) return false;
    keep_messages_off(app);
    return true;
}

bool escape_pressed() { return ImGui::IsKeyPressed(GLFW_KEY_ESCAPE) && !ImGui::IsAnyItemActive(); }

/// Puts the cursor where `count` buttons of `width` end at the right edge.
void align_buttons(const App& app, int count, float width) {
    const float all = float(count) * app.px(width) + float(count - 1) * ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetCursorPosX(ImGui::GetContentRegionMax().x - all);
}

/// All that an export to the path writes.
std::vector<std::filesystem::path> written_files(const std::filesystem::path& path) {
    if (is_obj(path)) return obj_files(path);
    return {path};
}

/// What keeps the export from beginning, or nothing.
std::string export_trouble(const App& app) {
    const ExportDialog& dialog = app.export_dialog;
    const std::filesystem::path path = export_path(app);
    const ImageFormat* format = image_format_of(path);
    if (auto reason = why_not_deformed(app); !reason.empty()) return reason;
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) return "This is a folder: type a name behind it.";
    if (!has_stem(path)) return "The file needs a name before its ending.";
    if (!is_obj(path) && (!format || !format->encode))
        return "The name must end with .png, .jpg, .bmp, .tga or .obj.";
    if (!std::filesystem::is_directory(path.parent_path(), ignored)) return "There is no such folder.";
    for (const std::filesystem::path& file : written_files(path))
        if (is_being_read(app, file))
            return file == path
                       ? "This is the file that is open here: choose another name."
                       : "Beside it the file that is open here would be written over: choose another name.";
    try {
        export_view(app.editor.deformation, dialog.settings);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

void begin_export(App& app) {
    const std::filesystem::path path = export_path(app);  // it may hang on the last folder
    app.export_dialog.open = false;
    app.last_folder = path.parent_path();
    export_to(app, path);
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

namespace {

/// Which answer the keys mean; none where there is no such key. Arrows and Tab go from answer to answer.
std::optional<std::size_t> answer_by_key(Question& question) {
    const std::size_t count = question.answers.size();
    const bool back = ImGui::IsKeyPressed(GLFW_KEY_TAB) && ImGui::GetIO().KeyShift;
    // The first stands at the right.
    if (ImGui::IsKeyPressed(GLFW_KEY_RIGHT) || back)
        question.focused = (question.focused + count - 1) % count;
    if (ImGui::IsKeyPressed(GLFW_KEY_LEFT) || (ImGui::IsKeyPressed(GLFW_KEY_TAB) && !back))
        question.focused = (question.focused + 1) % count;
    if (ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false)) return question.escape;
    for (const int key : {GLFW_KEY_ENTER, GLFW_KEY_KP_ENTER, GLFW_KEY_SPACE})
        if (ImGui::IsKeyPressed(key, false)) return question.focused;
    return {};
}

float button_width(const App& app, const std::string& label) {
    return std::max(app.px(88), ImGui::CalcTextSize(label.c_str()).x + app.px(28));
}

/// The answers' buttons: the usual one at the right, the others apart at the left.
std::optional<std::size_t> draw_answers(App& app, const Question& question) {
    std::optional<std::size_t> clicked;
    const auto draw = [&](std::size_t i) {
        const std::string& label = question.answers[i].label;
        const ImVec2 size{button_width(app, label), app.px(30)};
        if (i == 0 ? accent_button(app, label.c_str(), size) : ImGui::Button(label.c_str(), size))
            clicked = i;
        if (i != question.focused || (i == 0 && question.focused == 0)) return;
        const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
        const float out = app.px(3);
        ImGui::GetWindowDrawList()->AddRect({from.x - out, from.y - out}, {to.x + out, to.y + out},
                                            app.theme.accent, app.px(7), 0, app.px(1.5));
    };
    for (std::size_t i = 1; i < question.answers.size(); ++i) {
        draw(i);
        ImGui::SameLine();
    }
    ImGui::SetCursorPosX(ImGui::GetContentRegionMax().x - button_width(app, question.answers[0].label));
    draw(0);
    return clicked;
}

/// Draws the question in a dialog of its own. The answer, once there is one.
std::optional<std::size_t> draw_question(App& app, Question& question, const char* id) {
    if (!begin_dialog(app, id, 424, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoNavInputs)) return {};
    ImGui::PushFont(app.fonts.strong);
    draw_wrapped(app, question.title, 2);
    ImGui::PopFont();
    ImGui::Dummy({0, app.px(2)});
    draw_wrapped(app, question.text, 8);
    ImGui::Dummy({0, app.px(10)});
    // The key that led to the question is none of its answers.
    const bool appearing = ImGui::IsWindowAppearing();
    const auto by_key = appearing ? std::nullopt : answer_by_key(question);
    const auto clicked = draw_answers(app, question);
    const auto answer = clicked ? clicked : by_key;
    if (answer) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return answer;
}

void give_answer(App& app, const Question& question, std::size_t answer) {
    if (question.answers[answer].then) question.answers[answer].then(app);
    app.wake();
}

}  // namespace

void draw_questions(App& app) {
    if (app.questions.empty() || app.file_dialog.open || is_busy(app)) return;
    const auto answer = draw_question(app, app.questions.front(), "##question");
    if (!answer) return;
    const Question question = app.questions.front();
    app.questions.erase(app.questions.begin());
    give_answer(app, question, *answer);
}

void ask_before_replacing(App& app, const std::filesystem::path& path, std::function<void(App&)> then) {
    app.doubt = Question{
        fmt::format("Replace {}?", path.filename().string()),
        fmt::format("A file of this name is there already: {}. It would be lost.", age_and_size(path)),
        {{"Cancel", {}}, {"Replace", std::move(then)}}};
    app.wake();
}

void draw_doubt(App& app) {
    if (!app.doubt) return;
    const auto answer = draw_question(app, *app.doubt, "##doubt");
    if (!answer) return;
    const Question question = *std::exchange(app.doubt, {});
    give_answer(app, question, *answer);
}

namespace {

void browse_for_export(App& app) {
    ask_for_file(app, "Export to", "Choose", FileUse::name, {".png", ".jpg", ".jpeg", ".bmp", ".tga", ".obj"},
                 export_path(app),
                 [](App& a, const std::filesystem::path& path) { a.export_dialog.path.put(path); });
}

/// The path's row. Returns whether Return was pressed in it.
bool draw_export_path(App& app, bool appearing) {
    row_label(app, "File", 92);
    if (std::exchange(app.export_dialog.types_path, false) || appearing) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - app.px(96));
    const bool entered =
        ImGui::InputText("##path", &app.export_dialog.path.text,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    app.glyphs.ask(app.export_dialog.path.text);
    tab_stop(app);
    ImGui::SameLine();
    if (ImGui::Button("Browse…", {app.px(88), 0})) {
        ImGui::CloseCurrentPopup();
        browse_for_export(app);
    }
    return entered;
}

/// Below the settings: what keeps the export from beginning, what it would replace, or what it will be.
void draw_export_remark(App& app, const std::string& trouble, bool replaces) {
    std::string remark = trouble;
    const std::filesystem::path path = export_path(app);
    if (remark.empty() && replaces)
        remark = fmt::format("{} is there already: {}.", path.filename().string(), age_and_size(path));
    if (remark.empty() && is_obj(path)) {
        const ObjCompanions beside = obj_companions(path);
        remark = fmt::format("{} vertices; beside it {} and {}.", mesh_of(app.editor.deformation).rest.size(),
                             beside.material.filename().string(), beside.texture.filename().string());
    }
    if (remark.empty()) {
        const View view = export_view(app.editor.deformation, app.export_dialog.settings);
        remark = fmt::format("{} × {} pixels, {} bits a channel", view.width, view.height,
                             app.editor.document.picture->image.bits());
    }
    ImGui::PushStyleColor(ImGuiCol_Text, replaces || !trouble.empty() ? app.theme.warning : app.theme.muted);
    draw_wrapped(app, remark, 3);
    ImGui::PopStyleColor();
}

}  // namespace

void draw_export_dialog(App& app) {
    ExportDialog& dialog = app.export_dialog;
    if (!dialog.open || app.file_dialog.open) return;
    const bool appearing = !ImGui::IsPopupOpen("Export");
    if (!begin_dialog(app, "Export", 520)) return;
    const bool entered = draw_export_path(app, appearing);
    if (!is_obj(export_path(app))) draw_export_settings(app);

    const std::string trouble = export_trouble(app);
    std::error_code ignored;
    const bool replaces = trouble.empty() && std::filesystem::exists(export_path(app), ignored);
    ImGui::Dummy({0, app.px(2)});
    draw_export_remark(app, trouble, replaces);
    ImGui::Dummy({0, app.px(2)});
    align_buttons(app, 2, 108);
    const bool escaped = !appearing && !app.doubt && escape_pressed();
    if (ImGui::Button("Cancel", {app.px(108), app.px(28)}) || escaped) dialog.open = false;
    ImGui::SameLine();
    const char* action = replaces ? "Replace" : "Export";
    const bool clicked =
        accent_button(app, action, {app.px(108), app.px(28)}, nullptr, trouble.empty()) && trouble.empty();
    if (clicked || (entered && trouble.empty() && !replaces))
        begin_export(app);
    else if (entered && !trouble.empty())
        dialog.types_path = true;
    else if (entered && replaces)
        ask_before_replacing(app, export_path(app), &begin_export);
    draw_doubt(app);
    if (!dialog.open) ImGui::CloseCurrentPopup();
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
    ImGui::Text("Rendered by %s. MIT licence.", shown(app, app.renderer_label).c_str());
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
