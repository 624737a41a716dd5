// SPDX-License-Identifier: Apache-2.0
#include "cli.h"

#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "io/error.h"
#include "io/report.h"
#include "render/check.h"
#include "scene/scene_error.h"

namespace candelabra::app
{
namespace
{

int complain(int exitCode, const std::string& sentence) noexcept
{
    std::fprintf(stderr, "candelabra: %s\n", sentence.c_str());
    return exitCode;
}

void setUpLogging(bool quiet)
{
    static const auto logger = spdlog::stderr_logger_mt("candelabra");
    logger->set_pattern("%v");
    logger->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
    spdlog::set_default_logger(logger);
}

void describe(CLI::App& app, ProgramContext& context)
{
    app.require_subcommand(1);
    app.fallthrough(); // --quiet may stand after the command, too
    app.add_flag("-q,--quiet", context.quiet,
                 "print only warnings and errors on stderr, no progress and no remarks");
    const uint32_t version = cndGetVersion();
    app.set_version_flag("--version", fmt::format("candelabra {}.{}.{}", version >> 22,
                                                  (version >> 12) & 0x3ff, version & 0xfff));
    app.footer(
        "SCENE is hall, field or fence, which are generated with --lights N, --seed S and\n"
        "--overlaps K; showcase, which has one light of every type; or a file: glTF 2.0 (.gltf,\n"
        ".glb) or a scene description (.json).\n\n"
        "Examples:\n"
        "  candelabra stress                        measure growing numbers of lights, into out/\n"
        "  candelabra render hall --lights 16000 -o hall.png\n"
        "  candelabra profile hall --lights 4000    time every pass of a frame\n"
        "  candelabra view hall --lights 4000       fly through the hall\n"
        "  candelabra render --help                 list the options of one command");
}

// Returns the error message for a command or subcommand that does not exist, or an empty text if
// all do.
std::string unknownCommand(const CLI::App& root, int argc, const char* const* argv)
{
    const CLI::App* app = &root;
    for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
        const auto all = app->get_subcommands([](const CLI::App*) { return true; });
        if (all.empty())
            return "";
        std::string names;
        const CLI::App* chosen = nullptr;
        for (size_t k = 0; k < all.size(); ++k) {
            names += (!k ? "" : k + 1 < all.size() ? ", " : " and ") + all[k]->get_name();
            if (all[k]->get_name() == argv[i])
                chosen = all[k];
        }
        if (!chosen)
            return fmt::format("\"{}\" is no command{}; choose from {}", argv[i],
                               app == &root ? "" : " of " + app->get_name(), names);
        app = chosen;
    }
    return "";
}

// Returns the error message for a command line that cannot be parsed.
std::string parseSentence(const CLI::App& app, int argc, const char* const* argv,
                          const CLI::ParseError& error)
{
    if (const std::string unknown = unknownCommand(app, argc, argv); !unknown.empty())
        return unknown;
    const std::string first = argc > 1 ? argv[1] : "-";
    return fmt::format("{} (see: candelabra {}--help)", error.what(),
                       first[0] == '-' ? "" : first + " ");
}

// Refuses "--option=" and empty values. With "--camera= -o x.png" the parser would take "-o" for
// the camera, and some options take an empty text for "not given".
void refuseAssignmentsOfNothing(int argc, const char* const* argv)
{
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--")
            return;
        if (argument.size() > 3 && argument.starts_with("--") &&
            argument.find('=') == argument.size() - 1)
            throw UsageError(argument + ": its value is missing");
    }
}

void refuseEmptyValues(const CLI::App& app)
{
    for (const CLI::App* command : app.get_subcommands())
        for (const CLI::Option* option : command->get_options())
            for (const std::string& value : option->results())
                // One of the two texts of --ab may be empty: that variant changes no option.
                if (value.empty() && option->get_items_expected_min() < 2)
                    throw UsageError(option->get_name() + ": its value is empty");
}

int parseAndRun(int argc, const char* const* argv)
{
    ProgramContext context{.commandLine = commandLine(argc, argv)};
    CLI::App app("Lights scenes with thousands of physically sized sphere lights.", "candelabra");
    Run run;
    describe(app, context);
    addRenderCommand(app, run);
    addStressCommand(app, run);
    addProfileCommand(app, run);
    addCompareCommand(app, run);
    addReportCommand(app, run);
    addViewCommand(app, run);
    addTruthCommand(app, run);
    addBenchCommand(app, run);
    addDevicesCommand(app, run);
    addManualCommands(app, run);
    refuseAssignmentsOfNothing(argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) { // --help, --version
        std::ostringstream text;
        app.exit(help, text);
        writeText("-", text.str());
        return exitOk;
    } catch (const CLI::ParseError& error) {
        return complain(exitUsage, parseSentence(app, argc, argv, error));
    }
    refuseEmptyValues(app);
    setUpLogging(context.quiet);
    return run(context);
}

} // namespace

int runProgram(int argc, const char* const* argv) noexcept
{
    try {
        return parseAndRun(argc, argv);
    } catch (const SceneError& error) {
        return complain(exitUsage, error.what());
    } catch (const UsageError& error) {
        return complain(exitUsage, error.what());
    } catch (const gpu::Failure& failure) {
        return complain(exitFailed, failure.message);
    } catch (const std::bad_alloc&) {
        return complain(exitFailed, "out of memory");
    } catch (const std::exception& error) {
        return complain(exitFailed, error.what());
    }
}

} // namespace candelabra::app
