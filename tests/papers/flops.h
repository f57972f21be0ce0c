// MKO, Table 1 (arXiv 1601.01754): what the plane's rigid transformations cost in four representations.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "paper_tables.h"

namespace probewarp::papers {

/// Floating-point operations, and scalars of memory.
struct Cost {
    int transform = 0;  ///< a point
    int compose = 0;    ///< two transformations
    int convert = 0;    ///< to a homogeneous matrix of reals
    int scalars = 0;    ///< that one is held in
};

struct Representation {
    std::string_view name;
    Cost ours;                  ///< counted by running core/math on a counting scalar
    std::optional<Cost> paper;  ///< where it is at hand
};

/// DCN, unit dual quaternions, 2 x 2 complex and 3 x 3 real matrices.
std::vector<Representation> representations();

/// Nanoseconds for one of each, in double; measured, so never twice the same.
struct Times {
    double transform = 0, compose = 0, convert = 0;
};
std::vector<Times> measured_times();  ///< in the order of representations()

std::span<const Table> flops_tables();

}  // namespace probewarp::papers
