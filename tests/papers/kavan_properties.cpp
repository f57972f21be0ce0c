#include "kavan_properties.h"

#include <fmt/ostream.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "math/matrix_blend.h"
#include "random.h"

namespace probewarp::papers {
namespace {

using Q = DualQuaternion<double>;
template <class T>
using Weights = std::span<const T>;
template <class T>
using Elements = std::span<const DualQuaternion<T>>;
template <class T>
using Matrix = glm::mat<4, 4, T>;

// ---- The methods: blend(weights, p) gives a matrix, p and -p being the same; priced(weights, p) is the same
// ---- for p whose signs are chosen already, over a counting scalar.

/// Each p_i with the sign that is nearer to the pivot.
std::vector<Q> aligned(Weights<double> weights, Elements<double> p) {
    const Q centre = pivot(weights, p);
    std::vector<Q> result(p.begin(), p.end());
    for (Q& x : result)
        if (rotation_dot(x, centre) < 0) x = -x;
    return result;
}

struct Linear {
    template <class T>
    static Matrix<T> priced(Weights<T> weights, Elements<T> p) {
        return linear_matrix_blend(weights, p);
    }
    static Matrix<double> blend(Weights<double> weights, Elements<double> p) { return priced(weights, p); }
};

struct Decomposition {
    template <class T>
    static Matrix<T> priced(Weights<T> weights, Elements<T> p) {  // decomposition_blend, but for the signs
        auto result = to_matrix(dlb(weights, p).p);
        result[3] = to_matrix(p[0])[3] * weights[0];
        for (std::size_t i = 1; i < p.size(); ++i) result[3] += to_matrix(p[i])[3] * weights[i];
        return result;
    }
    static Matrix<double> blend(Weights<double> weights, Elements<double> p) {
        return decomposition_blend(weights, p);
    }
};

struct LogMatrix {
    template <class T>
    static Matrix<T> priced(Weights<T> weights, Elements<T> p) {
        return log_matrix_blend(weights, p);
    }
    static Matrix<double> blend(Weights<double> weights, Elements<double> p) { return priced(weights, p); }
};

/// Of more than two, one after the other.
struct Sclerp {
    template <class T>
    static Matrix<T> priced(Weights<T> weights, Elements<T> p) {
        return to_matrix(slerp(p[0], p[1], weights[1]));
    }
    static Matrix<double> blend(Weights<double> weights, Elements<double> p) {
        Q at = p[0];
        double total = weights[0];
        for (std::size_t i = 1; i < p.size(); ++i) {
            total += weights[i];
            at = slerp(at, rotation_dot(at, p[i]) < 0 ? -p[i] : p[i], weights[i] / total);
        }
        return to_matrix(at);
    }
};

struct Dlb {
    template <class T>
    static Matrix<T> priced(Weights<T> weights, Elements<T> p) {
        return to_matrix(dlb(weights, p).p);
    }
    static Matrix<double> blend(Weights<double> weights, Elements<double> p) {
        return to_matrix(dlb_shortest(weights, p).p);
    }
};

struct Dib {
    template <class T>
    static Matrix<T> priced(Weights<T> weights, Elements<T> p) {  // one step, which is all that two take
        return to_matrix(dib(weights, p, T(0), 1).p);
    }
    static Matrix<double> blend(Weights<double> weights, Elements<double> p) {
        return to_matrix(dib<Q>(weights, aligned(weights, p), 1e-15, 100).p);
    }
};

// ---- The violations.

double distance(const glm::dmat4& a, const glm::dmat4& b) {
    double most = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) most = std::max(most, std::abs(a[i][j] - b[i][j]));
    return most;
}

struct Set {
    std::vector<double> weights;
    std::vector<Q> p;
};

/// Four transformations with rotations within 60 degrees of one, of either sign: near enough for their blend
/// to be one and the same for every method.
Set random_set(Random& random) {
    Set set{std::vector<double>(4), {}};
    random.weights(set.weights);
    const Q shared = random.anywhere();
    for (int i = 0; i < 4; ++i) set.p.push_back(random.within(std::numbers::pi / 3) * shared);
    return set;
}

template <class M>
glm::dmat4 blend(const Set& set) {
    return M::blend(set.weights, set.p);
}

double not_rigid(const glm::dmat4& m) {
    const glm::dmat3 r(m);
    return std::max(distance(glm::dmat4(glm::transpose(r) * r), glm::dmat4(1)),
                    std::abs(glm::determinant(r) - 1));
}

/// How far from A blend(p) B the blend of the A p B is.
template <class M>
double not_moved_along(const Set& set, const Q& a, const Q& b) {
    Set moved = set;
    for (Q& p : moved.p) p = a * p * b;
    return distance(blend<M>(moved), to_matrix(a) * blend<M>(set) * to_matrix(b));
}

/// How far the blend in another order is from the blend.
template <class M>
double in_another_order(const Set& set) {
    Set other = set;
    std::ranges::reverse(other.weights);
    std::ranges::reverse(other.p);
    return distance(blend<M>(other), blend<M>(set));
}

template <class M>
glm::dmat4 between(const Q& p, const Q& q, double t) {
    return M::blend(std::array{1 - t, t}, std::array{p, q});
}

/// The screw velocity M' M^-1 at t: radians, and the shift along the axis, per unit of t.
struct Speed {
    double turn, shift;
};

template <class M>
Speed speed(const Q& p, const Q& q, double t) {
    constexpr double h = 1e-4;  // a central difference errs by h^2 of the third derivative, alike at every t
    const glm::dmat4 change = (between<M>(p, q, t + h) - between<M>(p, q, t - h)) / (2 * h);
    const glm::dmat4 v = change * glm::inverse(between<M>(p, q, t));
    const glm::dvec3 turn{(v[1][2] - v[2][1]) / 2, (v[2][0] - v[0][2]) / 2, (v[0][1] - v[1][0]) / 2};
    const double size = glm::length(turn);
    return {size, glm::dot(glm::dvec3(v[3]), turn) / size};
}

/// By how much the speed varies from what it is halfway, in parts of that: the turn's, or the shift's along
/// the axis where that is more (in parts of all speed, since a shift may be 0).
template <class M>
double uneven(const Q& p, const Q& q) {
    const Speed half = speed<M>(p, q, 0.5);
    const double all = half.turn + std::abs(half.shift);
    double most = 0;
    for (const double t : {0.05, 0.2, 0.35, 0.65, 0.8, 0.95}) {
        const Speed at = speed<M>(p, q, t);
        most = std::max(
            {most, std::abs(at.turn - half.turn) / half.turn, std::abs(at.shift - half.shift) / all});
    }
    return most;
}

/// The rotation nearest to a matrix.
Eigen::Matrix3d nearest_rotation(const glm::dmat4& m) {
    Eigen::Matrix3d r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) r(j, i) = m[i][j];
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return svd.matrixU() * svd.matrixV().transpose();
}

double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
    return 2 * std::asin(std::min(1.0, (a - b).norm() / std::sqrt(8.0)));
}

/// By how much the way that the rotation goes from p to q is longer than the angle between them, in [0, pi],
/// in parts of that.
template <class M>
double detour(const Q& p, const Q& q) {
    constexpr int parts = 16;
    const Eigen::Matrix3d first = nearest_rotation(between<M>(p, q, 0));
    Eigen::Matrix3d last = first;
    double way = 0;
    for (int i = 1; i <= parts; ++i) {
        const Eigen::Matrix3d next = nearest_rotation(between<M>(p, q, double(i) / parts));
        way += angle_between(last, next);
        last = next;
    }
    return way / angle_between(first, last) - 1;
}

/// Two whose rotations are between 30 and 170 degrees apart: with less there is hardly a way, and at 180
/// there are two.
std::array<Q, 2> random_pair(Random& random) {
    for (;;) {
        const Q p = random.anywhere(), q = random.anywhere();
        const double angle = 2 * std::acos(std::min(1.0, std::abs(rotation_dot(p, q))));
        if (angle > std::numbers::pi / 6 && angle < std::numbers::pi * 17 / 18) return {p, q};
    }
}

void raise(double& most, double x) { most = std::max(most, x); }

template <class M>
Violations violations() {
    constexpr int cases = 500;
    Random random;
    Violations v;
    for (int i = 0; i < cases; ++i) {
        const Set set = random_set(random);
        const Q a = random.anywhere(), b = random.anywhere();
        raise(v.rigidity, not_rigid(blend<M>(set)));
        raise(v.bi_invariance, not_moved_along<M>(set, a, b));
        raise(v.coordinate_invariance, not_moved_along<M>(set, a, inverse(a)));
        raise(v.more_than_two, in_another_order<M>(set));
        const auto [p, q] = random_pair(random);
        raise(v.constant_speed, uneven<M>(p, q));
        raise(v.shortest_path, detour<M>(p, q));
    }
    return v;
}

// ---- The price.

/// Of n transformations, already with the signs that they are blended with.
template <class M>
Operations price_of(std::size_t n) {
    Random random;
    std::vector<Counting> weights;
    std::vector<DualQuaternion<Counting>> p;
    for (std::size_t i = 0; i < n; ++i) {
        Q x = random.within(1);
        if (x.q0.w < 0) x = -x;
        weights.emplace_back(1.0 / double(i + 2));
        p.push_back({{x.q0.w, x.q0.x, x.q0.y, x.q0.z}, {x.qe.w, x.qe.x, x.qe.y, x.qe.z}});
    }
    return count([&] { M::template priced<Counting>(weights, p); });
}

template <class M>
Price price(std::size_t most) {
    Price price;
    for (std::size_t n = 2; n <= most; ++n) price.of.push_back(price_of<M>(n));
    return price;
}

template <class M>
Method method(std::string_view name, std::size_t most = 10) {
    return {name, violations<M>(), price<M>(most)};
}

// ---- Printing.

std::string verdict(double violation) {
    return fmt::format("{} ({:.0e})", violation < kept ? "+" : "-", violation);
}

void print_properties(std::ostream& out) {
    fmt::print(
        out,
        "The largest violation over 500 seeded random cases (seed {}); + where it is below {:.0e}. The "
        "paper's own "
        "table is not at hand; its abstract claims constant speed, shortest path and coordinate invariance "
        "for dual "
        "quaternions. Sets are of 4 transformations with convex weights, rotations within 60 degrees of "
        "one and shifts in [-1, 1]^3, each as q or -q; pairs have rotations 30 to 170 degrees apart.\n\n"
        "- Rigid: how far R^T R is from 1, or det R from 1.\n"
        "- Bi-invariant: how far the blend of A p_i B is from A (the blend of p_i) B, for random A, B.\n"
        "- Coordinate-invariant: the same with B = A^-1.\n"
        "- n > 2: how far the blend of 4 is from their blend in the reverse order (ScLERP one after the "
        "other).\n"
        "- Constant speed: how much the turn per unit of t, or the shift along the screw's axis, varies over "
        "t, in "
        "parts of what it is halfway.\n"
        "- Shortest path: how much longer the rotation's way is than the angle between the ends, in parts of "
        "that; for linear blending the way of the nearest rotation.\n\n",
        seed, kept);
    out << "| method | rigid | bi-invariant | coordinate-invariant | n > 2 | constant speed | shortest path "
           "|\n"
           "|---|---|---|---|---|---|---|\n";
    for (const Method& m : methods()) {
        const Violations& v = m.violations;
        fmt::print(out, "| {} | {} | {} | {} | {} | {} | {} |\n", m.name, verdict(v.rigidity),
                   verdict(v.bi_invariance), verdict(v.coordinate_invariance), verdict(v.more_than_two),
                   verdict(v.constant_speed), verdict(v.shortest_path));
    }
}

std::string line(const Formula& f) {
    return fmt::format("{} {} {} n", f.constant, f.each < 0 ? '-' : '+', std::abs(f.each));
}

std::string row(const Price& p) {
    const std::string two = fmt::format("{} | {}", p.two().flops(), p.two().functions);
    if (p.of.size() < 2) return two + " | two only | two only";
    return fmt::format("{} | {} | {}", two, line(p.flops()), line(p.functions()));
}

void print_price(std::ostream& out) {
    const Q any = Random().anywhere();
    const DualQuaternion<Counting> q{{any.q0.w, any.q0.x, any.q0.y, any.q0.z},
                                     {any.qe.w, any.qe.x, any.qe.y, any.qe.z}};
    fmt::print(
        out,
        "FLOPS (+, -, *, /, square roots) from n unit dual quaternions to one 4 x 4 matrix, counted by "
        "running "
        "core/math over a counting scalar, and apart from them the calls of sin, cos and atan2. The signs of "
        "the p_i are chosen before; to compare one with another costs 7. A conversion to a matrix is {} of "
        "them: linear blending and decomposition convert every p_i, the others their result. The logarithms "
        "of "
        "log-matrix are taken on dual quaternions. DIB: DLB and one step; each further step costs what DIB "
        "costs over DLB. The paper's figures are not at hand.\n\n"
        "| method | n = 2 | functions | FLOPS of n | functions of n | paper |\n|---|---|---|---|---|---|\n",
        count([&] { to_matrix(q); }).flops());
    for (const Method& m : methods()) fmt::print(out, "| {} | {} | not at hand |\n", m.name, row(m.price));
}

constexpr std::array tables{
    Table{"blend-properties", "Kavan, Table 1: what each method keeps", print_properties},
    Table{"blend-flops", "Kavan, Table 1: what each method costs", print_price}};

}  // namespace

Formula Price::flops() const {
    const int each = of[1].flops() - of[0].flops();
    return {of[0].flops() - 2 * each, each};
}

Formula Price::functions() const {
    const int each = of[1].functions - of[0].functions;
    return {of[0].functions - 2 * each, each};
}

std::vector<Method> methods() {
    return {method<Linear>("linear"),
            method<Decomposition>("decomposition"),
            method<LogMatrix>("log-matrix"),
            method<Sclerp>("ScLERP", 2),
            method<Dlb>("DLB"),
            method<Dib>("DIB")};
}

std::span<const Table> kavan_properties_tables() { return tables; }

}  // namespace probewarp::papers
