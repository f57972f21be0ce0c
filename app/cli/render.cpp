// `probewarp render`: a picture or a project in, the deformed picture, mesh or project out.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <filesystem>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/drawing.h"
#include "cli/output_kinds.h"
#include "cli/printing.h"
#include "cli/render_many.h"
#include "cli/report.h"
#include "cli/timings.h"
#include "io/file.h"
#include "io/image_file.h"
#include "io/obj.h"
#include "io/probes_csv.h"
#include "io/project.h"
#include "io/same_file.h"

namespace probewarp {

namespace {

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

/// `document`, which is the input's, as the options want it on this picture.
Document posed_on(Document document, PicturePtr picture, const RenderOptions& o) {
    if (picture) replace_picture(document, std::move(picture));
    if (!o.probes_csv.empty()) add_csv_probes(document, o.probes_csv);
    if (!o.blend.empty()) document.blend = o.blend;
    apply(o, document);
    return document;
}

void check_deform(const RenderOptions& o, const Document& document) {
    if (o.deform == "shader" && !find_blend_method(document.blend)->summed)
        throw UsageError(fmt::format(
            "--deform shader: the shader blends by dlb only, this is {}; expected --deform processor",
            document.blend));
}

void check_heat(const RenderOptions& o, const Document& document) {
    if (o.heat.empty()) {
        if (o.opacity || o.iso_lines)
            throw UsageError(
                fmt::format("--{}: expected --heat with it", o.opacity ? "opacity" : "iso-lines"));
        return;
    }
    if (o.heat != "all")
        probe_named(document, o.heat, "--heat");
    else if (document.probes.empty())
        throw UsageError("--heat all: there are no probes");
    else if (o.iso_lines)
        throw UsageError(
            "--iso-lines: these are of one probe's share; expected a probe, not all, with --heat");
}

std::optional<std::filesystem::path> output_path(const RenderOptions& o) {
    if (o.output == "-") return {};
    return o.output;
}

void write_output(const RenderOptions& o, std::span<const std::byte> bytes, Timings& timings) {
    Output output(output_path(o), timings);
    output.write({{bytes.begin(), bytes.end()}});
    output.finish();
}

/// The one picture of `--image`, or null for the input's own.
PicturePtr other_picture(const RenderOptions& o, Pixels pixels) {
    if (o.images.empty()) return nullptr;
    return std::make_shared<Picture>(read_picture(o.images.front(), pixels, {.salvage = o.salvage}));
}

/// Refuses to write over what is read, before anything is.
void check_render_files(const RenderOptions& o, const OutputFormat& format) {
    std::vector<UsedFile> read{{"the input itself", o.input}}, written;
    if (!o.probes_csv.empty()) read.push_back({"the file of --probes", o.probes_csv});
    for (const std::string& image : o.images) read.push_back({"one of the pictures of --image", image});
    if (is_many(o))
        for (const auto& path : output_paths(o)) written.push_back({"-o " + path.string(), path});
    else
        for (const auto& path : written_files(o.output, format))
            written.push_back({"-o " + path.string(), path});
    check_files(read, written);
}

RenderPlan plan_of(const RenderOptions& o, const OutputFormat& format) {
    RenderPlan plan{o, format, {format.image, export_settings(o), {}}};
    PictureFile& file = plan.file;
    file.encode.background = file.settings.background.value_or(file.encode.background);
    file.encode.compression =
        std::ranges::find(compressions(), o.compression, &CompressionName::name)->compression;
    return plan;
}

/// Where it is asked for. view: of a picture; null for another output
void report(const RenderOptions& o, const OutputFormat& format, const Deformation& deformation,
            const View* view) {
    if (o.report) print("{}\n", report_of(o.output, format, deformation, view));
}

void render_picture(const RenderOptions& o, const OutputFormat& format, const Deformation& deformation,
                    Timings& timings) {
    const RenderPlan plan = plan_of(o, format);
    // Refuses what is too large before anything is opened.
    const View view = export_view(deformation, plan.file.settings);
    Progress progress(o.quiet);
    Output output(output_path(o), timings);
    const Picture& picture = *deformation.source.picture;
    const auto encoding = timings.measure(Stage::draw, [&] {
        auto drawn = Drawer(plan).draw(deformation, output, [&](double part) { progress.show(part); });
        wait_for_rows(picture, picture.image.height);  // what does not show must be sound too
        return drawn;
    });
    if (picture.arriving) {  // drawing waited for what was decoded beside it
        const auto [decoding, waiting] = picture.arriving->times();
        timings.add(Stage::decode, decoding);
        timings.add(Stage::draw, -waiting);
    }
    output.write(timings.measure(Stage::encode, [&] { return encoding->finish(); }));
    output.finish();
    report(o, format, deformation, &view);
}

void render_mesh(const RenderOptions& o, const Deformation& deformation, Timings& timings) {
    if (o.output == "-") {
        const std::string text = encode_obj(deformation);
        return write_output(o, std::as_bytes(std::span(text)), timings);
    }
    const ObjContents contents =
        timings.measure(Stage::encode, [&] { return obj_contents(o.output, deformation); });
    timings.measure(Stage::write, [&] { write_obj(contents); });
}

void render_one(const RenderOptions& o, OutputFormat format, Timings& timings) {
    if (o.images.size() > 1)
        throw UsageError(
            fmt::format("-o {}: one file for {} pictures; expected {{name}} in it, such as "
                        "DIR/{{name}}.png",
                        o.output, o.images.size()));
    // A picture is drawn while it is still being decoded.
    const Pixels pixels = format.kind == Kind::image ? Pixels::arriving : Pixels::whole;
    const Document document = timings.measure(Stage::decode, [&] {
        return posed_on(
            read_document(o.input, o.images.empty() ? pixels : Pixels::whole, {.salvage = o.salvage}),
            other_picture(o, pixels), o);
    });
    check_deform(o, document);
    check_heat(o, document);
    Deformation deformation;
    const auto deform = [&] { timings.measure(Stage::weights, [&] { update(deformation, document); }); };
    if (format.kind == Kind::project) {
        write_output(o, encode_project(document), timings);
        if (!o.report) return;
        deform();
        return report(o, format, deformation, nullptr);
    }
    deform();
    if (format.kind == Kind::image) return render_picture(o, format, deformation, timings);
    render_mesh(o, deformation, timings);
    report(o, format, deformation, nullptr);
}

/// `--image A B C`: what would be wrong with every one of them is said before the first.
int render_all(const RenderOptions& o, OutputFormat format, Timings& timings) {
    if (format.kind != Kind::image)
        throw UsageError(
            fmt::format("-o {}: expected a picture's format for --image with {{name}}", o.output));
    const Document base = read_document(o.input, Pixels::whole, {.salvage = o.salvage});
    const Document posed = posed_on(base, nullptr, o);
    check_deform(o, posed);
    check_heat(o, posed);
    return render_many(
        plan_of(o, format), base,
        [&o](const Document& on, PicturePtr picture) { return posed_on(on, std::move(picture), o); },
        timings);
}

/// Bands of rows come and go: their memory is better used again than given back, and cleared, each time.
void keep_freed_memory() {
#ifdef M_MMAP_THRESHOLD
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
}

}  // namespace

int render(const RenderOptions& o) {
    keep_freed_memory();
    Timings timings;
    const OutputFormat format = output_format(o);
    check_options(o, format);
    export_settings(o);  // throws where they cannot be understood
    check_render_files(o, format);
    int code = 0;
    if (is_many(o))
        code = render_all(o, format, timings);
    else
        render_one(o, format, timings);
    if (o.timings && !print_aside(timings.text()) && code == 0) code = 1;  // they were asked for
    return code;
}

}  // namespace probewarp
