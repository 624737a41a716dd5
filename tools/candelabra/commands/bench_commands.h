// SPDX-License-Identifier: Apache-2.0
// The subcommands of `candelabra bench`.
#pragma once

#include <string>

#include "commands/commands.h"

namespace candelabra::app
{

void addBenchAccuracy(CLI::App& bench, Run& run);
void addBenchCulling(CLI::App& bench, Run& run);
void addBenchPipelines(CLI::App& bench, Run& run);
void addBenchSkip(CLI::App& bench, Run& run);
void addBenchStability(CLI::App& bench, Run& run);
void addBenchVisibility(CLI::App& bench, Run& run);

// Adds the options --out DIR and --json FILE, whose default is DIR/name.
void addBenchOutput(CLI::App& command, std::string& directory, std::string& json,
                    const std::string& name);
// Creates the directory and returns the path of an output file: `typed` if it is not empty, else
// `name` in the directory. Throws UsageError if the file cannot be written.
std::string benchOutput(const std::string& directory, const std::string& option,
                        const std::string& typed, const std::string& name);

} // namespace candelabra::app
