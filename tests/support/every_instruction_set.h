// Runs a check with each of the machine's instruction sets.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <cstdlib>
#include <vector>

#include "model/instruction_set.h"

namespace probewarp::testing {

/// Runs `check` with each instruction set that this machine has; where the environment limits them, with the
/// widest below that alone: such a run is one of several.
template <class Check>
void with_every_instruction_set(const Check& check) {
    std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
    if (const char* limit = std::getenv(instruction_set_variable); limit && *limit != 0) targets.resize(1);
    for (const std::int64_t target : targets) {
        SCOPED_TRACE(hwy::TargetName(target));
        hwy::SetSupportedTargetsForTest(target);
        check();
        hwy::SetSupportedTargetsForTest(0);
    }
}

}  // namespace probewarp::testing
