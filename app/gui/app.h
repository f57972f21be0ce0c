// Everything the window holds, handed to each of its parts.
#pragma once

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "editor/editor.h"
#include "exporting/picture_file.h"
#include "gui/deform_choice.h"
#include "gui/deform_job.h"
#include "gui/file_dialog.h"
#include "gui/fonts.h"
#include "gui/guard.h"
#include "gui/input.h"
#include "gui/jobs.h"
#include "gui/last_frame.h"
#include "gui/messages.h"
#include "gui/number_field.h"
#include "gui/samples.h"
#include "gui/shown_weights.h"
#include "gui/theme.h"
#include "io/image_file.h"
#include "render/renderer.h"

namespace probewarp {

/// What the canvas texture is drawn from: it is drawn anew only when something differs.
struct Shown {
    PicturePtr picture;
    unsigned long mesh_version = 0, version = 0;
    CanvasView view;
    glm::ivec2 size{0};
    bool mesh = false, folds = false, light = false;
    bool still = false;  ///< the picture stands still under a stroke
    bool bound = false;  ///< with its mesh, rather than as it is while that is being made
    OverlayKey overlay;
    std::vector<DualComplex<float>> pose;  ///< what the vertex shader blends; empty: the processor deforms
    std::string compared;                  ///< the name of the blend at the right of the divider; empty: none
    int divider = 0;                       ///< canvas pixels
    friend bool operator==(const Shown&, const Shown&) = default;
};

/// The dialog that asks how to export.
struct ExportDialog {
    bool open = false;
    ExportSettings settings;
    bool transparent = true;
    float background[3] = {1, 1, 1};
    EncodeOptions encode;  ///< the quality of JPEG, the compression of PNG
    PathField path;
    bool types_path = false;  ///< the path takes the keyboard in the next frame
};

/// The dialog that asks for levels.
struct LevelsDialog {
    bool open = false;
    double black = 0, white = 1, gamma = 1;
};

/// A question with up to three answers.
struct Question {
    std::string title, text;
    struct Answer {
        std::string label;
        std::function<void(App&)> then;  ///< may be empty
    };
    std::vector<Answer> answers;  ///< the first is the blue one, which Return means
    std::size_t escape = 0;       ///< which answer Escape means
    std::size_t focused = 0;      ///< which answer the keyboard is at
};

struct App {
    GLFWwindow* window = nullptr;
    Editor editor;
    std::unique_ptr<Renderer> renderer;
    std::string renderer_label;
    Theme theme = dark_theme();
    Fonts fonts;
    Glyphs glyphs;            ///< of the fonts, beside the usual ones
    float display_scale = 1;  ///< what the display or the person wants
    float scale = 1;          ///< what the window has room for of it
    Input input;
    NumberEdit number;
    glm::dvec2 cursor{0};         ///< window pixels: at the last event
    Shown shown;                  ///< as it was last drawn, or tried to be
    GLuint shown_texture = 0;     ///< 0 before the first time
    bool shown_failed = false;    ///< the renderer may hold anything: it is handed all anew
    PicturePtr uploaded;          ///< the picture that the renderer holds
    WeightsKey overlaid, shaded;  ///< what the renderer's overlay and its shader have; empty: none
    double deform_milliseconds = 0;
    DeformMeasurement deform_measurement;
    std::unique_ptr<DeformJob> deform_job;                   ///< null while none is under way
    std::vector<std::unique_ptr<DeformJob>> abandoned_jobs;  ///< given up, and not yet at their end
    std::shared_ptr<const Binding> last_binding;  ///< whatever document it is of: the next one starts from it
    std::optional<DeformFailure> failure;         ///< why the weights could not be worked out
    std::optional<std::size_t> folds;             ///< folded triangles; empty where nobody has counted them
    unsigned long folds_version = 0;              ///< of the deformation that they are of
    std::optional<MeshPoint> under;               ///< of the deformed mesh under the pointer
    std::vector<double> shares;                   ///< #probes: there; empty beside the picture

    Jobs jobs;
    std::vector<Message> messages;
    Trouble trouble;        ///< what went wrong and is not said yet
    int failed_frames = 0;  ///< one after the other; from the second on they come without the picture
    std::vector<std::pair<ImVec2, ImVec2>> overlays;  ///< what lies over the canvas in this frame
    ImRect dialog_box;                                ///< where dialogs lie in this frame; empty: none
    FileDialog file_dialog;
    ExportDialog export_dialog;
    LevelsDialog levels_dialog;
    std::vector<Question> questions;  ///< asked one after the other
    std::optional<Question> doubt;    ///< asked over the dialog that is open, before that goes on
    bool about_open = false;
    Samples samples;
    std::vector<std::filesystem::path> pictures_read;  ///< files of the document's pictures, the newest last
    std::filesystem::path last_folder;                 ///< where a dialog last chose a file; empty: nowhere
    bool modal = false;  ///< a dialog is open: the canvas and the shortcuts rest
    bool probes_open = true, probe_open = true, brush_open = true, deformation_open = true,
         weights_open = true, limits_open = false;
    double busy_since = -1;  ///< seconds of ImGui's clock; negative while nothing blocks
    ImGuiID field = 0;       ///< the item of the panel field being edited
    int renaming = 0;        ///< probe id
    int listed = 0;          ///< probe id: chosen when the list was last drawn
    std::string new_name;
    std::string field_label;  ///< of the panel field being edited
    bool quit = false;
    LastFrame last_frame;
    bool redraws = true;       ///< the next frame is drawn though the toolkit draws the same
    unsigned long frames = 0;  ///< drawn
    int frames_wanted = 3;     ///< ImGui settles within a few frames of an event

    /// Sizes of the design in pixels of this window.
    float px(double design) const { return float(design) * scale; }
    void wake() { frames_wanted = 3; }
};

/// The canvas's upper left corner, window pixels.
inline ImVec2 canvas_corner(const App& app) { return {app.px(look::tools), app.px(look::menu)}; }

}  // namespace probewarp
