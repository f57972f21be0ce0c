// Runs the unit tests with a seed that is the same every time, and says which, so that a failure comes back.
// Another one may be given: RC_PARAMS="seed=7" unit_tests.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "model/instruction_set.h"

int main(int argc, char** argv) {
    ::setenv("RC_PARAMS", "seed=20160107", 0);  // before anything asks rapidcheck for a value
    probewarp::limit_instruction_set_by_environment();
    ::testing::InitGoogleTest(&argc, argv);
    // On stderr: stdout is read by CTest when it asks for the list of tests.
    std::fprintf(stderr, "RC_PARAMS=\"%s\"\n", std::getenv("RC_PARAMS"));
    return RUN_ALL_TESTS();
}
