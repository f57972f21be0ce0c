// The factor in panels against Eigen's own, on the energy's pattern; and that updating it is factoring anew.
#include "model/panel_cholesky.h"

#include <Eigen/SparseCholesky>

#include "model/error.h"
#include "shape_scene.h"

namespace probewarp {
namespace {

using namespace testing;
using Factor = Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>>;

constexpr auto no_check = [] {};

PanelCholesky factored(const SparseMatrix& matrix) {
    PanelCholesky cholesky = prepare_cholesky(matrix);
    update_cholesky(cholesky, matrix, no_check);
    return cholesky;
}

/// L^2 + 1 on a shape: its pattern is the energy's, and its condition number below 20^2.
SparseMatrix energy_of(const Scene& scene) {
    const SparseMatrix stiffness = laplacian(shape_of(scene.mesh));
    SparseMatrix matrix = stiffness * stiffness;
    matrix.diagonal().array() += 1;
    return matrix;
}

SparseMatrix any_matrix() { return energy_of(*any_scene(1)); }

/// 6e-8 in float, times the condition number, and the square root of a hundred unknowns.
constexpr float rounding = 3e-4f;

/// For right-hand sides of such numbers.
template <class T, class Number>
double apart_from_eigen(const SparseMatrix& matrix, Number number) {
    const PanelCholesky cholesky = factored(matrix);
    const std::vector<T> values(cholesky.values.begin(), cholesky.values.end());
    Sides<T> sides(matrix.rows(), side_by_side<T>);
    for (Eigen::Index k = 0; k < sides.size(); ++k) sides.data()[k] = T(number());
    const Eigen::MatrixXd exact = Factor(matrix).solve(sides.matrix().template cast<double>());
    solve_by_panels<T>(cholesky.panels, values, sides);
    return (sides.matrix().template cast<double>() - exact).cwiseAbs().maxCoeff();
}

TEST(PanelFactor, SolvesAsEigenDoes) {
    expect_always("panels = Eigen", [] {
        const SparseMatrix matrix = any_matrix();
        const auto any = [] { return *real(-1, 1); };
        RC_ASSERT(apart_from_eigen<float>(matrix, any) < double(rounding));
        RC_ASSERT(apart_from_eigen<double>(matrix, any) < double(rounding) * 0x1p-29);
    });
}

TEST(PanelFactor, SolvesAsEigenDoesWhereItIsLarge) {
    // In the order in which the weights have it, with panels of more than forty columns.
    const SparseMatrix energy = energy_of(Scene(whole_grid(40, 40), {{1, 1}}));
    SparseMatrix matrix;
    matrix = energy.twistedBy(elimination_order(energy));
    const double error = apart_from_eigen<double>(matrix, [next = 0]() mutable { return std::sin(++next); });
    EXPECT_LT(error, double(rounding) * 0x1p-29);
    const auto panels = factored(matrix).panels.panels;
    EXPECT_GT(std::ranges::max_element(panels, {}, &Panels::Panel::columns)->columns, 40);
}

TEST(PanelFactor, HoldsEigensEntriesAndNoOthers) {
    expect_always("every entry of L in its place, the diagonal inverted", [] {
        const SparseMatrix matrix = any_matrix(), lower = Factor(matrix).matrixL();
        const PanelCholesky cholesky = factored(matrix);
        const Panels& panels = cholesky.panels;
        Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(matrix.rows(), matrix.cols());
        std::size_t entries = 0;
        for (const Panels::Panel& panel : panels.panels)
            for (int k = 0; k < panel.columns; ++k)
                for (int i = k; i < panel.columns + panel.rows_below; ++i, ++entries) {
                    const int below = i - panel.columns;
                    const int row =
                        below < 0 ? panel.first + i : panels.rows[panel.below + std::size_t(below)];
                    const double value = cholesky.values[panel.values + std::size_t(i * panel.columns + k)];
                    dense(row, panel.first + k) = i == k ? 1 / value : value;
                }
        RC_ASSERT(entries == std::size_t(lower.nonZeros()));
        RC_ASSERT((dense - Eigen::MatrixXd(lower)).cwiseAbs().maxCoeff() < 1e-12);
    });
}

TEST(PanelFactor, UpdatesOnlyWhatAChangeReachesAndEveryBitIsAsAnew) {
    expect_always("some entries changed, some updates broken off", [] {
        SparseMatrix matrix = any_matrix();
        PanelCholesky cholesky = factored(matrix);
        for (int turn = 0; turn < 4; ++turn) {
            for (int k = *whole(0, 2); k > 0; --k) {
                const int at = *whole(0, int(matrix.rows()) - 1);
                matrix.coeffRef(at, at) += *real(0, 300);
            }
            int left = *whole(0, 10);
            const auto break_off = [&] {
                if (left-- == 0) throw GivenUp();
            };
            try {
                update_cholesky(cholesky, matrix, break_off);
            } catch (const GivenUp&) {
            }
        }
        update_cholesky(cholesky, matrix, no_check);
        RC_ASSERT(cholesky.values == factored(matrix).values);
        RC_ASSERT(update_cholesky(cholesky, matrix, no_check) == 0u);
        // A change reaches the panels from its own on, each the one of the first row below the last, and no
        // others.
        const int at = *whole(0, int(matrix.rows()) - 1);
        const Panels& panels = cholesky.panels;
        std::size_t reached = 1;
        const Panels::Panel* panel = &panels.panels[std::size_t(panels.panel_of[std::size_t(at)])];
        for (; panel->rows_below > 0; ++reached) {
            const int row = panels.rows[panel->below];
            panel = &panels.panels[std::size_t(panels.panel_of[std::size_t(row)])];
        }
        matrix.coeffRef(at, at) += 1;
        RC_ASSERT(update_cholesky(cholesky, matrix, no_check) == reached);
    });
}

TEST(PanelFactor, SaysSoWhereAMatrixIsNotDefinite) {
    SparseMatrix matrix = energy_of(Scene(whole_grid(4, 3), {{1, 1}}));
    PanelCholesky cholesky = prepare_cholesky(matrix);
    matrix.coeffRef(3, 3) = -5;
    for (int turn = 0; turn < 2; ++turn)
        EXPECT_THROW(update_cholesky(cholesky, matrix, no_check), Error) << turn;
    matrix.coeffRef(3, 3) = 5;
    EXPECT_NO_THROW(update_cholesky(cholesky, matrix, no_check));
    EXPECT_EQ(cholesky.values, factored(matrix).values);
}

TEST(PanelFactor, IsRaisedAsIfFactoredAnew) {
    expect_always("raised = anew", [] {
        SparseMatrix matrix = any_matrix();
        const PanelCholesky before = factored(matrix);
        std::vector<float> values(before.values.begin(), before.values.end());
        DiagonalRaiser raiser(before.panels);
        for (int turn = 0; turn < 3; ++turn) {
            std::array<Raise, 3> raises;
            for (Raise& raise : raises) {  // also twice at one place, and by nothing
                raise = {*whole(0, int(matrix.rows()) - 1), *whole(0, 3) == 0 ? 0 : float(*real(0, 300))};
                matrix.coeffRef(raise.at, raise.at) += double(raise.by);
            }
            raiser.raise(raises, values);
        }
        const std::vector<double> anew = factored(matrix).values;
        for (std::size_t k = 0; k < anew.size(); ++k)
            RC_ASSERT(std::abs(double(values[k]) - anew[k]) <
                      double(rounding) * std::max(1.0, std::abs(anew[k])));
    });
}

}  // namespace
}  // namespace probewarp
