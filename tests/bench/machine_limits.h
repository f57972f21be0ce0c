// What the machine itself can do, measured beside the deformation: nothing that reads as much or multiplies
// as much can be quicker.
#pragma once

#include <cstddef>
#include <span>

namespace probewarp {

/// The sum of all values, at the speed of memory. values: a multiple of 256 of them, 64-byte aligned
float read_all(std::span<const float> values);

/// `rounds` times 12 independent vectors' multiply-adds; returns how many multiply-adds of single numbers
/// these were. `sink` keeps the compiler from leaving them out.
std::size_t multiply_add(std::size_t rounds, float& sink);

}  // namespace probewarp
