#include "cli/drawing.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "cli/arguments.h"
#include "cli/printing.h"
#include "render/driver_drawing.h"
#include "render/overlay.h"

namespace probewarp {

Progress::Progress(bool quiet) : on_(!quiet && isatty(STDERR_FILENO) == 1) {}

void Progress::show(double part) {
    if (!on_ || std::chrono::steady_clock::now() - start_ < std::chrono::seconds(1)) return;
    shown_ = true;
    constexpr std::size_t cells = 30;
    std::string bar(std::size_t(part * double(cells)), '#');
    bar.resize(cells, '.');
    print_aside(fmt::format("\rrendering [{}] {:3.0f} %", bar, part * 100));
}

void Progress::clear() {
    if (shown_) print_aside("\r\x1b[K");
    shown_ = false;
}

Output::Output(const std::optional<std::filesystem::path>& path, Timings& timings) : timings_(timings) {
    if (path) file_.emplace(*path);
}

void Output::write(const FileParts& parts) {
    if (!file_) kept_.insert(kept_.end(), parts.begin(), parts.end());
    if (!file_ || parts.empty()) return;
    timings_.measure(Stage::write, [&] {
        for (const auto& part : parts) file_->write(part);
    });
}

void Output::restart() {
    if (file_) file_->restart();
    kept_.clear();
}

void Output::finish() {
    timings_.measure(Stage::write, [&] {
        if (file_) return file_->finish();
        bool good = true;
        for (const auto& part : kept_)
            good = good && std::fwrite(part.data(), 1, part.size(), stdout) == part.size();
        if (!good || std::fflush(stdout) != 0)
            throw Error("cannot write to standard output: " + std::generic_category().message(errno));
    });
}

namespace {

/// Lays the heat map of the weights over the picture, where it is asked for.
void show_heat(Renderer& renderer, const Deformation& deformation, const RenderOptions& o) {
    if (o.heat.empty()) return;
    const Document& document = deformation.source;
    OverlayStyle style{.heat = o.heat != "all", .iso_lines = o.iso_lines};
    if (o.opacity) style.opacity = float(*o.opacity);
    const int probe = style.heat ? document.probes[probe_named(document, o.heat, "--heat")].id : 0;
    renderer.set_overlay(weight_overlay(deformation, probe), style);
}

/// Whether the processor draws, which needs no context and is quicker than a graphics driver without a card.
bool drawn_by_processor(const RenderPlan& plan) {
    return plan.options.backend == "auto" && plan.options.deform != "shader" && !plan.file.settings.overlay;
}

}  // namespace

/// Hands the picture and its deformed mesh to the renderer, which is made where there is none.
void Drawer::hold(const Deformation& deformation) {
    if (!offscreen_) offscreen_.emplace(plan_.options.backend);
    Renderer& renderer = offscreen_->renderer;
    const Picture& picture = *deformation.source.picture;
    const Image& image = picture.image;
    wait_for_rows(picture, image.height);
    renderer.set_picture(upload_picture(image));
    renderer.set_mesh(deformation.binding->mesh, deformation.binding->still);
    if (plan_.options.deform == "shader") {
        renderer.set_weights(weights_of(deformation));
        renderer.set_pose(deformation.transformations, glm::vec2(centre(image)));
    } else {
        renderer.set_positions(deformation.now, deformation.moved);
    }
    show_heat(renderer, deformation, plan_.options);
}

std::unique_ptr<ImageEncoding> Drawer::draw(const Deformation& deformation, Output& output,
                                            const std::function<void(double)>& show) {
    const ExportSteps steps{[&](const FileParts& parts) { output.write(parts); }, [&] { output.restart(); },
                            show};
    const PictureFile& file = plan_.file;
    if (drawn_by_processor(plan_)) return draw_picture_file(deformation, file, steps);
    hold(deformation);
    const View view = export_view(deformation, file.settings);
    DriverDrawing drawing(offscreen_->renderer, view, file_style(file.settings));
    return draw_picture_file(drawing, deformation, view, file, steps);
}

}  // namespace probewarp
