// SPDX-License-Identifier: Apache-2.0
// The commands of the program. Each function adds a subcommand to `app`. If the user chooses it,
// `run` is set to the work to do, which returns the exit code and may throw.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "commands/options.h"

namespace candelabra::app
{

using Run = std::function<int(const ProgramContext&)>;

void addBenchCommand(CLI::App& app, Run& run);
void addCompareCommand(CLI::App& app, Run& run);
void addDevicesCommand(CLI::App& app, Run& run);
void addDiffCommand(CLI::App& app, Run& run);
void addExamplesCommand(CLI::App& app, Run& run);
void addProfileCommand(CLI::App& app, Run& run);
void addRenderCommand(CLI::App& app, Run& run);
void addReportCommand(CLI::App& app, Run& run);
void addStressCommand(CLI::App& app, Run& run);
void addTruthCommand(CLI::App& app, Run& run);
void addViewCommand(CLI::App& app, Run& run);

} // namespace candelabra::app
