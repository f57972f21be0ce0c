// Kavan, Table 1: each method's pluses and minuses as measured, and its cost.
#include "kavan_properties.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace probewarp::papers {
namespace {

const Method& method(std::string_view name) {
    static const auto all = methods();
    for (const Method& m : all)
        if (m.name == name) return m;
    throw std::runtime_error("There is no method " + std::string(name) + ".");
}

/// Rigid, bi-invariant, coordinate-invariant, n > 2, constant speed, shortest path; what is neither kept nor
/// plainly violated is '?'.
std::string verdicts(const Violations& v) {
    std::string result;
    for (const double x : {v.rigidity, v.bi_invariance, v.coordinate_invariance, v.more_than_two,
                           v.constant_speed, v.shortest_path})
        result += x < kept ? '+' : x > 0.01 ? '-' : '?';
    return result;
}

TEST(KavanTable1, PlusesAndMinuses) {
    EXPECT_EQ(verdicts(method("linear").violations), "-+++-+");
    EXPECT_EQ(verdicts(method("decomposition").violations), "+--+-+");
    EXPECT_EQ(verdicts(method("log-matrix").violations), "+-++--");
    EXPECT_EQ(verdicts(method("ScLERP").violations), "+++-++");
    EXPECT_EQ(verdicts(method("DLB").violations), "++++-+");
    EXPECT_EQ(verdicts(method("DIB").violations), "++++++");
}

TEST(KavanTable1, FlopsAreAConstantAndSoManyEach) {
    for (const char* name : {"linear", "decomposition", "log-matrix", "DLB", "DIB"}) {
        const Price& price = method(name).price;
        ASSERT_EQ(price.of.size(), 9u) << name;
        for (std::size_t i = 0; i < price.of.size(); ++i) {
            EXPECT_EQ(price.of[i].flops(), price.flops().at(int(i) + 2)) << name;
            EXPECT_EQ(price.of[i].functions, price.functions().at(int(i) + 2)) << name;
        }
    }
}

TEST(KavanTable1, FlopsAreTheFormulasByHand) {
    // Each a conversion (61), 16 products and 16 sums; the first is not summed.
    EXPECT_EQ(method("linear").price.flops(), (Formula{-16, 93}));
    // Each 8 products, 8 sums, a sum of weights and a division by it; less the first's 9 sums, the guard
    // against cancelling 9, the norm 18, its inverse 3, their product 16, the conversion 61.
    EXPECT_EQ(method("DLB").price.flops(), (Formula{98, 18}));
    // DLB, and each a conversion, 4 products and 4 sums; the first is not summed.
    EXPECT_EQ(method("decomposition").price.flops(), (Formula{98 - 4, 18 + 69}));
}

TEST(KavanTable1, DlbIsTheCheapestAndDibDearerThanSclerp) {
    for (const char* name : {"linear", "decomposition", "log-matrix", "ScLERP", "DIB"})
        EXPECT_LT(method("DLB").price.two().flops(), method(name).price.two().flops()) << name;
    EXPECT_GT(method("DIB").price.two().flops(), method("ScLERP").price.two().flops());
}

}  // namespace
}  // namespace probewarp::papers
