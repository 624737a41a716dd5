// SPDX-License-Identifier: Apache-2.0
// The parts of `candelabra bench`.
#pragma once

#include <string>

#include "commands/commands.h"

namespace candelabra::app
{

void addBenchAccuracy(CLI::App& bench, Run& run);
void addBenchCulling(CLI::App& bench, Run& run);
void addBenchSkip(CLI::App& bench, Run& run);
void addBenchStability(CLI::App& bench, Run& run);

// --out DIR and --json FILE (DIR/name).
void addBenchOutput(CLI::App& command, std::string& directory, std::string& json,
                    const std::string& name);
// Makes the directory; the path of a file that `typed` names, or `name` in the directory, checked
// to be writable.
std::string benchOutput(const std::string& directory, const std::string& option,
                        const std::string& typed, const std::string& name);

} // namespace candelabra::app
