#include "cli/drawing.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>

#include "cli/arguments.h"
#include "render/overlay.h"

namespace probewarp {

Progress::Progress(bool quiet) : on_(!quiet && isatty(STDERR_FILENO) == 1) {}

void Progress::show(double part) {
    if (!on_ || std::chrono::steady_clock::now() - start_ < std::chrono::seconds(1)) return;
    shown_ = true;
    constexpr std::size_t cells = 30;
    std::string bar(std::size_t(part * double(cells)), '#');
    bar.resize(cells, '.');
    fmt::print(stderr, "\rrendering [{}] {:3.0f} %", bar, part * 100);
    std::fflush(stderr);
}

void Progress::clear() {
    if (shown_) fmt::print(stderr, "\r\x1b[K");
    shown_ = false;
}

Drawer::Drawer(const RenderPlan& plan) : plan_(plan), context_(open_context(plan.options.backend)) {}

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

}  // namespace

std::unique_ptr<Drawn> Drawer::draw(const Document& document, const Deformation& deformation,
                                    const std::function<void(double)>& show) {
    const Image& picture = document.picture->image;
    renderer_.set_picture(upload_picture(picture));
    renderer_.set_mesh(mesh_of(deformation));
    if (plan_.options.deform == "shader") {
        renderer_.set_weights(weights_of(deformation));
        renderer_.set_pose(deformation.transformations, glm::vec2(centre(picture)));
    } else {
        renderer_.set_positions(deformation.now, deformation.moved);
    }
    show_heat(renderer_, deformation, plan_.options);
    auto drawn = std::make_unique<Drawn>(renderer_, document, deformation, plan_);
    while (!drawn->job.done()) {
        drawn->job.step();
        drawn->encoding.advance(drawn->job.finished_rows());
        show(drawn->job.progress());
    }
    return drawn;
}

}  // namespace probewarp
