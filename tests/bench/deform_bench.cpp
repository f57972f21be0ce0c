// The deformation's inner loop beside what it is measured against: the same blend written down as the paper
// has it, the other usual ways to blend, and what the machine can do at best. script/bench makes the table.
#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "machine_limits.h"
#include "math/dual_quaternion.h"
#include "model/deform_tiles.h"
#include "model/deformation.h"

namespace probewarp {
namespace {

const bool told = (benchmark::AddCustomContext("instruction set", deform_target()), true);

/// Vertices on a square of 4096 pixels, weights by the distance as the default scheme has them, and random
/// probes; seed 1.
struct Scene {
    std::size_t vertices = 0, probes = 0;
    std::vector<glm::vec2> rest, now;
    std::vector<float> weights;                     ///< #vertices x #probes, row-major
    std::vector<std::vector<float>> weights_apart;  ///< #probes, each #vertices
    WeightTiles tiles;
    std::vector<Motion<double>> motions;
    std::vector<DualComplex<float>> transformations;

    Scene(std::size_t side, std::size_t probe_count);
    Pose pose() const { return {motions, transformations, glm::vec2(2048)}; }
};

Scene::Scene(std::size_t side, std::size_t probe_count)
    : vertices(side * side), probes(probe_count), now(vertices), weights_apart(probes) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-2048, 2048), way(-200, 200), angle(-2, 2);
    for (std::size_t i = 0; i < probes; ++i) {
        const std::complex<double> at(place(random), place(random));
        motions.push_back(motion(angle(random), at, at + std::complex<double>(way(random), way(random))));
        transformations.push_back(cast<float>(motions.back().p));
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        rest.push_back(glm::vec2(v % side, v / side) * (4096.0f / float(side - 1)));
        const std::complex<float> from(rest[v].x - 2048, rest[v].y - 2048);
        for (std::size_t i = 0; i < probes; ++i) {
            const float w = 1e4f / (1 + std::norm(from - std::complex<float>(motions[i].rest)));
            weights.push_back(w);
            weights_apart[i].push_back(w);
        }
    }
    tiles = make_tiles(weights, probes);
}

/// All benchmarks of a size share its scene.
Scene& scene_of(const benchmark::State& state) {
    static std::map<std::pair<long, long>, std::unique_ptr<Scene>> scenes;
    auto& scene = scenes[{state.range(0), state.range(1)}];
    if (!scene) scene = std::make_unique<Scene>(std::size_t(state.range(0)) + 1, std::size_t(state.range(1)));
    return *scene;
}

void sizes(benchmark::internal::Benchmark* b) {
    // vertices x probes: 10201 x 8, 40401 x 32, 1002001 x 16, 1002001 x 64
    b->Args({100, 8})->Args({200, 32})->Args({1000, 16})->Args({1000, 64})->Unit(benchmark::kMicrosecond);
    b->UseRealTime();
}

/// As the paper writes it (MKO section 5) and its own library goes about it: one object a term, one dense
/// weight vector a probe, and a normalisation with a root and four divisions.
void deform_direct(benchmark::State& state) {
    Scene& s = scene_of(state);
    for (auto _ : state) {
        for (std::size_t v = 0; v < s.vertices; ++v) {
            DualComplex<float> sum{0, 0};
            for (std::size_t i = 0; i < s.probes; ++i)
                sum = sum + s.weights_apart[i][v] * s.transformations[i];
            const float size = norm(sum);
            const DualComplex<float> p{sum.p0 / size, sum.p1 / size};
            const glm::vec2 from = s.rest[v] - glm::vec2(2048);
            const auto to = act(p, {from.x, from.y});
            s.now[v] = glm::vec2(to.real(), to.imag()) + glm::vec2(2048);
        }
        benchmark::ClobberMemory();
    }
}
BENCHMARK(deform_direct)->Apply(sizes);

/// The program's own plain function, over row-major weights.
void deform_plain(benchmark::State& state) {
    Scene& s = scene_of(state);
    for (auto _ : state) {
        deform_dlb(s.rest, s.weights, s.pose(), s.now);
        benchmark::ClobberMemory();
    }
}
BENCHMARK(deform_plain)->Apply(sizes);

/// Linear blending of 2x3 matrices, over row-major weights.
void deform_matrices(benchmark::State& state) {
    Scene& s = scene_of(state);
    std::vector<std::array<float, 6>> matrices;
    for (const auto& m : s.motions) {
        const std::complex<float> turn(1.0 + m.less_one), shift(m.shift);
        matrices.push_back({turn.real(), -turn.imag(), shift.real(), turn.imag(), turn.real(), shift.imag()});
    }
    for (auto _ : state) {
        for (std::size_t v = 0; v < s.vertices; ++v) {
            std::array<float, 6> m{};
            float total = 0;
            for (std::size_t i = 0; i < s.probes; ++i) {
                const float w = s.weights[v * s.probes + i];
                for (std::size_t k = 0; k < 6; ++k) m[k] += w * matrices[i][k];
                total += w;
            }
            const glm::vec2 from = s.rest[v] - glm::vec2(2048);
            const glm::vec2 to{m[0] * from.x + m[1] * from.y + m[2], m[3] * from.x + m[4] * from.y + m[5]};
            s.now[v] = to / total + glm::vec2(2048);
        }
        benchmark::ClobberMemory();
    }
}
BENCHMARK(deform_matrices)->Apply(sizes);

/// DLB of unit dual quaternions (Kavan, algorithm DLB), over row-major weights.
void deform_quaternions(benchmark::State& state) {
    Scene& s = scene_of(state);
    std::vector<std::array<float, 8>> quaternions;
    for (const auto& m : s.motions) {
        const auto p0 = m.p.p0, p1 = m.p.p1;  // the turn about z, and half the shift times it
        quaternions.push_back(
            {float(p0.real()), 0, 0, float(p0.imag()), 0, float(p1.real()), float(p1.imag()), 0});
    }
    for (auto _ : state) {
        for (std::size_t v = 0; v < s.vertices; ++v) {
            std::array<float, 8> q{};
            for (std::size_t i = 0; i < s.probes; ++i) {
                const float w = s.weights[v * s.probes + i];
                for (std::size_t k = 0; k < 8; ++k) q[k] += w * quaternions[i][k];
            }
            const float size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
            for (float& x : q) x /= size;
            const glm::vec3 axis(q[1], q[2], q[3]), dual(q[5], q[6], q[7]);
            const glm::vec3 from(s.rest[v] - glm::vec2(2048), 0);
            const glm::vec3 to = from + 2.0f * glm::cross(axis, glm::cross(axis, from) + q[0] * from) +
                                 2.0f * (q[0] * dual - q[4] * axis + glm::cross(axis, dual));
            s.now[v] = glm::vec2(to) + glm::vec2(2048);
        }
        benchmark::ClobberMemory();
    }
}
BENCHMARK(deform_quaternions)->Apply(sizes);

void by_tiles(benchmark::State& state) {
    Scene& s = scene_of(state);
    for (auto _ : state) {
        deform_dlb(s.tiles, s.rest, s.pose(), {0, s.vertices}, s.now);
        benchmark::ClobberMemory();
    }
}

/// The third probe dragged.
void by_others(benchmark::State& state) {
    Scene& s = scene_of(state);
    const OthersSum others = sum_others(s.tiles, s.pose(), 2);
    for (auto _ : state) {
        deform_dlb_dragged(s.tiles, others, s.rest, s.pose(), s.now);
        benchmark::ClobberMemory();
    }
}

/// With so many threads at most.
template <void (*run)(benchmark::State&), std::size_t threads>
void with_threads(benchmark::State& state) {
    using Control = oneapi::tbb::global_control;
    const Control most(Control::max_allowed_parallelism, threads);
    run(state);
}
BENCHMARK(with_threads<by_tiles, 1>)->Name("deform_tiles")->Apply(sizes);
BENCHMARK(with_threads<by_tiles, 2>)->Name("deform_tiles_two_threads")->Apply(sizes);
BENCHMARK(with_threads<by_others, 1>)->Name("deform_dragged")->Apply(sizes);

/// Every blend; the one at this place in the table.
void deform_blend(benchmark::State& state) {
    Scene& s = scene_of(state);
    const BlendMethod& blend = blend_methods()[std::size_t(state.range(2))];
    state.SetLabel(std::string(blend.name));
    using Control = oneapi::tbb::global_control;
    const Control most(Control::max_allowed_parallelism, 1);
    for (auto _ : state) {
        blend.deform(s.tiles, s.rest, s.pose(), {0, s.vertices}, s.now);
        benchmark::ClobberMemory();
    }
}
BENCHMARK(deform_blend)->Apply([](benchmark::internal::Benchmark* b) {  // 10201 x 8 and 1002001 x 16
    const auto blends = long(blend_methods().size());
    b->ArgsProduct({{100}, {8}, benchmark::CreateDenseRange(0, blends - 1, 1)});
    b->ArgsProduct({{1000}, {16}, benchmark::CreateDenseRange(0, blends - 1, 1)});
    b->Unit(benchmark::kMicrosecond)->UseRealTime();
});

/// What a change of the weights costs beyond working them out.
void make_the_tiles(benchmark::State& state) {
    const Scene& s = scene_of(state);
    for (auto _ : state) benchmark::DoNotOptimize(make_tiles(s.weights, s.probes));
}
BENCHMARK(make_the_tiles)->Name("deform_make_tiles")->Apply(sizes);

/// Reads as many bytes as the deformation reads and writes.
void limit_read(benchmark::State& state) {
    const Scene& s = scene_of(state);
    static std::map<std::size_t, AlignedFloats> arrays;
    auto& array = arrays[s.vertices * (s.probes + 4) / 256 * 256];
    // Written once: pages that nobody has written to are all the same one, and read from the first cache.
    array.resize(s.vertices * (s.probes + 4) / 256 * 256, 1.0f);
    for (auto _ : state) benchmark::DoNotOptimize(read_all(array));
    state.SetBytesProcessed(std::int64_t(state.iterations()) * std::int64_t(array.size() * sizeof(float)));
}
BENCHMARK(limit_read)->Apply(sizes);

/// As many multiply-adds as the deformation's sums are.
void limit_multiply_add(benchmark::State& state) {
    const Scene& s = scene_of(state);
    float sink = 1;
    std::size_t done = 0;
    const std::size_t lanes = multiply_add(1, sink);
    for (auto _ : state) done += multiply_add(4 * s.vertices * s.probes / lanes, sink);
    benchmark::DoNotOptimize(sink);
    state.counters["multiply-adds/s"] = benchmark::Counter(double(done), benchmark::Counter::kIsRate);
}
BENCHMARK(limit_multiply_add)->Apply(sizes);

}  // namespace
}  // namespace probewarp
