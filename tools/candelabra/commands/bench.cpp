// SPDX-License-Identifier: Apache-2.0
// candelabra bench: measures what lighting costs and how exact it is.
#include <filesystem>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "io/error.h"
#include "io/report.h"

namespace candelabra::app
{

void addBenchOutput(CLI::App& command, std::string& directory, std::string& json,
                    const std::string& name)
{
    addOption(command, "--out", directory, "DIR",
              "directory for all output; it is created if it does not exist");
    addOption(command, "--json", json, "FILE",
              fmt::format("JSON file with all figures (DIR/{}); - is standard output", name));
}

void announceBench(const std::string& what, const VulkanContext& context)
{
    spdlog::info("{} on {}; the default options take minutes", what, context.info().name);
}

std::string benchOutput(const std::string& directory, const std::string& option,
                        const std::string& typed, const std::string& name)
{
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (!std::filesystem::is_directory(directory))
        throw UsageError("--out " + directory + ": cannot create this directory: " +
                         (error ? error.message() : "there is a file with this name"));
    const std::string path =
        typed.empty() ? (std::filesystem::path(directory) / name).string() : typed;
    requireWritable(option, path);
    return path;
}

void addBenchCommand(CLI::App& app, Run& run)
{
    CLI::App* bench =
        app.add_subcommand("bench", "Measure accuracy, stability, culling, shadows, skips "
                                    "and compiled code");
    bench->require_subcommand(1);
    bench->footer(
        "Examples:\n"
        "  candelabra bench culling --lights 4000   time and lists against other methods\n"
        "  candelabra bench accuracy --groups 100   errors against the truth, in a shorter "
        "run\n"
        "  candelabra bench culling --help          the options of one benchmark");
    addBenchAccuracy(*bench, run);
    addBenchCulling(*bench, run);
    addBenchPipelines(*bench, run);
    addBenchSkip(*bench, run);
    addBenchStability(*bench, run);
    addBenchVisibility(*bench, run);
}

} // namespace candelabra::app
