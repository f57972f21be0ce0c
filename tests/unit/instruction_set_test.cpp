// The limit on the instruction set: that it is heeded, and by which names.
#include "model/instruction_set.h"

#include <gmock/gmock.h>
#include <hwy/targets.h>

#include <cstdlib>
#include <set>

#include "model/deform_tiles.h"

namespace probewarp {
namespace {

/// Leaves the limit and the environment's variable as they were.
struct InstructionSet : ::testing::Test {
    const std::vector<std::string> all = instruction_sets();
    const char* const before = std::getenv(instruction_set_variable);
    const std::string value = before ? before : "";

    ~InstructionSet() override {
        limit_instruction_set(all.front());
        before ? ::setenv(instruction_set_variable, value.c_str(), 1) : ::unsetenv(instruction_set_variable);
    }
    std::string error_of(const char* name) {
        ::setenv(instruction_set_variable, name, 1);
        try {
            limit_instruction_set_by_environment();
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }
};

TEST_F(InstructionSet, EveryOneOfTheMachinesIsUsedWhereItIsTheLimit) {
    EXPECT_EQ(all.back(), "baseline");
    std::set<std::string> used;
    for (const std::string& name : all) {
        limit_instruction_set(name);
        EXPECT_EQ(instruction_sets().front(), name);
        used.insert(deform_target());
    }
    EXPECT_EQ(used.size(), all.size());
    EXPECT_STREQ(deform_target(), hwy::TargetName(HWY_STATIC_TARGET));
}

TEST_F(InstructionSet, TheNarrowerOnesStayAndALaterLimitReplacesAnEarlierOne) {
    for (std::size_t i = all.size(); i-- > 0;) {
        limit_instruction_set(all[i]);
        EXPECT_EQ(instruction_sets(), std::vector(all.begin() + std::ptrdiff_t(i), all.end()));
    }
}

TEST_F(InstructionSet, OneThatTheMachineLacksIsTheWidestBelowIt) {
    hwy::SetSupportedTargetsForTest(HWY_STATIC_TARGET);  // as if this machine had nothing else
    limit_instruction_set(all.front());
    EXPECT_EQ(instruction_sets(), std::vector<std::string>{"baseline"});
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_EQ(instruction_sets(), all);
}

TEST_F(InstructionSet, TheEnvironmentsNameIsHeededOrRefused) {
    EXPECT_EQ(error_of(""), "");
    EXPECT_EQ(instruction_sets(), all);
    EXPECT_EQ(error_of("baseline"), "");
    EXPECT_EQ(instruction_sets(), std::vector<std::string>{"baseline"});
    for (const char* wrong : {"avx9", "AVX2 ", "none", "0"})
        EXPECT_THAT(error_of(wrong),
                    ::testing::MatchesRegex("PROBEWARP_INSTRUCTION_SET: .* is no instruction set .*; "
                                            "expected one of .*baseline"));
    EXPECT_EQ(instruction_sets(), std::vector<std::string>{"baseline"}) << "what is refused changes nothing";
}

}  // namespace
}  // namespace probewarp
