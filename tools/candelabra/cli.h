// SPDX-License-Identifier: Apache-2.0
// The command line: parses, runs the chosen command, and turns every failure into one sentence on
// stderr and an exit code.
#pragma once

namespace candelabra::app
{

// 0: done; 1: something failed that should have worked, or a check failed; 2: arguments, files or
// an environment that cannot be worked with; 3: `compare` found something slower.
int runProgram(int argc, const char* const* argv) noexcept;

} // namespace candelabra::app
