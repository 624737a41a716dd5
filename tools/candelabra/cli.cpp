// SPDX-License-Identifier: Apache-2.0
#include "cli.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "commands/commands.h"
#include "commands/help.h"
#include "io/error.h"
#include "io/report.h"
#include "io/suggestion.h"
#include "io/table.h"
#include "scene/scene_error.h"

namespace candelabra::app
{
namespace
{

int printError(int exitCode, const std::string& sentence) noexcept
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

void addProgramOptions(CLI::App& app, ProgramContext& context)
{
    app.require_subcommand(1);
    app.fallthrough(); // --quiet may also follow the command
    app.add_flag("-q,--quiet", context.quiet,
                 "print only warnings and errors on stderr, without progress and remarks");
    const uint32_t version = cndGetVersion();
    app.set_version_flag("--version", fmt::format("candelabra {}.{}.{}", version >> 22,
                                                  (version >> 12) & 0x3ff, version & 0xfff));
    app.footer(
        "SCENE is hall, field, fence or rooms, generated with --lights N, --seed S and\n"
        "--overlaps K; showcase, which has one light of every type; or a file, glTF 2.0\n"
        "(.gltf, .glb) or a scene description (.json).\n\n"
        "Examples:\n"
        "  candelabra stress                        measure growing numbers of lights, into out/\n"
        "  candelabra render hall --lights 16000 -o hall.png\n"
        "  candelabra profile hall --lights 4000    time every pass of a frame\n"
        "  candelabra view hall --lights 4000       fly through the hall\n"
        "  candelabra help render                   list the options of one command\n"
        "  candelabra examples                      write small example files here\n\n"
        "Exit codes: 0 done; 1 failed; 2 arguments or files that cannot be used; 3 different\n"
        "(diff) or slower (compare); 4 compare cannot tell.\n\n"
        "Pages about scenes, many machines, the lighting model and embedding are installed in\n"
        "share/doc/candelabra.");
}

std::vector<const CLI::App*> partsOf(const CLI::App& app)
{
    return app.get_subcommands([](const CLI::App*) { return true; });
}

// The commands at the beginning of a command line.
struct Named {
    std::vector<const CLI::App*> path; // the program, then its command, and that command's part
    const char* unknown = nullptr;     // the word after them, if it should be a command but is none
};

Named namedCommands(const CLI::App& root, int argc, const char* const* argv)
{
    Named out{.path = {&root}};
    for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
        const auto parts = partsOf(*out.path.back());
        if (parts.empty())
            break;
        const auto found = std::ranges::find(parts, argv[i], &CLI::App::get_name);
        if (found == parts.end()) {
            out.unknown = argv[i];
            break;
        }
        out.path.push_back(*found);
    }
    return out;
}

// Returns " (see: candelabra help ...)".
std::string seeHelp(const Named& named)
{
    std::string words;
    for (size_t i = 1; i < named.path.size(); ++i)
        words += " " + named.path[i]->get_name();
    return " (see: candelabra help" + words + ")";
}

// Returns the error message for a command that does not exist or is missing, or an empty text if
// the command is there.
std::string commandSentence(const Named& named, const CLI::ParseError& error)
{
    const CLI::App& last = *named.path.back();
    const auto parts = partsOf(last);
    const bool missing = dynamic_cast<const CLI::RequiredError*>(&error) && !parts.empty();
    if (!named.unknown && !missing)
        return "";
    std::vector<std::string> names;
    for (const CLI::App* part : parts)
        names.push_back(part->get_name());
    const std::string list = listed(names);
    const std::string of = named.path.size() == 1 ? "" : " of " + last.get_name();
    if (!named.unknown)
        return fmt::format("no command{} is given; choose from {}{}", of, list, seeHelp(named));
    const std::string closest = didYouMean(named.unknown, names);
    return fmt::format("\"{}\" is no command{}{}", named.unknown, of,
                       closest.empty() ? "; choose from " + list : closest);
}

bool hasOption(const CLI::App& app, const std::string& name)
{
    return app.get_option_no_throw(name) != nullptr;
}

// Returns the error message for an option that does not exist, or an empty text if the error is
// another one.
std::string optionSentence(const Named& named, int argc, const char* const* argv,
                           const CLI::ParseError& error)
{
    if (!dynamic_cast<const CLI::ExtrasError*>(&error))
        return "";
    const std::string said = error.what();
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i], option = argument.substr(0, argument.find('='));
        const auto has = [&](const CLI::App* app) { return hasOption(*app, option); };
        if (option.size() < 2 || option[0] != '-' || said.find(option) == std::string::npos ||
            std::ranges::any_of(named.path, has))
            continue;
        std::vector<std::string> known;
        for (const CLI::App* app : named.path)
            for (const CLI::Option* one : app->get_options())
                for (const std::string& name : one->get_lnames())
                    known.push_back("--" + name);
        const std::string command =
            named.path.size() == 1 ? "candelabra" : named.path.back()->get_name();
        return fmt::format("{}: {} has no such option{}{}", option, command,
                           didYouMean(option, known), seeHelp(named));
    }
    return "";
}

// Returns the error message for a command line that cannot be parsed.
std::string parseSentence(const CLI::App& app, int argc, const char* const* argv,
                          const CLI::ParseError& error)
{
    const Named named = namedCommands(app, argc, argv);
    if (const std::string command = commandSentence(named, error); !command.empty())
        return command;
    if (const std::string option = optionSentence(named, argc, argv, error); !option.empty())
        return option;
    return parserSentence(app, error) + seeHelp(named);
}

// Refuses "--option=", and values of options that take none: with "--camera= -o x.png" the parser
// would take "-o" for the camera, and with "--explain=no" it would ignore the value.
void refuseWrongAssignments(const CLI::App& app, int argc, const char* const* argv)
{
    const Named named = namedCommands(app, argc, argv);
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--")
            return;
        if (const size_t equals = argument.find('='); equals != std::string::npos)
            for (const CLI::App* command : named.path)
                if (const CLI::Option* option =
                        command->get_option_no_throw(argument.substr(0, equals));
                    option && option->get_items_expected_max() == 0)
                    throw UsageError(argument.substr(0, equals) + ": takes no value");
        if (argument.size() > 3 && argument.starts_with("--") &&
            argument.find('=') == argument.size() - 1)
            throw UsageError(argument + ": its value is missing");
    }
}

// Refuses empty values, because some options take an empty text for "not given".
void refuseEmptyValues(const CLI::App& app)
{
    for (const CLI::App* command : app.get_subcommands())
        for (const CLI::Option* option : command->get_options())
            for (const std::string& value : option->results())
                // One of the two texts of --ab may be empty: that variant changes no option.
                if (value.empty() && option->get_items_expected_min() < 2)
                    throw UsageError(option->get_name() + ": its value is empty");
}

// The program reads "help WORDS" as "WORDS --help", so this command is never run. It is listed with
// the others.
void addHelpCommand(CLI::App& app)
{
    CLI::App* help = app.add_subcommand("help", "Print the help of the program or of a command");
    help->add_option("command")->description("the command, such as render or bench culling");
    help->footer("Examples:\n"
                 "  candelabra help\n"
                 "  candelabra help options\n"
                 "  candelabra help bench culling");
}

// Returns the arguments with "help WORDS" replaced by "WORDS --help", so that both print the same
// and refuse the same, and "options" by "options --help".
std::vector<const char*> withHelpAsOption(int argc, const char* const* argv)
{
    std::vector<const char*> out(argv, argv + argc);
    const auto first = std::find_if(out.begin() + std::min(argc, 1), out.end(),
                                    [](const char* argument) { return argument[0] != '-'; });
    if (first == out.end())
        return out;
    const bool isHelp = std::string(*first) == "help";
    if (!isHelp && std::string(*first) != optionsCommand)
        return out;
    if (isHelp)
        out.erase(first);
    out.push_back("--help");
    return out;
}

int parseAndRun(int typedCount, const char* const* typed)
{
    const std::vector<const char*> arguments = withHelpAsOption(typedCount, typed);
    const int argc = int(arguments.size());
    const char* const* argv = arguments.data();
    ProgramContext context{.commandLine = commandLine(argc, argv)};
    CLI::App app("Candelabra lights a scene with thousands of physically sized lights: spheres, "
                 "tubes, rectangles, discs, polygons, suns, spots and points, in photometric units "
                 "(lm, cd, lx, cd/m^2).",
                 "candelabra");
    app.formatter(std::make_shared<HelpFormatter>(terminalWidth(), SharedOptions::Named));
    Run run;
    addProgramOptions(app, context);
    addRenderCommand(app, run);
    addStressCommand(app, run);
    addProfileCommand(app, run);
    addCompareCommand(app, run);
    addDiffCommand(app, run);
    addReportCommand(app, run);
    addViewCommand(app, run);
    addTruthCommand(app, run);
    addBenchCommand(app, run);
    addDevicesCommand(app, run);
    addExamplesCommand(app, run);
    addOptionsCommand(app);
    addHelpCommand(app);
    refuseWrongAssignments(app, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) { // --help, --version
        if (const Named named = namedCommands(app, argc, argv); named.unknown)
            return printError(exitUsage, commandSentence(named, help));
        std::ostringstream text;
        app.exit(help, text);
        writeText("-", text.str());
        return exitOk;
    } catch (const CLI::ParseError& error) {
        return printError(exitUsage, parseSentence(app, argc, argv, error));
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
        return printError(exitUsage, error.what());
    } catch (const UsageError& error) {
        return printError(exitUsage, error.what());
    } catch (const gpu::Failure& failure) {
        return printError(exitFailed, failure.message);
    } catch (const std::bad_alloc&) {
        return printError(exitFailed, "out of memory");
    } catch (const std::exception& error) {
        return printError(exitFailed, error.what());
    }
}

} // namespace candelabra::app
