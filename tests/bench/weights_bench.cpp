// What painting and the weight schemes cost: a dab from the press to the deformed vertices, the memory of a
// stroke, and a scheme's table when probes are put down and when one of them moves.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include "model/brush.h"
#include "model/deformation.h"
#include "model/paint_ops.h"
#include "model/weights.h"

namespace probewarp {
namespace {

/// A picture of that size without pixels (nothing here looks at them) under random probes, moved; seed 1.
Document document_with(int width, int height, int cells, int probes, double way) {
    Picture picture;
    picture.image.width = width;
    picture.image.height = height;
    Document document;
    document.picture = std::make_shared<const Picture>(std::move(picture));
    document.mesh.cells = cells;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> part(0, 1);
    for (int i = 0; i < probes; ++i) {
        Probe probe = new_probe(document, {part(random) * width, part(random) * height});
        probe.now += way * glm::dvec2(part(random) - 0.5, part(random) - 0.5);
        document.probes.push_back(probe);
    }
    return document;
}

constexpr int side = 3464;  // of a picture of 12 megapixels

/// One stroke on the first probe, as the brush tool paints it: each dab is on the deformed picture before the
/// next falls.
struct Painting {
    Document document;
    Deformation deformation;
    PaintMap map;
    Stroke stroke;
    Brush brush;

    explicit Painting(int cells) : document(document_with(side, side, cells, 30, 200)) {
        brush.radius = side / 16.0;  // the tool's own
        begin();
    }

    /// On blank paint again.
    void begin() {
        map = new_paint_map(side, side);
        stroke = {map, {}, {}};
        document.probes[0].paint = nullptr;
        update(deformation, document);
    }

    /// Returns the bytes of its paint.
    std::size_t fall(glm::dvec2 at) {
        const Image& image = document.picture->image;
        const Mask mask =
            dab_mask(map, frame_of(image), mesh_of(deformation), deformation.now, image, brush, at);
        dab(map, stroke, mask, brush, false, [](int, int) { return 0.0f; });
        document.probes[0].paint = std::make_shared<const PaintMap>(map);
        update(deformation, document);
        return own_bytes(map, nullptr);
    }
};

constexpr int around = 64;  // dabs; so they lie some 94 pixels apart, farther than the brush's own spacing

/// A point on a loop well within the picture.
glm::dvec2 on_loop(int dab) {
    const double angle = 2 * M_PI * dab / around;
    return side / 2.0 + double(side) * glm::dvec2(0.3 * std::cos(angle), 0.25 * std::sin(angle));
}

/// 12 megapixels, 30 probes, the largest map of paint. The memory is that of the whole loop, 6000 pixels
/// long.
void dab_to_vertices(benchmark::State& state) {
    Painting painting{int(state.range(0))};
    std::size_t bytes = 0;
    int dab = around;
    for (auto _ : state) {
        if (dab == around) {  // where it was painted already there would be less to do
            state.PauseTiming();
            painting.begin();
            painting.fall(on_loop(0));  // the first makes the refined weights
            dab = 1;
            state.ResumeTiming();
        }
        bytes = std::max(bytes, painting.fall(on_loop(dab++)));
    }
    state.counters["vertices"] = double(painting.deformation.now.size());
    state.counters["paint MiB"] = double(bytes) / (1 << 20);
}
BENCHMARK(dab_to_vertices)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond)->Iterations(3 * (around - 1));

/// The first dab of all: every vertex's weights are settled once.
void first_dab(benchmark::State& state) {
    std::optional<Painting> painting;
    for (auto _ : state) {
        state.PauseTiming();
        painting.emplace(int(state.range(0)));
        state.ResumeTiming();
        benchmark::DoNotOptimize(painting->fall(on_loop(0)));
    }
}
BENCHMARK(first_dab)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

/// One probe's paint filled all over, and taken away at the next turn: the mean of both.
void fill_or_clear(benchmark::State& state) {
    Painting painting{int(state.range(0))};
    const auto full = std::make_shared<const PaintMap>(filled(painting.map, 0.5f));
    for (auto _ : state) {
        auto& paint = painting.document.probes[0].paint;
        paint = paint ? nullptr : full;
        update(painting.deformation, painting.document);
    }
}
BENCHMARK(fill_or_clear)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

/// From the document's change to the deformed vertices, with so many cells and 16 probes before it.
template <class Change>
void change_to_vertices(benchmark::State& state, const char* scheme, int cells, Change change) {
    Document document = document_with(2048, 2048, cells, 16, 200);
    document.weights.scheme = scheme;
    Deformation deformation;
    update(deformation, document);
    int turn = 0;
    for (auto _ : state) {
        change(document, turn++);
        update(deformation, document);
    }
    state.counters["vertices"] = double(deformation.now.size());
}

/// A probe more, and at the next turn it is taken away: the mean of both.
void probe_more_or_less(benchmark::State& state, const char* scheme, int cells) {
    change_to_vertices(state, scheme, cells, [](Document& document, int turn) {
        if (turn % 2 == 0)
            document.probes.push_back(new_probe(document, {1234, 567 + turn}));
        else
            document.probes.pop_back();
    });
}

void rest_moved(benchmark::State& state, const char* scheme, int cells) {
    change_to_vertices(state, scheme, cells, [](Document& document, int turn) {
        document.probes[0].rest = glm::dvec2(900 + turn % 90, 1100);
    });
}

void first_binding(benchmark::State& state, const char* scheme, int cells) {
    Document document = document_with(2048, 2048, cells, 20, 0);
    document.weights.scheme = scheme;
    for (auto _ : state) benchmark::DoNotOptimize(make_binding(document, nullptr));
}

/// The table where one probe's rest has moved: what a scheme kept from before is used again.
void binding_after_a_probe_moved(benchmark::State& state, const char* scheme, int cells) {
    Document document = document_with(2048, 2048, cells, 20, 0);
    document.weights.scheme = scheme;
    auto binding = make_binding(document, nullptr);
    int turn = 0;
    for (auto _ : state) {
        document.probes[0].rest = glm::dvec2(900 + turn % 90, 1100);
        ++turn;
        binding = make_binding(document, binding);
    }
}

const bool registered = [] {
    const auto add = [](const std::string& name, auto run, const char* scheme, int cells) {
        benchmark::RegisterBenchmark(name.c_str(), run, scheme, cells)
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();  // some work on two threads
    };
    for (const WeightScheme& scheme : weight_schemes()) {
        const std::string name = std::string(scheme.name) + "/1000";
        if (scheme.name == "biharmonic") continue;  // minutes
        add("probe_more_or_less/" + name, probe_more_or_less, scheme.name.data(), 1000);
        add("rest_moved/" + name, rest_moved, scheme.name.data(), 1000);
    }
    for (const WeightScheme& scheme : weight_schemes())
        for (const int cells : {100, 300}) {
            const std::string name = std::string(scheme.name) + "/" + std::to_string(cells);
            add("first_binding/" + name, first_binding, scheme.name.data(), cells);
            add("binding_after_a_probe_moved/" + name, binding_after_a_probe_moved, scheme.name.data(),
                cells);
        }
    return true;
}();

}  // namespace
}  // namespace probewarp
