// Everything the window holds, handed to each of its parts.
#pragma once

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "editor/editor.h"
#include "exporting/picture_file.h"
#include "gui/deform_choice.h"
#include "gui/deform_job.h"
#include "gui/file_dialog.h"
#include "gui/fonts.h"
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
    bool mesh = false, light = false;
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
    std::string path;
    bool overwrite_asked = false;  ///< the path exists and the person was told so
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
    std::vector<Answer> answers;  ///< the first is the blue one, the last is what Escape means
};

struct App {
    GLFWwindow* window = nullptr;
    Editor editor;
    std::unique_ptr<Renderer> renderer;
    std::string renderer_label;
    Theme theme = dark_theme();
    Fonts fonts;
    float scale = 1;
    Input input;
    NumberEdit number;
    glm::dvec2 cursor{0};         ///< window pixels: at the last event
    Shown shown;                  ///< as it was last drawn, or tried to be
    GLuint shown_texture = 0;     ///< 0 before the first time
    PicturePtr uploaded;          ///< the picture that the renderer holds
    WeightsKey overlaid, shaded;  ///< what the renderer's overlay and its shader have; empty: none
    double deform_milliseconds = 0;
    DeformMeasurement deform_measurement;
    std::unique_ptr<DeformJob> deform_job;                   ///< null while none is under way
    std::vector<std::unique_ptr<DeformJob>> abandoned_jobs;  ///< given up, and not yet at their end
    std::shared_ptr<const Binding> last_binding;  ///< whatever document it is of: the next one starts from it
    std::optional<DeformFailure> failure;         ///< why the weights could not be worked out
    std::optional<MeshPoint> under;               ///< of the deformed mesh under the pointer
    std::vector<double> shares;                   ///< #probes: there; empty beside the picture

    Jobs jobs;
    std::vector<Message> messages;
    std::vector<std::pair<ImVec2, ImVec2>> overlays;  ///< what lies over the canvas in this frame
    FileDialog file_dialog;
    ExportDialog export_dialog;
    LevelsDialog levels_dialog;
    std::vector<Question> questions;  ///< asked one after the other
    bool about_open = false;
    Samples samples;
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
