// A frame while a probe is dragged on a picture of 12 megapixels, beside a frame of the same mesh that nobody
// deforms: by turns in one run, so that what the machine does besides falls on both.
#include <benchmark/benchmark.h>

#include <chrono>

#include "model/deformation.h"
#include "render/context.h"
#include "render/renderer.h"

namespace probewarp {
namespace {

constexpr int width = 4000, height = 3000;              // of the picture
constexpr int canvas_width = 924, canvas_height = 742;  // of a window of 1280 x 800
constexpr int probes = 8;

PicturePtr picture() {
    Picture made;
    made.image.width = width;
    made.image.height = height;
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            rgba.insert(rgba.end(), {std::uint8_t(x), std::uint8_t(y), std::uint8_t(x + y), 255});
    made.image.rgba = std::move(rgba);
    return std::make_shared<const Picture>(std::move(made));
}

/// The picture fitted into the canvas, as the window shows it at first.
View fitted_view() {
    View view;
    const double scale = std::min((canvas_width - 80.0) / width, (canvas_height - 80.0) / height);
    view.scale = glm::dvec2(scale);
    view.origin = -(glm::dvec2(canvas_width, canvas_height) / scale - glm::dvec2(width, height)) / 2.0;
    view.width = canvas_width;
    view.height = canvas_height;
    return view;
}

struct Scene {
    std::unique_ptr<Context> context = open_context("auto");
    Renderer renderer;
    Document document;
    Deformation deformation;
    View view = fitted_view();

    explicit Scene(int cells) {
        document.picture = picture();
        document.mesh.cells = cells;
        for (int i = 0; i < probes; ++i) {
            Probe probe = new_probe(document, {300 + 480 * i, 500 + 1900 * (i % 2)});
            probe.now += glm::dvec2(40, 30);
            document.probes.push_back(probe);
        }
        update(deformation, document);
        renderer.set_picture(upload_picture(document.picture->image));
        renderer.set_mesh(deformation.binding->mesh);
        renderer.set_positions(deformation.now, deformation.moved);
        renderer.set_weights(weights_of(deformation));
    }
    void draw(Fineness fineness = Fineness::seen) {
        renderer.draw(view, 1, false, 0, fineness);
        renderer.display(view, {}, 12, false);
        glFinish();
    }
    void drag(int step, bool shader) {
        document.probes[0].now += glm::dvec2(step % 2 == 0 ? 25 : -25, 1);
        if (!shader) {
            update(deformation, document, Pace::dragging);
            return renderer.set_positions(deformation.now, deformation.moved);
        }
        std::vector<DualComplex<float>> pose;
        for (const Probe& probe : document.probes)
            pose.push_back(cast<float>(motion_of(probe, centre(document.picture->image)).p));
        renderer.set_pose(pose, glm::vec2(centre(document.picture->image)));
    }
};

template <class Work>
double seconds(Work work) {
    using Clock = std::chrono::steady_clock;
    const auto before = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - before).count();
}

/// The counters: milliseconds of the frame that is only drawn, and how many times that a dragged one takes.
void drag_frame(benchmark::State& state, bool shader) {
    Scene scene(int(state.range(0)));
    scene.draw();  // a software rasteriser compiles here
    double dragged = 0, drawn = 0;
    int step = 0;
    for (auto _ : state) {
        const double one = seconds([&] {
            scene.drag(step++, shader);
            scene.draw();
        });
        dragged += one;
        drawn += seconds([&] { scene.draw(); });
        state.SetIterationTime(one);
    }
    state.counters["drawing_ms"] = drawn / step * 1e3;
    state.counters["over_drawing"] = dragged / drawn;
}
void drag_frame_by_processor(benchmark::State& state) { drag_frame(state, false); }
void drag_frame_by_shader(benchmark::State& state) { drag_frame(state, true); }

void meshes(benchmark::internal::Benchmark* b) {
    b->ArgName("cells")->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond)->UseManualTime();
}
BENCHMARK(drag_frame_by_processor)->Apply(meshes);
BENCHMARK(drag_frame_by_shader)->Apply(meshes);

/// How many times as long all triangles would take as those that the window draws.
void drawing_as_seen(benchmark::State& state) {
    Scene scene(int(state.range(0)));
    for (const Fineness fineness : {Fineness::seen, Fineness::all}) scene.draw(fineness);
    double seen = 0, all = 0;
    for (auto _ : state) {
        const double one = seconds([&] { scene.draw(); });
        seen += one;
        all += seconds([&] { scene.draw(Fineness::all); });
        state.SetIterationTime(one);
    }
    state.counters["times_all"] = all / seen;
}
BENCHMARK(drawing_as_seen)->Apply(meshes);

}  // namespace
}  // namespace probewarp
