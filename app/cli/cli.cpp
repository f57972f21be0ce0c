#include "cli/cli.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "io/printable.h"
#include "model/deform.h"
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
    command.add_option("--backend", backend, "auto, osmesa or egl")
        ->check(CLI::IsMember({"auto", "osmesa", "egl"}))
        ->envname("PROBEWARP_BACKEND");
}

void add_render(CLI::App& app, RenderOptions& o) {
    CLI::App* command = app.add_subcommand("render", "Deform a picture or a project and write the result");
    command->add_option("INPUT", o.input, "A picture or a project")->required();
    command
        ->add_option("-o,--output", o.output,
                     "PNG, JPEG, BMP, TGA, OBJ (the mesh) or probewarp (a project); - for standard output")
        ->required();
    command
        ->add_option("--probe", o.probes,
                     "RX,RY[:X,Y[,DEG[,RADIUS]]]: rest, and where it is now; image pixels and degrees")
        ->expected(1)
        ->take_all();
    command->add_option("--probes", o.probes_csv, "Add the probes of a CSV file of the iPad program");
    command->add_option("--image", o.image, "Put another picture under the probes");
    command->add_option("--mesh", o.mesh, "Cells along the longer side")
        ->check(CLI::Range(min_cells, max_cells));
    command->add_option("--weights", o.weights, "Weight scheme")
        ->check(CLI::IsMember(names(weight_schemes())));
    command->add_option("--blend", o.blend, "Blend method")->check(CLI::IsMember(names(blend_methods())));
    auto* scale =
        command->add_option("--scale", o.scale, "Exported pixels per image pixel")
            ->check([](const std::string& text) {
                const double value = std::strtod(text.c_str(), nullptr);  // CLI::Range lets NaN pass
                return value >= 1e-4 && value <= 1e4 ? "" : "Value " + text + " not in range 0.0001 to 10000";
            });
    command->add_option("--size", o.size, "WxH: fit into exactly this many pixels")->excludes(scale);
    command->add_option("--samples", o.samples, "N x N samples a pixel")->check(CLI::Range(1, 16));
    command
        ->add_option("--canvas", o.canvas, "image: the picture's rectangle; fit: all of the deformed picture")
        ->check(CLI::IsMember({"image", "fit"}));
    command->add_option("--background", o.background, "#rrggbb, white, black or none");
    command->add_option("--format", o.format,
                        "png, jpeg, bmp, tga, obj or probewarp, whatever OUTPUT ends with");
    add_backend(*command, o.backend);
    command->add_option("--deform", o.deform, "processor or shader: which one moves the vertices")
        ->check(CLI::IsMember({"processor", "shader"}));
    command->add_flag("--quiet", o.quiet, "Show no progress");
}

void add_info(CLI::App& app, InfoOptions& o) {
    CLI::App* command = app.add_subcommand("info", "Tell what a picture or a project holds");
    command->add_option("INPUT", o.input, "A picture or a project")->required();
    command->add_flag("--json", o.json, "As JSON");
    add_backend(*command, o.backend);
}

int failed(int code, const std::string& message) {
    fmt::print(stderr, "probewarp: {}\n", printable(message));
    return code;
}

}  // namespace

int run_command_line(int argc, char** argv, int (*open_window)(const std::string& path)) {
    CLI::App app("Probewarp deforms a picture with probes.\nWithout a command it opens a window on FILE.",
                 "probewarp");
    std::string file;
    RenderOptions render_options;
    InfoOptions info_options;
    app.add_option("FILE", file, "A picture or a project");
    app.set_version_flag("--version", "probewarp " PROBEWARP_VERSION);
    app.require_subcommand(0, 1);
    add_render(app, render_options);
    add_info(app, info_options);
    try {
        app.parse(argc, argv);
        if (app.got_subcommand("render"))
            render(render_options);
        else if (app.got_subcommand("info"))
            info(info_options);
        else
            return open_window(file);
        return 0;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        return failed(2, fmt::format("{}; see probewarp --help", error.what()));
    } catch (const UsageError& error) {
        return failed(2, error.what());
    } catch (const std::bad_alloc&) {
        return failed(1, "there is not enough memory");
    } catch (const std::exception& error) {
        return failed(1, error.what());
    }
}

}  // namespace probewarp
