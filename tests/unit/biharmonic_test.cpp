// The biharmonic weights: known answers, how near they come to the least energy, and that they do not depend
// on how the probes came to where they are.
#include <Eigen/SparseCholesky>

#include "model/error.h"
#include "model/shape_laplacian.h"
#include "shape_scene.h"

namespace probewarp {
namespace {

using namespace testing;

TEST(Biharmonic, SaysWhatToDoWhereTheMeshIsTooFine) {
    Scene scene(whole_grid(700, 700), {{12, 13}});
    try {
        biharmonic_table(scene.input());
        ADD_FAILURE() << "took it";
    } catch (const Error& error) {
        EXPECT_STREQ(
            error.what(),
            "biharmonic weights take at most 330000 vertices, and the mesh has 491401: choose a coarser "
            "mesh or the harmonic weights");
    }
}

TEST(Biharmonic, ComesToRestInThePlane) {
    // Two probes side by side: 1 behind either, and in between where thirty times as many rounds of the
    // search end. The harmonic shares are 0.75 two cells off.
    Scene scene(whole_grid(40, 40), {{100, 200}, {300, 200}});
    const Table harmonic = harmonic_table(scene.input()), table = biharmonic_table(scene.input());
    EXPECT_LT(share(harmonic, 2, scene.at(12, 20), 0), 0.8);
    for (const auto& [column, rest] : {std::pair{5, 1.0}, {8, 1.0}, {12, 0.9368}, {14, 0.8460}, {16, 0.7388}})
        EXPECT_NEAR(share(table, 2, scene.at(column, 20), 0), rest, 0.008) << column;  // see `ladder`
    // A half where one is as far as the other, from either side alike (solved in floats).
    for (int row = 0; row <= 40; ++row) EXPECT_NEAR(share(table, 2, scene.at(20, row), 0), 0.5, 1e-5) << row;
}

TEST(Biharmonic, IsSmoothAndBoundedBetweenTwoProbes) {
    // Between the ends of a strip the energy is least for the cubic 1 - 3 t^2 + 2 t^3, flat at either end,
    // where the bounds keep it from going beyond.
    constexpr int n = 40;
    Scene scene(whole_grid(n, 1), {{0, 5}, {n * cell, 5}});
    const Table table = biharmonic_table(scene.input());
    for (int column = 0; column <= n; ++column) {
        const double t = double(column) / n;
        // The search ends within some thousandths, and a grid's curve bends a cell later.
        EXPECT_NEAR(share(table, 2, scene.at(column, 0), 0), 1 - 3 * t * t + 2 * t * t * t, 0.02) << column;
    }
}

/// The energy of Jacobson et al. (2011), equation 2, with the places' holds; and its minimiser.
struct Problem {
    SparseMatrix energy, held;
    Eigen::MatrixXd pulls, least;  ///< #grid vertices x #places

    explicit Problem(Scene& scene) {
        const WeightInput input = scene.input();
        const Shape shape = shape_of(scene.mesh);
        const auto places = places_of(input, shape);
        const SparseMatrix stiffness = laplacian(shape);
        const Eigen::VectorXd areas = lumped_areas(shape);
        energy = held = stiffness * areas.cwiseInverse().asDiagonal() * stiffness;
        pulls.setZero(energy.rows(), Eigen::Index(places.size()));
        for (std::size_t p = 0; p < places.size(); ++p)
            for (std::size_t i = 0; i < 3; ++i) {
                const auto corner = Eigen::Index(places[p].corners[i]);
                const double hold = 300 * places[p].share[i] * places[p].share[i];
                held.coeffRef(corner, corner) += hold;
                pulls(corner, Eigen::Index(p)) += hold;
            }
        minimise(areas);
    }
    /// Boyd et al. (2011), section 5.2, plainly: in doubles, with one rho after the other until it rests.
    void minimise(const Eigen::VectorXd& areas) {
        Eigen::MatrixXd unbalanced = 0 * pulls, smooth;
        least = 0 * pulls;
        double rho = 0;
        for (const double next : {1e-3, 1e-2, 1e-1, 1e-2, 1e-3, 1e-2, 1e-1}) {
            unbalanced *= rho / next;
            rho = next;
            SparseMatrix matrix = held;
            matrix.diagonal() += rho * areas;
            const Eigen::SimplicialLLT<SparseMatrix> factor(matrix);
            for (int round = 0; round < 400; ++round) {
                smooth = factor.solve(pulls + rho * areas.asDiagonal() * (least - unbalanced));
                least = (smooth + unbalanced).cwiseMax(0).cwiseMin(1);
                unbalanced += smooth - least;
            }
        }
    }
    /// Of shares with that energy, 0 where all holds have what they want.
    double operator()(const Eigen::MatrixXd& shares) const {
        return 0.5 * (shares.cwiseProduct(held * shares) - 2 * shares.cwiseProduct(pulls) + pulls).sum();
    }
};

TEST(Biharmonic, ComesNearTheLeastEnergy) {
    auto limbs = whole_grid(30, 30);
    for (int row = 8; row < 30; ++row) limbs[std::size_t(row)][14] = '.';
    const std::vector<glm::dvec2> rests{{31, 42},  {152, 20}, {255, 51},  {102, 188}, {213, 150},
                                        {88, 275}, {45, 60},  {240, 240}, {225, 262}, {190, 60}};
    for (const auto& cells : {whole_grid(30, 30), limbs}) {
        Scene scene(cells, rests);
        const Problem problem(scene);
        const Table table = biharmonic_table(scene.input());
        Eigen::MatrixXd shares(problem.least.rows(), problem.least.cols());
        Eigen::MatrixXd rest = problem.least;
        for (Eigen::Index v = 0; v < shares.rows(); ++v) {
            for (Eigen::Index p = 0; p < shares.cols(); ++p)
                shares(v, p) = share(table, rests.size(), std::size_t(v), std::size_t(p));
            rest.row(v) /= rest.row(v).sum();
        }
        // Half as much again as is measured: 0.003, 0.022 and 0.8 per cent. A tenth of the rounds: three
        // times that.
        EXPECT_LT(std::sqrt((shares - rest).squaredNorm() / double(rest.size())), 0.005);
        EXPECT_LT((shares - rest).cwiseAbs().maxCoeff(), 0.035);
        EXPECT_LT(problem(shares), 1.013 * problem(rest));
    }
}

TEST(Biharmonic, IsTheSameBitForBitHoweverTheProbesCame) {
    std::vector<glm::dvec2> rests{{31, 42}, {102, 20}, {105, 101}};
    std::shared_ptr<WeightCache> kept;
    // There, on a vertex, onto another probe (two places instead of three, so that other factors are made),
    // and back.
    for (const glm::dvec2 rest : {glm::dvec2{31, 42}, {77, 93}, {80, 90}, {102, 20}, {33, 44}, {31, 42}}) {
        rests[0] = rest;
        Scene moved(whole_grid(12, 12), rests), anew(whole_grid(12, 12), rests);
        moved.cache = kept;
        EXPECT_EQ(biharmonic_table(moved.input()), biharmonic_table(anew.input()))
            << rest.x << ", " << rest.y;
        kept = moved.cache;
    }
}

}  // namespace
}  // namespace probewarp
