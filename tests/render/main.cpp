// Runs the tests with the instruction set that the environment asks for, as the program does.
#include <gtest/gtest.h>

#include "model/instruction_set.h"

int main(int argc, char** argv) {
    probewarp::limit_instruction_set_by_environment();
    ::testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
