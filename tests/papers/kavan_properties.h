// Kavan et al. (TCD-CS-2006-46), Table 1: what each way of blending rigid transformations of space keeps,
// found by measuring how far it is from keeping it, and what it costs.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "counting.h"
#include "paper_tables.h"

namespace probewarp::papers {

/// The largest violation of each property over seeded random cases, as `violations` says.
struct Violations {
    double rigidity = 0;
    double bi_invariance = 0;
    double coordinate_invariance = 0;
    double more_than_two = 0;
    double constant_speed = 0;
    double shortest_path = 0;
};

/// Below it a property is kept. What keeps one is off by rounding: 1e-14 in matrices of numbers up to 10, and
/// 1e-11 in the speeds, which are differences over 2e-4. What does not keep one is off by a hundredth or
/// more.
inline constexpr double kept = 1e-8;

/// a + b n. Operations as counting.h counts them.
struct Formula {
    int constant = 0, each = 0;

    int at(int n) const { return constant + each * n; }
    friend bool operator==(const Formula&, const Formula&) = default;
};

struct Price {
    std::vector<Operations> of;  ///< of[i]: of n = 2 + i; only n = 2 for what blends two only

    Operations two() const { return of[0]; }
    /// The line through n = 2 and 3; the test holds that the others lie on it. Requires more than n = 2.
    Formula flops() const;
    Formula functions() const;  ///< sin, cos, atan2
};

struct Method {
    std::string_view name;
    Violations violations;
    Price price;
};

/// linear, decomposition, log-matrix, ScLERP, DLB, DIB.
std::vector<Method> methods();

std::span<const Table> kavan_properties_tables();

}  // namespace probewarp::papers
