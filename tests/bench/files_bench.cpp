// Opening, drawing and exporting a picture of 24 megapixels, against the libraries alone.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>

#include "exporting/export.h"
#include "io/file.h"
#include "io/image_file.h"
#include "libraries.h"
#include "raster/mipmaps.h"
#include "raster/rasterizer.h"
#include "render/context.h"
#include "render/driver_drawing.h"

namespace probewarp {
namespace {

/// 6000 x 4000: smooth with some grain, about as compressible as a photograph. Always the same.
Image photograph() {
    Image image;
    image.width = 6000;
    image.height = 4000;
    std::vector<std::uint8_t> rgba(std::size_t(image.width) * std::size_t(image.height) * 4);
    std::uint32_t noise = 1;
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        const double x = double(i / 4 % 6000), y = double(i / 4 / 6000);
        noise = noise * 1664525u + 1013904223u;
        const double grain = double(noise >> 28) - 8;
        rgba[i] = std::uint8_t(128 + 90 * std::sin(x / 311) + grain);
        rgba[i + 1] = std::uint8_t(128 + 90 * std::sin(y / 173 + x / 900) + grain);
        rgba[i + 2] = std::uint8_t(128 + 90 * std::cos((x + y) / 401) + grain);
        rgba[i + 3] = 255;
    }
    image.rgba = std::move(rgba);
    return image;
}

/// The synthetic picture, or the one that PROBEWARP_PHOTOGRAPH names, so that a real photograph, which is no
/// part of this repository, can be measured too.
const Image& picture() {
    static const Image image = [] {
        const char* path = std::getenv("PROBEWARP_PHOTOGRAPH");
        return path ? read_picture(path).image : photograph();
    }();
    return image;
}

const std::vector<unsigned char>& rgb() {
    static const auto pixels = bench::rgb_of(picture());
    return pixels;
}

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Ours and theirs by turns, so that whatever else the machine does meets both; the counter is how many times
/// as long they take.
void compare(benchmark::State& state, const char* counter, const std::function<void()>& ours,
             const std::function<void()>& theirs) {
    rgb();  // made, or read, outside the clock
    double our_seconds = 0, their_seconds = 0;
    for (auto _ : state) {
        const double seconds = seconds_of(ours);
        state.SetIterationTime(seconds);
        our_seconds += seconds;
        their_seconds += seconds_of(theirs);
    }
    state.counters[counter] = their_seconds / our_seconds;
}

std::size_t encoded_size(const char* format, Compression compression = Compression::standard) {
    return find_image_format(format)->encode(picture(), {.compression = compression}).size();
}

void encode_png_against_stb(benchmark::State& state, Compression compression) {
    std::size_t ours = 0, theirs = 0;
    compare(
        state, "stb_time", [&] { ours = encoded_size("png", compression); },
        [&] { theirs = bench::stb_png(rgb(), picture().width, picture().height); });
    state.counters["MB"] = double(ours) / 1e6;
    state.counters["stb_size"] = double(theirs) / double(ours);
}
BENCHMARK_CAPTURE(encode_png_against_stb, fast, Compression::fast)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->MeasureProcessCPUTime()
    ->Iterations(3);
BENCHMARK_CAPTURE(encode_png_against_stb, default, Compression::standard)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->MeasureProcessCPUTime()
    ->Iterations(3);

void encode_small_png_against_libpng(benchmark::State& state) {
    std::size_t ours = 0, theirs = 0;
    compare(
        state, "libpng_time", [&] { ours = encoded_size("png", Compression::small); },
        [&] { theirs = bench::libpng_best(rgb(), picture().width, picture().height); });
    state.counters["MB"] = double(ours) / 1e6;
    state.counters["libpng_size"] = double(theirs) / double(ours);
}
BENCHMARK(encode_small_png_against_libpng)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->MeasureProcessCPUTime()
    ->Iterations(1);

void encode_jpeg_against_libjpeg(benchmark::State& state) {
    compare(
        state, "libjpeg_time", [] { encoded_size("jpeg"); }, [] { bench::libjpeg(picture()); });
}
BENCHMARK(encode_jpeg_against_libjpeg)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->MeasureProcessCPUTime()
    ->Iterations(5);

void open_against(benchmark::State& state, const char* format, const char* counter,
                  void (*library)(std::span<const std::byte>)) {
    const auto bytes = find_image_format(format)->encode(picture(), {});
    compare(
        state, counter, [&] { find_image_format(format)->decode(bytes, {}); }, [&] { library(bytes); });
}
BENCHMARK_CAPTURE(open_against, spng, "png", "spng_time", &bench::spng_open)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->MeasureProcessCPUTime()
    ->Iterations(5);
BENCHMARK_CAPTURE(open_against, libjpeg, "jpeg", "libjpeg_time", &bench::libjpeg_open)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->MeasureProcessCPUTime()
    ->Iterations(5);

/// The most memory that the program held, as its --timings have it; bytes.
double peak_memory(const std::string& timings) {
    std::ifstream lines(timings);
    for (std::string line; std::getline(lines, line);) {
        double mib = 0;
        if (std::sscanf(line.c_str(), "timings: memory %lf MiB", &mib) == 1) return mib * (1 << 20);
    }
    return 0;
}

/// The whole program from a file to a PNG, against another that only decodes and encodes: the counter is the
/// share of the program's time that these two would take; and its memory over the decoded picture's.
void program_against_its_files(benchmark::State& state, const char* format) {
    const auto bytes = find_image_format(format)->encode(picture(), {});
    const auto folder = std::filesystem::temp_directory_path();
    const std::string from = folder / "probewarp-bench-in", to = folder / "probewarp-bench.png";
    const std::string timings = folder / "probewarp-bench-timings";
    write_file(from, bytes);
    const std::string command = "'" PROBEWARP_PROGRAM "' render '" + from + "' -o '" + to +
                                "' --probe 2000,2000:2300,1800,23 --probe 4500,1500 --timings 2>'" + timings +
                                "'";
    compare(
        state, "files_time",
        [&] {
            if (std::system(command.c_str()) != 0) state.SkipWithError("the program failed");
        },
        [&] {
            if (std::system(("'" PROBEWARP_FILES_ALONE "' '" + from + "'").c_str()) != 0)
                state.SkipWithError("decoding and encoding failed");
        });
    state.counters["memory"] = peak_memory(timings) / (4.0 * picture().width * picture().height);
    std::filesystem::remove(timings);
    std::filesystem::remove(from);
    std::filesystem::remove(to);
}
BENCHMARK_CAPTURE(program_against_its_files, jpeg, "jpeg")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->MeasureProcessCPUTime()
    ->Iterations(9);
BENCHMARK_CAPTURE(program_against_its_files, png, "png")
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->MeasureProcessCPUTime()
    ->Iterations(9);

/// The whole program on a picture of 512 pixels, from PNG to PNG.
void render_of_512_pixels(benchmark::State& state) {
    Image image;
    image.width = image.height = 512;
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 512 * 512 * 4; ++i) rgba.push_back(std::uint8_t(i % 4 == 3 ? 255 : i * i / 4099));
    image.rgba = std::move(rgba);
    const auto folder = std::filesystem::temp_directory_path();
    const std::string from = folder / "probewarp-bench-512.png", to = folder / "probewarp-bench-512-out.png";
    write_file(from, find_image_format("png")->encode(image, {}));
    const std::string command = "'" PROBEWARP_PROGRAM "' render '" + from + "' -o '" + to +
                                "' --probe 200,200:230,180,23 --probe 400,150";
    for (auto _ : state)
        if (std::system(command.c_str()) != 0) state.SkipWithError("the program failed");
    std::filesystem::remove(from);
    std::filesystem::remove(to);
}
BENCHMARK(render_of_512_pixels)->Unit(benchmark::kMillisecond)->UseRealTime();

void mipmaps(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(smaller_levels(picture()));
}
BENCHMARK(mipmaps)->Unit(benchmark::kMillisecond);

/// A document of two probes, one of which pulls and turns.
Document pulled() {
    Document document;
    Picture whole;
    whole.image = picture();
    document.picture = std::make_shared<const Picture>(std::move(whole));
    Probe moved = new_probe(document, {2000, 2000});
    moved.now += glm::dvec2(300, -200);
    moved.angle = 0.4;
    document.probes.push_back(moved);
    document.probes.push_back(new_probe(document, {4500, 1500}));
    return document;
}

void draw(PictureDrawer& drawer, const Deformation& deformation, const View& view) {
    ExportJob job(drawer, deformation, view, {});
    while (!job.done()) benchmark::DoNotOptimize(job.next_band());
}

/// The deformed picture's pixels, without the file; the counter is how many times as long the driver takes.
void draw_by_processor(benchmark::State& state) {
    Deformation deformation;
    update(deformation, pulled());
    const View view = export_view(deformation, {});
    const auto context = open_context("auto");
    state.SetLabel(renderer_name());
    Renderer renderer;
    renderer.set_picture(upload_picture(deformation.source.picture->image));
    renderer.set_mesh(deformation.binding->mesh);
    renderer.set_positions(deformation.now, deformation.moved);
    DriverDrawing by_driver(renderer, view, {});
    compare(
        state, "over_driver",
        [&] {
            Rasterizer by_processor(deformation, view, {});
            draw(by_processor, deformation, view);
        },
        [&] { draw(by_driver, deformation, view); });
}
BENCHMARK(draw_by_processor)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(5);

}  // namespace
}  // namespace probewarp
