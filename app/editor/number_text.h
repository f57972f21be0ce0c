// The numbers that a person types or pastes into a field: sums, decimal commas and points, the signs and
// spaces of typesetters, units. No locale plays a part.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace probewarp {

/// What may stand behind a number of the field: "px", "pixels"; "°", "deg", "degrees"; "%"; "×".
enum class NumberUnit { none, pixels, degrees, percent, times };

inline constexpr std::size_t max_number_text = 512;  // bytes of UTF-8; what is longer is no number

/// The value of a number, or of a sum of numbers with + - * / ( ) and their typographic likes.
///
/// Where a number has one comma or one point, it is the decimal separator. Where it has both, the last is,
/// and the other one groups thousands, as a sign that occurs several times does, and as spaces and
/// apostrophes do: "1,234.5", "1.234,5", "1 234,5", "1,234,567". Groups have three digits, the first up to
/// three. "1 × + 90 °" in degrees is a turn and 90 degrees. Empty where the text is no number, or where a
/// part of the sum is not finite.
std::optional<double> parse_number(std::string_view text, NumberUnit unit = NumberUnit::none);

/// Two numbers, such as a place copied from elsewhere: separated by a tab, a line's end, a semicolon, by a
/// comma or by spaces, perhaps within one pair of brackets. Empty where there are not exactly two, or where
/// they can be told apart in more than one way. A text that is a number may be a pair as well: ask for the
/// number first.
std::optional<std::array<double, 2>> parse_pair(std::string_view text, NumberUnit unit = NumberUnit::none);

/// Whether what was typed so far may go on to be a number: empty, a sign or a bracket to be followed by more.
bool is_unfinished_number(std::string_view text);

}  // namespace probewarp
