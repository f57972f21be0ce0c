#include "flops.h"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

#include "counting.h"
#include "math/matrix.h"
#include "random.h"

namespace probewarp::papers {
namespace {

// Each representation: one from a DCN, its points, and its homogeneous matrix.
struct AsDcn {
    template <class T>
    static DualComplex<T> from(const DualComplex<T>& p) {
        return p;
    }
    template <class T>
    static std::complex<T> point(const std::complex<T>& v) {
        return v;
    }
    template <class T>
    static auto matrix(const DualComplex<T>& p) {
        return to_matrix(p);
    }
};

struct AsDualQuaternion {
    template <class T>
    static DualQuaternion<T> from(const DualComplex<T>& p) {
        return embed(p);
    }
    template <class T>
    static glm::vec<3, T> point(const std::complex<T>& v) {
        return embed(v);
    }
    template <class T>
    static auto matrix(const DualQuaternion<T>& q) {
        return to_matrix(q);
    }
};

struct AsComplexMatrix {
    template <class T>
    static ComplexMatrix<T> from(const DualComplex<T>& p) {
        return to_complex_matrix(p);
    }
    template <class T>
    static std::complex<T> point(const std::complex<T>& v) {
        return v;
    }
    template <class T>
    static auto matrix(const ComplexMatrix<T>& m) {
        return to_matrix(to_dual_complex(m));
    }
};

struct AsMatrix {
    template <class T>
    static glm::mat<3, 3, T> from(const DualComplex<T>& p) {
        return to_matrix(p);
    }
    template <class T>
    static std::complex<T> point(const std::complex<T>& v) {
        return v;
    }
    template <class T>
    static auto matrix(const glm::mat<3, 3, T>& m) {
        return m;
    }
};

template <class T>
DualComplex<T> as(const DualComplex<double>& p) {
    return {{T(p.p0.real()), T(p.p0.imag())}, {T(p.p1.real()), T(p.p1.imag())}};
}

template <class Form>
Cost cost() {
    Random random;
    const auto p = Form::from(as<Counting>(random.planar())), q = Form::from(as<Counting>(random.planar()));
    const auto v = Form::point(std::complex<Counting>(random.real(-1, 1), random.real(-1, 1)));
    return {count([&] { return act(p, v); }).flops(), count([&] { return p * q; }).flops(),
            count([&] { return Form::matrix(p); }).flops(), int(sizeof p / sizeof(Counting))};
}

/// Nanoseconds a call of one(i), i < size, of which the results go into memory: the best of some runs, since
/// others use the machine too.
template <class One>
double nanoseconds(std::size_t size, One one) {
    using Clock = std::chrono::steady_clock;
    constexpr int runs = 10, rounds = 200;
    std::vector<decltype(one(0))> results(size);
    double best = std::numeric_limits<double>::max();
    for (int run = 0; run < runs; ++run) {
        const auto begin = Clock::now();
        for (int round = 0; round < rounds; ++round) {
            for (std::size_t i = 0; i < size; ++i) results[i] = one(i);
            asm volatile("" : : "r"(results.data()) : "memory");  // the compiler must believe that it is read
        }
        const std::chrono::duration<double, std::nano> time = Clock::now() - begin;
        best = std::min(best, time.count() / rounds / double(size));
    }
    return best;
}

template <class Form>
Times times() {
    constexpr std::size_t size = 512;  // all of it in the nearest cache
    Random random;
    std::vector<decltype(Form::from(DualComplex<double>{}))> p;
    std::vector<decltype(Form::point(std::complex<double>{}))> v;
    for (std::size_t i = 0; i < size; ++i) {
        p.push_back(Form::from(random.planar()));
        v.push_back(Form::point(std::complex<double>(random.real(-1, 1), random.real(-1, 1))));
    }
    return {nanoseconds(size, [&](std::size_t i) { return act(p[i], v[i]); }),
            nanoseconds(size, [&](std::size_t i) { return p[i] * p[size - 1 - i]; }),
            nanoseconds(size, [&](std::size_t i) { return Form::matrix(p[i]); })};
}

std::string beside(int ours, const std::optional<Cost>& paper, int Cost::*figure) {
    return fmt::format("{} ({})", ours, paper ? fmt::to_string((*paper).*figure) : "not at hand");
}

void print(std::ostream& out) {
    fmt::print(
        out,
        "Floating-point operations (+, -, *, / and square roots; negations and copies are free), counted by "
        "running core/math over a counting scalar, and the scalars that one transformation is held in: ours "
        "(the paper's). Beside them nanoseconds per operation in double over 512 seeded elements (seed {}), "
        "as measured on this machine just now, the best of ten runs. The matrix of a dual quaternion is 4 x "
        "4, the others' "
        "3 x 3.\n\n",
        seed);
    out << "| representation | transform a point | compose | to a matrix | scalars | ns transform | ns "
           "compose "
           "| ns to a matrix |\n|---|---|---|---|---|---|---|---|\n";
    const auto rows = representations();
    const auto all_times = measured_times();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto& [name, ours, paper] = rows[i];
        fmt::print(out, "| {} | {} | {} | {} | {} | {:.1f} | {:.1f} | {:.1f} |\n", name,
                   beside(ours.transform, paper, &Cost::transform),
                   beside(ours.compose, paper, &Cost::compose), beside(ours.convert, paper, &Cost::convert),
                   beside(ours.scalars, paper, &Cost::scalars), all_times[i].transform, all_times[i].compose,
                   all_times[i].convert);
    }
}

constexpr std::array tables{
    Table{"flops", "MKO, Table 1: operations and memory of four representations", print}};

}  // namespace

std::vector<Representation> representations() {
    return {{"DCN", cost<AsDcn>(), Cost{22, 20, 15, 4}},
            {"unit dual quaternion", cost<AsDualQuaternion>(), {}},
            {"2 x 2 complex matrix", cost<AsComplexMatrix>(), {}},
            {"3 x 3 real matrix", cost<AsMatrix>(), {}}};
}

std::vector<Times> measured_times() {
    return {times<AsDcn>(), times<AsDualQuaternion>(), times<AsComplexMatrix>(), times<AsMatrix>()};
}

std::span<const Table> flops_tables() { return tables; }

}  // namespace probewarp::papers
