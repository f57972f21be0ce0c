// Opening and exporting a picture of 24 megapixels.
#include <benchmark/benchmark.h>

#include <cmath>

#include "io/image_file.h"
#include "render/context.h"
#include "render/export.h"

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

const Image& picture() {
    static const Image image = photograph();
    return image;
}

void encode(benchmark::State& state, const char* format) {
    std::size_t size = 0;
    for (auto _ : state) size = find_image_format(format)->encode(picture(), {}).size();
    state.counters["MB"] = double(size) / 1e6;
}
BENCHMARK_CAPTURE(encode, png, "png")->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(encode, jpeg, "jpeg")->Unit(benchmark::kMillisecond);

void open(benchmark::State& state, const char* format) {
    const auto bytes = find_image_format(format)->encode(picture(), {});
    for (auto _ : state) benchmark::DoNotOptimize(decode_picture(bytes, "benchmark"));
}
BENCHMARK_CAPTURE(open, png, "png")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(open, jpeg, "jpeg")->Unit(benchmark::kMillisecond);

void mipmaps(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(smaller_levels(picture()));
}
BENCHMARK(mipmaps)->Unit(benchmark::kMillisecond);

/// The deformed picture's pixels, without the file.
void render(benchmark::State& state) {
    const auto context = open_context("auto");
    Renderer renderer;
    Document document;
    Picture whole;
    whole.image = picture();
    document.picture = std::make_shared<const Picture>(std::move(whole));
    Probe moved = new_probe(document, {2000, 2000});
    moved.now += glm::dvec2(300, -200);
    moved.angle = 0.4;
    document.probes.push_back(moved);
    document.probes.push_back(new_probe(document, {4500, 1500}));
    Deformation deformation;
    update(deformation, document);
    renderer.set_picture(upload_picture(document.picture->image));
    renderer.set_mesh(mesh_of(deformation));
    renderer.set_positions(deformation.now, deformation.moved);
    for (auto _ : state) {
        ExportJob job(renderer, document, deformation, {});
        while (!job.done()) job.step();
        benchmark::DoNotOptimize(job.take());
    }
    state.SetLabel(renderer_name());
}
BENCHMARK(render)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace probewarp
