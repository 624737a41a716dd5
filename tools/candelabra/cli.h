// SPDX-License-Identifier: Apache-2.0
// Parses the command line, runs the chosen command, and turns every error into one sentence on
// stderr and an exit code.
#pragma once

namespace candelabra::app
{

// Returns the exit code (io/error.h): 0 for success; 1 if something failed that should have worked,
// or if a check failed; 2 for arguments, files or an environment that the program cannot work with;
// 3 if `compare` found something slower.
int runProgram(int argc, const char* const* argv) noexcept;

} // namespace candelabra::app
