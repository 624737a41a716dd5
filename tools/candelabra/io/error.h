// SPDX-License-Identifier: Apache-2.0
// The program's errors. what() is one sentence for the user; the type of the error decides the exit
// code.
#pragma once

#include <stdexcept>

namespace candelabra::app
{

constexpr int exitOk = 0;
constexpr int exitFailed = 1;     // something that should have worked did not, or a check failed
constexpr int exitUsage = 2;      // arguments, files or an environment the program cannot work with
constexpr int exitBeyond = 3;     // candelabra diff: different; candelabra compare: slower
constexpr int exitCannotTell = 4; // candelabra compare: neither slower nor not slower

// The arguments cannot be used. The program ends with exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// A call or a check failed. The program ends with exit code 1.
struct RunError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace candelabra::app
