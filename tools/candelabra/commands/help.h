// SPDX-License-Identifier: Apache-2.0
// The text of --help: options in groups, wrapped to the width of the terminal. The help of a
// command only names the options that several commands share. `candelabra options` explains them.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace candelabra::app
{

// The groups of options that several commands share.
constexpr const char* sceneGroup = "Scene";
constexpr const char* pictureGroup = "Picture";
constexpr const char* lightingGroup = "Lighting";
constexpr const char* drawingGroup = "Drawing";
constexpr const char* deviceGroup = "Device";

// Puts the options that are added to `command` during the life of this object into a group.
class OptionGroup
{
public:
    OptionGroup(CLI::App& command, const char* name);
    OptionGroup(const OptionGroup&) = delete;
    OptionGroup& operator=(const OptionGroup&) = delete;
    ~OptionGroup();

private:
    CLI::App& command_;
    std::string before_;
};

// Adds the command `options`, which runs nothing: cli.cpp prints its help.
void addOptionsCommand(CLI::App& app);
constexpr const char* optionsCommand = "options";

enum class SharedOptions { Named, Explained };

class HelpFormatter : public CLI::Formatter
{
public:
    // `width` is the width of a line in characters.
    HelpFormatter(size_t width, SharedOptions shared);

    std::string make_help(const CLI::App* app, std::string name,
                          CLI::AppFormatMode mode) const override;
    std::string make_option(const CLI::Option* option, bool isPositional) const override;
    std::string make_subcommand(const CLI::App* command) const override;

private:
    std::string row(const std::string& name, const std::vector<std::string>& parts) const;
    std::string options(const CLI::App& app) const;

    size_t width_;
    SharedOptions shared_;
};

// Returns the width of the terminal in characters, at least 60 and at most 120, or 80 if neither
// stdout nor stderr is a terminal.
size_t terminalWidth();

} // namespace candelabra::app
