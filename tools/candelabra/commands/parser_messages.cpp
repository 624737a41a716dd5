// SPDX-License-Identifier: Apache-2.0
#include "commands/options.h"

#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "io/table.h"

namespace candelabra::app
{
namespace
{

// Returns text between the end of `start` and `end`, or an empty text if `said` has not this form.
std::string between(const std::string& said, const std::string& start, std::string_view end)
{
    if (!said.starts_with(start) || !said.ends_with(end) || said.size() < start.size() + end.size())
        return "";
    return said.substr(start.size(), said.size() - start.size() - end.size());
}

// Names the arguments that nothing takes: "4" and "5" are not expected here.
std::string extrasSentence(const CLI::App& app)
{
    std::vector<std::string> extras = app.remaining(true);
    for (std::string& extra : extras)
        extra = '"' + extra + '"';
    return listed(extras) + (extras.size() == 1 ? " is" : " are") + " not expected here";
}

} // namespace

std::string parserSentence(const CLI::App& app, const CLI::ParseError& error)
{
    const std::string said = error.what();
    if (dynamic_cast<const CLI::ExtrasError*>(&error))
        return extrasSentence(app);
    if (const std::string positional = between(said, "", " is required"); !positional.empty())
        return "no " + positional + " is given";
    if (const std::string flag = between(said, "Could not convert: ", ""); !flag.empty())
        return flag.substr(0, flag.find(' ')) + ": takes no value";
    const std::string option = said.substr(0, said.find(':'));
    if (const auto count = between(said, option + ": At Most 1 required but received ", "");
        !count.empty())
        return fmt::format("{}: is given {} times, but may be given once", option, count);
    if (const std::string count = between(said, option + ": ", " missing"); !count.empty()) {
        const std::string values = count.substr(0, count.find(' '));
        return option +
               (values == "1" ? ": its value is missing" : ": needs " + values + " values");
    }
    return said;
}

} // namespace candelabra::app
