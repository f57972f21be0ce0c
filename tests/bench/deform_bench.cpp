// The deformation's inner loop, and what it is measured against: a copy of the same weights through memory.
#include <benchmark/benchmark.h>

#include <cstring>
#include <random>

#include "model/deformation.h"

namespace probewarp {
namespace {

/// A square picture's document with so many cells and random probes; seed 1.
Document document_with(int cells, int probes) {
    Picture picture;
    picture.image.width = picture.image.height = 4096;
    Document document;
    document.picture = std::make_shared<const Picture>(std::move(picture));
    document.mesh.cells = cells;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(0, 4096), way(-200, 200), angle(-2, 2);
    for (int i = 0; i < probes; ++i) {
        Probe probe = new_probe(document, {place(random), place(random)});
        probe.now += glm::dvec2(way(random), way(random));
        probe.angle = angle(random);
        document.probes.push_back(probe);
    }
    return document;
}

void sizes(benchmark::internal::Benchmark* b) {
    // vertices x probes: 10201 x 8, 40401 x 32, 1002001 x 16
    b->Args({100, 8})->Args({200, 32})->Args({1000, 16})->Unit(benchmark::kMillisecond);
}

void deform(benchmark::State& state) {
    const Document document = document_with(int(state.range(0)), int(state.range(1)));
    Deformation d;
    update(d, document);
    const Pose pose{d.motions, d.transformations, glm::vec2(2048)};
    for (auto _ : state) {
        deform_dlb(mesh_of(d).rest, weights_of(d), pose, d.now);
        benchmark::ClobberMemory();
    }
    const auto vertices = double(mesh_of(d).rest.size());
    state.counters["vertices"] = vertices;
    state.counters["weights/s"] =
        benchmark::Counter(vertices * double(state.range(1)), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(deform)->Apply(sizes);

/// Reads and writes as many bytes as the weights are: what no deformation that reads them all can beat by
/// much.
void copy_weights(benchmark::State& state) {
    const auto side = std::size_t(state.range(0)) + 1;
    const std::vector<float> weights(side * side * std::size_t(state.range(1)), 1.0f);
    std::vector<float> copy(weights.size());
    for (auto _ : state) {
        std::memcpy(copy.data(), weights.data(), weights.size() * sizeof(float));
        benchmark::ClobberMemory();
    }
}
BENCHMARK(copy_weights)->Apply(sizes);

void inverse_distance(benchmark::State& state) {
    const Document document = document_with(int(state.range(0)), int(state.range(1)));
    const auto binding = make_binding(document, nullptr);
    std::shared_ptr<WeightCache> cache;
    for (auto _ : state)
        benchmark::DoNotOptimize(
            find_weight_scheme("inverse-distance")
                ->table({*binding->mesh, binding->islands, document.probes, default_exponent, cache}));
}
BENCHMARK(inverse_distance)->Apply(sizes);

}  // namespace
}  // namespace probewarp
