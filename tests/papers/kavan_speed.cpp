#include "kavan_speed.h"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string_view>

#include "math/matrix_blend.h"

namespace probewarp::papers {
namespace {

using Q = DualQuaternion<double>;
using Complex = std::complex<double>;
using std::numbers::pi;

constexpr double step = 1e-5;  // its square is what a central difference misses, rounding/1e-5 what it adds

struct LogMatrix {
    glm::dmat4 operator()(const Q& a, const Q& b, double t) const {
        return log_matrix_blend<Q>(std::array{1 - t, t}, std::array{a, b});
    }
};
struct Sclerp {
    glm::dmat4 operator()(const Q& a, const Q& b, double t) const { return to_matrix(slerp(a, b, t)); }
};

template <class Method>
glm::dmat4 derivative(const Q& a, const Q& b, double t) {
    return (Method()(a, b, t + step) - Method()(a, b, t - step)) / (2 * step);
}

struct OriginsSpeed {
    template <class Method>
    static double of(const Q& a, const Q& b, double t) {
        return glm::length(glm::dvec3(derivative<Method>(a, b, t)[3]));
    }
};

struct TurnsSpeed {
    template <class Method>
    static double of(const Q& a, const Q& b, double t) {
        const glm::dmat4 w = derivative<Method>(a, b, t) * glm::transpose(Method()(a, b, t));
        return glm::length(glm::dvec3(w[1][2] - w[2][1], w[2][0] - w[0][2], w[0][1] - w[1][0])) / 2;
    }
};

template <class Speed, class ClosedForm>
SpeedCurve curve(const Q& a, const Q& b, double sclerp, ClosedForm closed_form) {
    SpeedCurve result{{}, sclerp};
    for (int i = 0; i <= 10; ++i) {
        const double t = i / 10.0;
        result.at.push_back(
            {t, closed_form(t), Speed::template of<LogMatrix>(a, b, t), Speed::template of<Sclerp>(a, b, t)});
    }
    return result;
}

void print_curve(std::ostream& out, const SpeedCurve& curve) {
    out << "| t | closed form | numerical | of ScLERP's | ScLERP, numerical |\n|---|---|---|---|---|\n";
    for (const SpeedAt& x : curve.at)
        fmt::print(out, "| {:.1f} | {:.6f} | {:.6f} | {:.4f} | {:.6f} |\n", x.t, x.closed_form, x.numerical,
                   x.closed_form / curve.sclerp, x.sclerp);
}

void print(std::ostream& out) {
    fmt::print(
        out,
        "Speeds of exp((1 - t) log A + t log B), from the closed form derived in kavan_speed.h and as "
        "central "
        "differences over {:.0e} of our log_matrix_blend, then in parts of ScLERP's, which is constant. The "
        "paper's own example and curve are not at hand. Nothing here is random.\n\n",
        2 * step);
    const SpeedCurve origin = moving_origin(), turn = turning();
    fmt::print(
        out,
        "How fast the body's origin moves: A shifts by 1 along x, B turns by 170 degrees about the z axis. "
        "ScLERP: {:.6f} everywhere.\n\n",
        origin.sclerp);
    print_curve(out, origin);
    fmt::print(out,
               "\nHow fast the body turns, in radians: A turns by 170 degrees about x, B by 170 degrees "
               "about an axis 75 "
               "degrees from it. ScLERP: {:.6f} everywhere.\n\n",
               turn.sclerp);
    print_curve(out, turn);
}

constexpr std::array tables{
    Table{"log-matrix-speed", "Kavan, appendix B: the speed of log-matrix blending", print}};

}  // namespace

SpeedCurve moving_origin() {
    const double angle = 170 * pi / 180;
    const Q a = translation(glm::dvec3(1, 0, 0)), b = rotation(angle, glm::dvec3(0, 0, 1));
    const auto speed = [=](double t) {
        const double x = angle * t;
        const Complex v = t == 0 ? Complex(1) : (std::polar(1.0, x) - 1.0) / Complex(0, x);
        const Complex slope = t == 0 ? Complex(0, 0.5) : (std::polar(1.0, x) - v) / x;
        return std::abs(angle * (1 - t) * slope - v);
    };
    return curve<OriginsSpeed>(a, b, angle / (2 * std::sin(angle / 2)), speed);
}

SpeedCurve turning() {
    const double angle = 170 * pi / 180, apart = 75 * pi / 180;
    const glm::dvec3 first(1, 0, 0), second(std::cos(apart), std::sin(apart), 0);
    const Q a = rotation(angle, first), b = rotation(angle, second);
    const auto speed = [=](double t) {
        const glm::dvec3 l = angle * ((1 - t) * first + t * second), change = angle * (second - first);
        const double size = glm::length(l), along = glm::dot(l, change) / size;
        const double s = std::sin(size / 2) / (size / 2);
        return std::sqrt(along * along + s * s * (glm::dot(change, change) - along * along));
    };
    return curve<TurnsSpeed>(a, b, 2 * std::acos(std::abs(rotation_dot(a, b))), speed);
}

std::span<const Table> kavan_speed_tables() { return tables; }

}  // namespace probewarp::papers
