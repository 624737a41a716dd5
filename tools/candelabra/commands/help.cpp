// SPDX-License-Identifier: Apache-2.0
#include "commands/help.h"

#include <algorithm>
#include <array>
#include <memory>
#include <sstream>
#include <string_view>

#include <sys/ioctl.h>
#include <unistd.h>

#include "commands/options.h"

namespace candelabra::app
{
namespace
{

constexpr size_t nameWidth = 28; // of the column of names

constexpr std::array<std::string_view, 5> sharedGroups{sceneGroup, pictureGroup, lightingGroup,
                                                       drawingGroup, deviceGroup};

std::vector<const CLI::Option*> optionsOf(const CLI::App& app, std::string_view group)
{
    return app.get_options([&](const CLI::Option* option) {
        return option->get_group() == group && option->nonpositional();
    });
}

// Returns `parts` in lines of at most `width` characters, with spaces between them. All lines but
// the first are indented by `indent` characters, which are part of their width.
std::string wrapped(const std::vector<std::string>& parts, size_t indent, size_t width)
{
    std::string out;
    size_t column = indent;
    for (const std::string& part : parts) {
        if (column > indent && column + 1 + part.size() > width) {
            out += "\n" + std::string(indent, ' ');
            column = indent;
        } else if (column > indent) {
            out += " ";
            ++column;
        }
        out += part;
        column += part.size();
    }
    return out;
}

std::vector<std::string> wordsOf(const std::string& text)
{
    std::istringstream in(text);
    std::vector<std::string> out;
    for (std::string word; in >> word;)
        out.push_back(word);
    return out;
}

} // namespace

size_t terminalWidth()
{
    for (const int file : {STDOUT_FILENO, STDERR_FILENO})
        if (winsize size{}; ioctl(file, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
            return std::clamp<size_t>(size.ws_col, 60, 120);
    return 80;
}

OptionGroup::OptionGroup(CLI::App& command, const char* name)
    : command_(command), before_(command.option_defaults()->get_group())
{
    command_.option_defaults()->group(name);
}

OptionGroup::~OptionGroup()
{
    command_.option_defaults()->group(before_);
}

void addOptionsCommand(CLI::App& app)
{
    struct Arguments {
        SceneArguments scene;
        FrameArguments frame;
        DeviceArguments device;
    };
    CLI::App* command =
        app.add_subcommand(optionsCommand, "Explain the options that several commands share");
    const auto a = std::make_shared<Arguments>();
    a->scene.addOptionsTo(*command);
    a->scene.addLightsTo(*command);
    a->scene.addDefaultLightTo(*command);
    a->frame.addAllTo(*command, Reuse::None);
    a->device.addTo(*command);
    command->callback([a] {}); // keeps the texts of the options alive
    command->formatter(std::make_shared<HelpFormatter>(terminalWidth(), SharedOptions::Explained));
    command->footer("The help of a command says which of these it has, and its own defaults.\n\n"
                    "Examples:\n"
                    "  candelabra help options\n"
                    "  candelabra help render");
}

HelpFormatter::HelpFormatter(size_t width, SharedOptions shared) : width_(width), shared_(shared) {}

// Returns a name, and beside it the parts of its explanation.
std::string HelpFormatter::row(const std::string& name, const std::vector<std::string>& parts) const
{
    const std::string left = "  " + name;
    const bool fits = left.size() + 2 <= nameWidth;
    return left + (fits ? "" : "\n") + std::string(nameWidth - (fits ? left.size() : 0), ' ') +
           wrapped(parts, nameWidth, width_) + "\n";
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool isPositional) const
{
    return row(make_option_name(option, isPositional) + make_option_opts(option),
               wordsOf(option->get_description()));
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const
{
    return row(command->get_name(), wordsOf(command->get_description()));
}

std::string HelpFormatter::options(const CLI::App& app) const
{
    std::string explained, named;
    for (const std::string& group : app.get_groups())
        if (std::ranges::find(sharedGroups, group) == sharedGroups.end())
            if (const auto own = optionsOf(app, group); !own.empty())
                explained += make_group(group, false, own);
    for (const std::string_view group : sharedGroups) {
        const auto shared = optionsOf(app, group);
        if (shared.empty())
            continue;
        if (shared_ == SharedOptions::Explained) {
            explained += make_group(std::string(group), false, shared);
            continue;
        }
        std::vector<std::string> names;
        for (const CLI::Option* option : shared)
            names.push_back(make_option_name(option, false) + make_option_opts(option) +
                            (option == shared.back() ? "" : ","));
        named += row(std::string(group), names);
    }
    if (!named.empty())
        named = "\nShared options, explained by `candelabra help options`:\n" + named;
    return explained + named;
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const
{
    return wrapped(wordsOf(app->get_description()), 0, width_) + "\n\n" + make_usage(app, name) +
           make_positionals(app) + options(*app) + make_subcommands(app, mode) + "\n" +
           make_footer(app);
}

} // namespace candelabra::app
