// SPDX-License-Identifier: Apache-2.0
// Runs the program's command line inside the test and returns its output and exit code.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli.h"

namespace candelabra::test
{

struct ProgramOutcome {
    int exitCode;
    std::string out, err;
};

inline ProgramOutcome runWith(std::vector<const char*> arguments)
{
    arguments.insert(arguments.begin(), "candelabra");
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int exitCode = app::runProgram(int(arguments.size()), arguments.data());
    std::fflush(stdout);
    return {exitCode, testing::internal::GetCapturedStdout(),
            testing::internal::GetCapturedStderr()};
}

} // namespace candelabra::test
