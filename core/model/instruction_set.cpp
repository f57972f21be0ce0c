#include "model/instruction_set.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cstdlib>

namespace probewarp {

namespace {

constexpr std::int64_t known_targets = HWY_TARGETS, baseline = HWY_STATIC_TARGET;

std::string name_of(std::int64_t target) {
    if (target == baseline) return "baseline";
    std::string name = hwy::TargetName(target);
    for (char& c : name)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return name;
}

/// The sets among `targets`, one bit each. A wider one has the lower bit.
std::vector<std::int64_t> sets_in(std::int64_t targets) {
    std::vector<std::int64_t> sets;
    for (std::int64_t left = targets & known_targets; left != 0; left &= left - 1)
        sets.push_back(left & -left);
    return sets;
}

std::vector<std::string> names_of(std::int64_t targets) {
    std::vector<std::string> names;
    for (const std::int64_t set : sets_in(targets)) names.push_back(name_of(set));
    return names;
}

/// The next call of vector code chooses anew.
void forget_choice() { hwy::GetChosenTarget().DeInit(); }

}  // namespace

std::vector<std::string> instruction_sets() {
    const std::int64_t supported = hwy::SupportedTargets();
    forget_choice();  // asking made one that no limit was heeded for
    return names_of(supported | baseline);
}

void limit_instruction_set(std::string_view name) {
    const std::vector<std::int64_t> sets = sets_in(known_targets);
    const auto found = std::ranges::find_if(sets, [&](std::int64_t set) { return name_of(set) == name; });
    if (found == sets.end())
        throw Error(fmt::format("is no instruction set that this program knows; expected one of {}",
                                fmt::join(names_of(known_targets), ", ")));
    hwy::DisableTargets(*found - 1);
    forget_choice();
}

void limit_instruction_set_by_environment() {
    const char* name = std::getenv(instruction_set_variable);
    if (!name || *name == 0) return;
    try {
        limit_instruction_set(name);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {} {}", instruction_set_variable, name, error.what()));
    }
}

}  // namespace probewarp
