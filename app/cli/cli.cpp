#include "cli/cli.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <span>
#include <sstream>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/printing.h"
#include "cli/process.h"
#include "io/image_file.h"
#include "io/printable.h"
#include "model/deform.h"
#include "model/instruction_set.h"
#include "model/weights.h"

namespace probewarp {

namespace {

/// The names of a table's rows: "dlb, spiral".
template <class Rows>
std::vector<std::string> names(const Rows& rows) {
    std::vector<std::string> all;
    for (const auto& row : rows) all.emplace_back(row.name);
    return all;
}

void add_backend(CLI::App& command, std::string& backend) {
    command
        .add_option("--backend", backend,
                    "what draws: osmesa, egl, or auto: the processor, but for --heat and --deform shader "
                    "the first of the two that works")
        ->check(CLI::IsMember({"auto", "osmesa", "egl"}))
        ->envname("PROBEWARP_BACKEND");
}

void add_salvage(CLI::App& command, bool& salvage) {
    command.add_flag("--salvage", salvage,
                     "Open what is there of a picture that ends too soon; the rest is clear or black");
}

/// CLI::Range lets NaN pass.
CLI::Validator range(double low, double high) {
    const std::string wanted = fmt::format("{:g} to {:g}", low, high);
    return {[=](const std::string& text) {
                const double value = std::strtod(text.c_str(), nullptr);
                return value >= low && value <= high ? "" : "Value " + text + " not in range " + wanted;
            },
            wanted};
}

/// Of what names a file or a folder.
const CLI::Validator not_empty(
    [](std::string& text) { return text.empty() ? std::string("is empty; expected a name") : std::string(); },
    "");

std::string check_threshold(const std::string& text) {
    int value = -1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    if (text == "none" || (whole && value >= 0 && value <= 254)) return "";
    return "Value " + text + " is neither in range 0 to 254 nor none";
}

void add_binding(CLI::App& command, BindingOptions& o) {
    command
        .add_option("--probe", o.probes,
                    "RX,RY[:X,Y[,DEG[,RADIUS]]]: rest, and where it is now; image pixels and degrees")
        ->expected(1)
        ->take_all();
    command.add_option("--mesh", o.mesh, "Cells along the longer side")
        ->check(CLI::Range(min_cells, max_cells));
    command
        .add_option(
            "--alpha-threshold", o.alpha_threshold,
            "The mesh covers the pixels whose alpha is above this, 0 to 254; none: all of the picture")
        ->check(check_threshold);
    command.add_option("--alpha-margin", o.alpha_margin, "Image pixels around them that it covers too")
        ->check(range(0, max_mesh_margin));
    command.add_option("--weights", o.weights, "Weight scheme")
        ->check(CLI::IsMember(names(weight_schemes())));
    command.add_option("--exponent", o.exponent, "Of the distance, in the schemes that go by it")
        ->check(range(min_exponent, max_exponent));
    command.add_option("--falloff", o.falloff, "Reaches beyond which a probe has no weight; 0: none")
        ->check(range(0, max_falloff));
    command.add_option("--most", o.most, "Probes that a vertex may follow, the heaviest; 0: all")
        ->check(CLI::Range(0, max_most));
}

void add_render(CLI::App& app, RenderOptions& o) {
    CLI::App* command = app.add_subcommand("render", "Deform a picture or a project and write the result");
    command->add_option("INPUT", o.input, "A picture or a project")->required()->check(not_empty);
    command
        ->add_option(
            "-o,--output", o.output,
            "PNG, JPEG, BMP, TGA, OBJ (the mesh; its material NAME.mtl and the picture "
            "NAME-texture.png are written beside it) or probewarp (a project); - for standard output, "
            "where OBJ comes without these two")
        ->required()
        ->check(not_empty);
    command->add_option("--probes", o.probes_csv, "Add the probes of a CSV file of the iPad program")
        ->check(not_empty);
    command
        ->add_option(
            "--image", o.images,
            "Put another picture under the probes; several, one after the other, where OUTPUT is such "
            "as DIR/{name}.png")
        ->expected(1, CLI::detail::expected_max_vector_size)
        ->check(not_empty);
    add_binding(*command, o);
    command->add_option("--blend", o.blend, "Blend method")->check(CLI::IsMember(names(blend_methods())));
    auto* scale =
        command->add_option("--scale", o.scale, "Exported pixels per image pixel")->check(range(1e-4, 1e4));
    command->add_option("--size", o.size, "WxH: fit into exactly this many pixels")->excludes(scale);
    command->add_option("--samples", o.samples, "N x N samples a pixel")->check(CLI::Range(1, 16));
    command
        ->add_option("--canvas", o.canvas, "image: the picture's rectangle; fit: all of the deformed picture")
        ->check(CLI::IsMember({"image", "fit"}));
    command->add_option("--background", o.background, "#rrggbb, white, black or none");
    command->add_option("--format", o.format,
                        "png, jpeg, bmp, tga, obj or probewarp, whatever OUTPUT ends with");
    command->add_option("--compression", o.compression, "Of PNG: fast, default or small")
        ->check(CLI::IsMember(names(compressions())));
    command->add_option("--heat", o.heat,
                        "Lay the weights of the probe of that name or number over the picture; all: all "
                        "probes' colours, mixed by their weights");
    command->add_option("--opacity", o.opacity, "Of the weights laid over the picture")->check(range(0, 1));
    command->add_flag("--iso-lines", o.iso_lines,
                      "A line at every tenth of the weight laid over the picture");
    add_backend(*command, o.backend);
    command
        ->add_option("--deform", o.deform,
                     "auto, processor or shader: which one moves the vertices; auto: the processor, which is "
                     "the quicker one for a picture that is drawn once")
        ->check(CLI::IsMember(names(deform_by_names)));
    add_salvage(*command, o.salvage);
    command->add_flag(
        "--report", o.report,
        "Tell on standard output what was written, as a JSON object a line: its files, where its "
        "canvas lies on the picture, how many triangles are folded");
    command->add_flag("--timings", o.timings, "Tell where the time goes, on standard error");
    command->add_flag("--quiet", o.quiet, "Show no progress");
}

void add_weights(CLI::App& app, WeightsOptions& o) {
    CLI::App* command = app.add_subcommand(
        "weights", "Write each probe's weights as a 16-bit grey PNG, or read such maps as paint");
    command->add_option("INPUT", o.input, "A picture or a project")->required()->check(not_empty);
    command->add_option("-o,--output", o.output, "The folder to write to, which is made where missing")
        ->check(not_empty);
    add_binding(*command, o);
    command->add_option("--size", o.size, "WxH: pixels of the maps, instead of the picture's");
    command
        ->add_option(
            "--import", o.imports,
            "NAME=FILE.png: paint the probe of that name or number with this map, of any size; grey is "
            "its share, alpha where it is painted")
        ->expected(1)
        ->take_all();
    command->add_option("--save", o.save, "FILE.probewarp: write the project with what was imported")
        ->check(not_empty);
    add_salvage(*command, o.salvage);
    command->add_flag("--quiet", o.quiet, "Do not tell what is written");
}

void add_info(CLI::App& app, InfoOptions& o) {
    CLI::App* command = app.add_subcommand("info", "Tell what a picture or a project holds");
    command->add_option("INPUT", o.input, "A picture or a project")->required()->check(not_empty);
    command->add_flag("--json", o.json, "As JSON");
    add_salvage(*command, o.salvage);
    add_backend(*command, o.backend);
}

void heed_environment() {
    try {
        limit_instruction_set_by_environment();
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
}

/// The options that the person wrote: "--scale". What an environment variable says is not among them.
std::set<std::string, std::less<>> given_options(const CLI::App& command, std::span<char* const> arguments) {
    std::set<std::string, std::less<>> given;
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        const bool written = std::ranges::any_of(arguments, [&](std::string_view argument) {
            return argument == name || argument.starts_with(name + "=");
        });
        if (option->count() > 0 && (option->get_envname().empty() || written)) given.insert(name);
    }
    return given;
}

int failed(int code, const std::string& message) {
    print_failure(message);
    return code;
}

/// --help and --version.
int print_answer(const CLI::App& app, const CLI::ParseError& asked) {
    std::ostringstream text;
    const int code = app.exit(asked, text, text);
    print_plain(text.str());
    return code;
}

}  // namespace

void print_failure(const std::string& message) {
    print_aside(fmt::format("probewarp: {}\n", printable(message)));
}

std::string with_salvage_hint(const IncompleteFile& error) {
    return fmt::format("{}; --salvage opens what is there", error.what());
}

namespace {

int run_command(int argc, char** argv, int (*open_window)(const std::string& path, DeformBy deform_by)) {
    CLI::App app("Probewarp deforms a picture with probes.\nWithout a command it opens a window on FILE.",
                 "probewarp");
    std::string file, deform = "auto";
    RenderOptions render_options;
    WeightsOptions weights_options;
    InfoOptions info_options;
    app.add_option("FILE", file, "A picture or a project");
    app.add_option("--deform", deform,
                   "auto, processor or shader: which one moves the vertices while the window's probes are "
                   "dragged; auto: the quicker one, never the shader of a software rasteriser")
        ->check(CLI::IsMember(names(deform_by_names)));
    app.set_version_flag("--version", "probewarp " PROBEWARP_VERSION);
    app.require_subcommand(0, 1);
    add_render(app, render_options);
    add_weights(app, weights_options);
    add_info(app, info_options);
    try {
        app.parse(argc, argv);
        heed_environment();
        if (!app.get_subcommands().empty() && app.count("--deform") > 0)
            throw UsageError(
                "--deform: before a command it has no meaning; expected it after render, or without a "
                "command");
        limit_threads_to_what_starts();
        if (const CLI::App* command = app.get_subcommand("render"); command->parsed()) {
            render_options.given = given_options(*command, std::span(argv, std::size_t(argc)));
            return render(render_options);
        }
        if (app.got_subcommand("weights"))
            weights(weights_options);
        else if (app.got_subcommand("info"))
            info(info_options);
        else
            return open_window(file, std::ranges::find(deform_by_names, deform, &DeformByName::name)->by);
        return 0;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return print_answer(app, error);
        return failed(2, fmt::format("{}; see probewarp --help", error.what()));
    } catch (const UsageError& error) {
        return failed(2, error.what());
    } catch (const IncompleteFile& error) {
        return failed(1, with_salvage_hint(error));
    } catch (const std::bad_alloc&) {
        print_aside("probewarp: there is not enough memory\n");
        return 1;
    } catch (const std::exception& error) {
        return failed(1, error.what());
    }
}

}  // namespace

int run_command_line(int argc, char** argv, int (*open_window)(const std::string& path, DeformBy deform_by)) {
    return finish_printing(run_command(argc, argv, open_window));
}

}  // namespace probewarp
