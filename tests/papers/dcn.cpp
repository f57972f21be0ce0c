#include "dcn.h"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "math/planar_blend.h"
#include "random.h"

namespace probewarp::papers {
namespace {

using P = DualComplex<double>;
using Complex = std::complex<double>;
using std::numbers::pi;

constexpr std::size_t sets_of_the_table = 100'000;

double degrees(double radians) { return radians * 180 / pi; }

// ---- Distributivity.

struct Set {
    std::vector<double> weights;
    std::vector<P> p;
};

Set random_set(Random& random) {
    for (;;) {
        Set set{std::vector<double>(std::size_t(random.whole(2, 8))), {}};
        random.weights(set.weights);
        Complex left{};
        for (const double w : set.weights) left += w * set.p.emplace_back(random.planar()).p0;
        if (std::abs(left) >= 0.1) return set;
    }
}

/// dlb(w, change(p_i)).
template <class Change>
P blend(const Set& set, Change change) {
    std::vector<P> p;
    for (const P& x : set.p) p.push_back(change(x));
    return dlb<P>(set.weights, p).p;
}

double difference(const P& a, const P& b) { return std::max(std::abs(a.p0 - b.p0), std::abs(a.p1 - b.p1)); }

void print_distributivity(std::ostream& out) {
    const Distributivity d = distributivity(sets_of_the_table);
    fmt::print(
        out,
        "The largest difference of q dlb(w, p_i) and dlb(w, q p_i), and of dlb(w, p_i) q and dlb(w, p_i q), "
        "over {} "
        "random sets of 2 to 8 DCNs with half angles in [-pi, pi] and shifts of up to 2, and random convex "
        "weights (seed {}). Sets whose weighted sum is shorter than 0.1 are drawn again.\n\n"
        "| | paper | ours |\n|---|---|---|\n| from the left | 0 | {:.0e} |\n| from the right | 0 | {:.0e} "
        "|\n",
        sets_of_the_table, seed, d.left, d.right);
}

// ---- SLERP's angular velocity.

/// Fastest over slowest, of at(t) for t in [0, 1], as differences.
template <class At>
double unevenness(At at) {
    constexpr int steps = 100;
    constexpr double h = 1e-4;
    double fastest = 0, slowest = std::numeric_limits<double>::max();
    for (int i = 0; i <= steps; ++i) {
        const double t = double(i) / steps;
        const double velocity = std::arg((at(t + h) * inverse(at(t - h))).p0) / h;  // half an angle over 2 h
        fastest = std::max(fastest, velocity);
        slowest = std::min(slowest, velocity);
    }
    return fastest / slowest;
}

/// How far the way at(t) takes a point, t in [0, 1].
template <class At>
double furthest(At at, Complex v) {
    double most = 0;
    for (int i = 0; i <= 100; ++i) most = std::max(most, std::abs(act(at(i / 100.0), v) - v));
    return most;
}

void print_evenness(std::ostream& out) {
    out << "From a rigid transformation to the same followed by a turn about the point (3, -1): the fastest "
           "over the "
           "slowest angular velocity, by differences at 101 moments (1 is uniform), and how far that point "
           "moves on "
           "SLERP's way (0: it turns about it). DLB beside it, which is not uniform, and its closed form "
           "1 / cos^2(angle / 4). Nothing here is random.\n\n"
           "| degrees apart | paper: SLERP | SLERP | the point moves | DLB | DLB, closed form |\n"
           "|---|---|---|---|---|---|\n";
    for (const Evenness& e : evenness())
        fmt::print(out, "| {:.0f} | 1 | {:.9f} | {:.0e} | {:.6f} | {:.6f} |\n", degrees(e.apart), e.slerp,
                   e.centre_moves, e.dlb, e.dlb_exact);
}

// ---- The candy wrapper.

/// Where v goes by one of the blends of planar_blend.h.
template <class Blend>
Complex deformed(const Bar& bar, Complex v, Blend blend) {
    const double right = (v.real() + Bar::half_length) / (2 * Bar::half_length);
    const std::array weights{1 - right, right};
    const auto turned = [&](double angle, Complex rest) {
        return motion(angle, rest, std::polar(1.0, angle) * rest);
    };
    const std::array motions{turned(-bar.apart / 2, -Bar::half_length),
                             turned(bar.apart / 2, Bar::half_length)};
    return act(blend(std::span<const double>(weights), std::span<const Motion<double>>(motions)), v);
}

/// Of the linear map that takes 1 to x and i to y: with x = a + b, y = i (a - b) it is v -> a v + b conj(v),
/// whose singular values are |a| + |b| and ||a| - |b||.
double smallest_singular_value(Complex x, Complex y) {
    const Complex i(0, 1), a = (x - i * y) / 2.0, b = (x + i * y) / 2.0;
    return std::abs(std::abs(a) - std::abs(b));
}

/// The least of value(v) over the bar.
template <class Value>
double least(Value value) {
    constexpr int along = 80, across = 10;
    double result = std::numeric_limits<double>::max();
    for (int i = -along; i <= along; ++i)
        for (int j = -across; j <= across; ++j)
            result =
                std::min(result, value(Complex(Bar::half_length * i / along, Bar::half_width * j / across)));
    return result;
}

template <class Map>
double least_stretch(Map map) {
    constexpr double h = 1e-5;  // errs by h^2 = 1e-10 and by rounding over h = 1e-11
    const auto difference = [&](Complex v, Complex d) { return (map(v + d) - map(v - d)) / (2 * h); };
    return least(
        [&](Complex v) { return smallest_singular_value(difference(v, h), difference(v, Complex(0, h))); });
}

double closed_form(double apart) {
    const double t = std::tan(apart / 4) / 2;
    return least([=](Complex v) {
        const double slope = 2 * t / (1 + t * t * v.real() * v.real());
        return smallest_singular_value({1 - slope * v.imag(), slope * v.real()}, {0, 1});
    });
}

void print_wrapper(std::ostream& out) {
    out << "A bar [-2, 2] x [-1/4, 1/4] with a probe on each end, turned apart about the bar's centre; the "
           "weights go "
           "evenly from one to the other along it. The smallest singular value of the deformation's Jacobian "
           "over "
           "the bar (161 x 21 points), the weights' gradient included, by central differences in double: 0 "
           "where "
           "something is flattened. At 180 degrees linear blending takes the whole middle cross section to "
           "one "
           "point (candy wrapper), at 170 it folds the edges already, and beyond 180 it turns the middle the "
           "other way round; DLB's Jacobian stays regular. Its closed form: singular values of [1 - a' y, 0; "
           "a' x, 1] with a(x) = 2 atan(x/2 tan(angle/4)). Nothing here is random.\n\n"
           "| degrees apart | linear | paper: linear | DLB | paper: DLB | DLB, closed form |\n"
           "|---|---|---|---|---|---|\n";
    for (const Wrapper& w : wrappers()) {
        const bool half_turn = std::abs(w.apart - pi) < 1e-9;
        fmt::print(out, "| {:.0f} | {:.6f} | {} | {:.6f} | {} | {:.6f} |\n", degrees(w.apart), w.linear,
                   half_turn ? "0" : "", w.dlb, half_turn ? "> 0" : "", w.dlb_exact);
    }
}

constexpr std::array tables{
    Table{"distributivity", "MKO, section 5: DLB distributes over composition", print_distributivity},
    Table{"slerp-velocity", "MKO, section 5: SLERP's angular velocity is uniform", print_evenness},
    Table{"candy-wrapper", "MKO, section 5: the candy wrapper", print_wrapper}};

}  // namespace

Distributivity distributivity(std::size_t sets) {
    Random random;
    Distributivity most;
    for (std::size_t k = 0; k < sets; ++k) {
        const Set set = random_set(random);
        const P q = random.planar(), plain = blend(set, [](const P&p) { return p; });
        most.left = std::max(most.left, difference(q * plain, blend(set, [&](const P& p) { return q * p; })));
        most.right =
            std::max(most.right, difference(plain * q, blend(set, [&](const P& p) { return p * q; })));
    }
    return most;
}

std::vector<Evenness> evenness() {
    std::vector<Evenness> rows;
    for (const double angle : {30, 90, 180, 270, 350}) {
        const double apart = angle * pi / 180, root = std::cos(apart / 4);
        const Complex centre(3, -1);
        // Neither end is the identity, whose inverse is right even if inverses are wrong.
        const P p = translation(Complex(2, 5)) * rotation(1.0, Complex(0, 0)),
                q = rotation(apart, centre) * p;
        const auto steady = [&](double t) { return slerp(p, q, t); };
        const auto linear = [&](double t) { return dlb<P>(std::array{1 - t, t}, std::array{p, q}).p; };
        const auto turned = [&](double t) { return steady(t) * inverse(p); };
        rows.push_back(
            {apart, unevenness(steady), furthest(turned, centre), unevenness(linear), 1 / (root * root)});
    }
    return rows;
}

Complex Bar::linear(Complex v) const {
    return deformed(*this, v, [](auto w, auto m) { return planar_linear(w, m); });
}

Complex Bar::dlb(Complex v) const {
    return deformed(*this, v, [](auto w, auto m) { return planar_dlb(w, m); });
}

Wrapper wrapper(double apart) {
    const Bar bar{apart};
    return {apart, least_stretch([&](Complex v) { return bar.linear(v); }),
            least_stretch([&](Complex v) { return bar.dlb(v); }), closed_form(apart)};
}

std::vector<Wrapper> wrappers() {
    std::vector<Wrapper> rows;
    for (const double angle : {90, 120, 150, 170, 180, 270}) rows.push_back(wrapper(angle * pi / 180));
    return rows;
}

std::span<const Table> dcn_tables() { return tables; }

}  // namespace probewarp::papers
