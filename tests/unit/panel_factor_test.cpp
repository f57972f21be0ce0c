// The factor in panels against Eigen's own, on the energy's pattern.
#include "model/panel_factor.h"

#include "shape_scene.h"

namespace probewarp {
namespace {

using namespace testing;
using Factor = Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>>;

/// L^2 + 1 on some random shape: its pattern is the energy's, and its condition number below 20^2.
SparseMatrix any_matrix() {
    const SparseMatrix stiffness = laplacian(shape_of(any_scene(1)->mesh));
    SparseMatrix matrix = stiffness * stiffness;
    matrix.diagonal().array() += 1;
    return matrix;
}

/// 6e-8 in float, times the condition number, and the square root of a hundred unknowns.
constexpr float rounding = 3e-4f;

TEST(PanelFactor, SolvesAsEigenDoes) {
    expect_always("panels = Eigen", [] {
        const SparseMatrix matrix = any_matrix();
        const Factor factor(matrix);
        const SparseMatrix lower = factor.matrixL();
        const Panels panels = panels_of(lower);
        FloatSides sides(matrix.rows(), abreast);
        for (Eigen::Index k = 0; k < sides.size(); ++k) sides.data()[k] = float(*real(-1, 1));
        const Eigen::MatrixXd exact = factor.solve(sides.matrix().cast<double>());
        solve_by_panels(panels, panel_values(panels, lower), sides);
        RC_ASSERT((sides.matrix().cast<double>() - exact).cwiseAbs().maxCoeff() < double(rounding));
    });
}

TEST(PanelFactor, IsRaisedAsIfFactoredAnew) {
    expect_always("raised = anew", [] {
        SparseMatrix matrix = any_matrix();
        const SparseMatrix before = Factor(matrix).matrixL();
        const Panels panels = panels_of(before);
        std::vector<float> values = panel_values(panels, before);
        DiagonalRaiser raiser(panels);
        for (int turn = 0; turn < 3; ++turn) {
            std::array<Raise, 3> raises;
            for (Raise& raise : raises) {  // also twice at one place, and by nothing
                raise = {*whole(0, int(matrix.rows()) - 1), *whole(0, 3) == 0 ? 0 : float(*real(0, 300))};
                matrix.coeffRef(raise.at, raise.at) += double(raise.by);
            }
            raiser.raise(raises, values);
        }
        const std::vector<float> anew = panel_values(panels, Factor(matrix).matrixL());
        for (std::size_t k = 0; k < anew.size(); ++k)
            RC_ASSERT(std::abs(values[k] - anew[k]) < rounding * std::max(1.0f, std::abs(anew[k])));
    });
}

}  // namespace
}  // namespace probewarp
