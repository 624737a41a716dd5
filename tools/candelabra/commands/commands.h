// SPDX-License-Identifier: Apache-2.0
// The commands of the program. Each function adds a subcommand to `app`. If the user chooses it,
// `run` is set to the work to do, which returns the exit code and may throw.
#pragma once

#include <functional>
#include <memory>

#include <CLI/CLI.hpp>

#include "commands/options.h"

namespace candelabra::app
{

using Run = std::function<int(const ProgramContext&)>;

// Makes the arguments of a command, and sets `run` to work(program, arguments) if the user chooses
// the command.
template <typename Arguments>
std::shared_ptr<Arguments> argumentsOf(CLI::App& command, Run& run,
                                       int (*work)(const ProgramContext&, const Arguments&))
{
    const auto a = std::make_shared<Arguments>();
    command.callback([&run, a, work] {
        run = [a, work](const ProgramContext& program) { return work(program, *a); };
    });
    return a;
}

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

// The subcommands of `candelabra bench`.
void addBenchAccuracy(CLI::App& bench, Run& run);
void addBenchCulling(CLI::App& bench, Run& run);
void addBenchPipelines(CLI::App& bench, Run& run);
void addBenchSkip(CLI::App& bench, Run& run);
void addBenchStability(CLI::App& bench, Run& run);
void addBenchVisibility(CLI::App& bench, Run& run);

// Adds the options --out DIR and --json FILE, whose default is DIR/name.
void addBenchOutput(CLI::App& command, std::string& directory, std::string& json,
                    const std::string& name);
// Says on which device the benchmark `what` runs, and that it takes long.
void announceBench(const std::string& what, const VulkanContext& context);
// Creates the directory and returns the path of an output file: `typed` if it is not empty, else
// `name` in the directory. Throws UsageError if the file cannot be written.
std::string benchOutput(const std::string& directory, const std::string& option,
                        const std::string& typed, const std::string& name);

} // namespace candelabra::app
