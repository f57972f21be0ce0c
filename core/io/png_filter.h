// PNG's five filters, and the choice among them row by row. Private to io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace probewarp {

/// Filters that a row may get: bit k stands for filter type k of the PNG specification (third edition,
/// table 13): 0 None, 1 Sub, 2 Up, 3 Average, 4 Paeth.
using FilterSet = unsigned;
inline constexpr FilterSet no_filter = 1u << 0, up_filter = 1u << 2, sub_or_up = 1u << 1 | up_filter,
                           all_filters = 0x1F;

/// Filters a row by that filter of the set whose bytes, taken as signed, have the least sum of magnitudes
/// (the heuristic that section 12.7 of the specification recommends); by the first of equals. row, above:
/// #bytes, the second all zero above the first row; step: bytes of a pixel; out: 1 + #bytes, the filter's
/// type first. Every instruction set gives the same bytes.
void filter_row(std::span<const std::uint8_t> row, std::span<const std::uint8_t> above, std::size_t step,
                FilterSet filters, std::span<std::uint8_t> out);

/// Copies pixels without their fourth sample. rgba: #pixels x 4; rgb: #pixels x 3
void drop_alpha(std::span<const std::uint8_t> rgba, std::span<std::uint8_t> rgb);

}  // namespace probewarp
