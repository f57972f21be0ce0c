// `probewarp render`: a picture or a project in, the deformed picture, mesh or project out.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "io/file.h"
#include "io/image_file.h"
#include "io/obj.h"
#include "io/probes_csv.h"
#include "io/project.h"
#include "render/context.h"
#include "render/export.h"
#include "render/overlay.h"

namespace probewarp {

namespace {

enum class Kind { image, mesh, project };

struct OutputFormat {
    Kind kind = Kind::image;
    const ImageFormat* image = nullptr;  ///< of Kind::image
};

OutputFormat output_format(const RenderOptions& o) {
    if (o.output == "-" && o.format.empty()) throw UsageError("-o -: expected --format with it");
    std::string ending = std::filesystem::path(o.output).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c) { return char(std::tolower(c)); });
    if (o.format == "obj" || (o.format.empty() && ending == ".obj")) return {Kind::mesh};
    if (o.format == "probewarp" || (o.format.empty() && ending == project_extension)) return {Kind::project};
    const ImageFormat* format = o.format.empty() ? image_format_of(o.output) : find_image_format(o.format);
    if (!format || !format->encode)
        throw UsageError(fmt::format("{} cannot be written; expected png, jpeg, bmp, tga, obj or probewarp",
                                     o.format.empty() ? o.output : "--format " + o.format));
    return {Kind::image, format};
}

ExportSettings export_settings(const RenderOptions& o) {
    ExportSettings settings;
    settings.scale = o.scale;
    if (!o.size.empty()) settings.size = parse_size(o.size);
    settings.samples = o.samples;
    settings.canvas = o.canvas == "fit" ? Canvas::fit : Canvas::image;
    settings.background = parse_colour(o.background);
    settings.overlay = !o.heat.empty();
    return settings;
}

void add_csv_probes(Document& document, const std::string& path) {
    const auto bytes = read_file(path);
    try {
        const auto probes =
            decode_probes_csv({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, document);
        document.probes.insert(document.probes.end(), probes.begin(), probes.end());
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", path, error.what()));
    }
}

Document document_of(const RenderOptions& o) {
    Document document = read_document(o.input);
    if (!o.image.empty()) replace_picture(document, std::make_shared<const Picture>(read_picture(o.image)));
    if (!o.probes_csv.empty()) add_csv_probes(document, o.probes_csv);
    if (!o.blend.empty()) document.blend = o.blend;
    apply(o, document);
    return document;
}

/// Lays the heat map of the weights over the picture, where it is asked for.
void show_heat(Renderer& renderer, const Deformation& deformation, const RenderOptions& o) {
    if (o.heat.empty()) return;
    const Document& document = deformation.source;
    OverlayStyle style{.heat = o.heat != "all", .iso_lines = o.iso_lines};
    if (o.opacity) style.opacity = float(*o.opacity);
    const int probe = style.heat ? document.probes[probe_named(document, o.heat, "--heat")].id : 0;
    renderer.set_overlay(weight_overlay(deformation, probe), style);
}

void check_deform(const RenderOptions& o, const Document& document) {
    if (o.deform == "shader" && document.blend != "dlb")
        throw UsageError(fmt::format(
            "--deform shader: the shader blends by dlb only, this is {}; expected --deform processor",
            document.blend));
}

void check_heat(const RenderOptions& o, Kind kind, const Document& document) {
    if (o.heat.empty()) {
        if (o.opacity || o.iso_lines)
            throw UsageError(
                fmt::format("--{}: expected --heat with it", o.opacity ? "opacity" : "iso-lines"));
        return;
    }
    if (kind != Kind::image)
        throw UsageError("--heat: this output has no pixels; expected a picture's format");
    if (o.deform == "shader")
        throw UsageError(
            "--heat: the shader that deforms has no colours over it; expected --deform processor");
    if (o.heat != "all")
        probe_named(document, o.heat, "--heat");
    else if (document.probes.empty())
        throw UsageError("--heat all: there are no probes");
    else if (o.iso_lines)
        throw UsageError(
            "--iso-lines: these are of one probe's share; expected a probe, not all, with --heat");
}

/// Shows how far a render is, once it has taken a second and where somebody watches.
class Progress {
  public:
    explicit Progress(bool quiet) : on_(!quiet && isatty(STDERR_FILENO) == 1) {}
    ~Progress() {
        if (shown_) fmt::print(stderr, "\r\x1b[K");
    }
    void show(double part) {
        if (!on_ || std::chrono::steady_clock::now() - start_ < std::chrono::seconds(1)) return;
        shown_ = true;
        fmt::print(stderr, "\rrendering {:3.0f} %", part * 100);
        std::fflush(stderr);
    }

  private:
    bool on_, shown_ = false;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Image rendered(const Document& document, const Deformation& deformation, const ExportSettings& settings,
               const RenderOptions& o) {
    export_view(document, deformation,
                settings);  // refuses a size that is too large before anything is opened
    Progress progress(o.quiet);
    const auto context = open_context(o.backend);
    Renderer renderer;
    renderer.set_picture(upload_picture(document.picture->image));
    renderer.set_mesh(mesh_of(deformation));
    if (o.deform == "shader")
        renderer.set_blend(weights_of(deformation), deformation.transformations,
                           glm::vec2(centre(document.picture->image)));
    else
        renderer.set_positions(deformation.now, deformation.moved);
    show_heat(renderer, deformation, o);
    ExportJob job(renderer, document, deformation, settings);
    while (!job.done()) {
        job.step();
        progress.show(job.progress());
    }
    return job.take();
}

void write_output(const std::string& path, std::span<const std::byte> bytes) {
    if (path != "-") return write_file(path, bytes);
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0)
        throw Error("cannot write to standard output");
}

}  // namespace

void render(const RenderOptions& o) {
    const OutputFormat format = output_format(o);
    const ExportSettings settings = export_settings(o);
    const Document document = document_of(o);
    check_deform(o, document);
    check_heat(o, format.kind, document);
    std::error_code ignored;
    if (format.kind != Kind::project && o.output != "-" &&
        std::filesystem::equivalent(o.input, o.output, ignored))
        throw UsageError(fmt::format("-o {}: this is the input itself; expected another file", o.output));
    if (format.kind == Kind::project) return write_output(o.output, encode_project(document));

    Deformation deformation;
    update(deformation, document);
    if (format.kind == Kind::mesh) {
        const std::string text = encode_obj(document, deformation);
        return write_output(o.output, std::as_bytes(std::span(text)));
    }
    const Image image = rendered(document, deformation, settings, o);
    EncodeOptions encode;
    encode.background = settings.background.value_or(encode.background);
    write_output(o.output, format.image->encode(image, encode));
}

}  // namespace probewarp
