// Which of the machine's instruction sets the vector code uses: the widest, unless one is asked for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/error.h"

namespace probewarp {

/// The variable of the environment that limits the instruction set.
inline constexpr const char* instruction_set_variable = "PROBEWARP_INSTRUCTION_SET";

/// The sets that may be used: those that this machine has, this program has code for, and no limit excludes.
/// From the widest, which is the one in use, on; by Highway's names in lower case: "avx2". The last is
/// "baseline": what every processor of this kind has.
std::vector<std::string> instruction_sets();

/// From now on no set is used that is wider than `name`; where the machine lacks that one, the widest below
/// it. A later limit replaces it. Throws Error for a name that this program has no code for: a clause that
/// lists them.
void limit_instruction_set(std::string_view name);

/// Limits the set to what instruction_set_variable names; nothing happens where that is unset or empty. To be
/// called before there are other threads. Throws Error, which names the variable.
void limit_instruction_set_by_environment();

}  // namespace probewarp
