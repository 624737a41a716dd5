// SPDX-License-Identifier: Apache-2.0
#include "io/report.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "io/error.h"
#include "io/image_file.h"

namespace candelabra::app
{
namespace
{

std::string directoryOf(const std::string& path)
{
    const std::filesystem::path parent = std::filesystem::path(path).parent_path();
    return parent.empty() ? "." : parent.string();
}

std::string quoted(const std::string& argument)
{
    constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                  "-_=+,./:@%";
    if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos)
        return argument;
    std::string out = "'";
    for (const char c : argument) {
        if (c == '\'')
            out += "'\\''";
        else
            out += c;
    }
    out += "'";
    return out;
}

} // namespace

void writeText(const std::string& path, const std::string& text)
{
    if (path == "-") {
        if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout))
            throw RunError(std::string("cannot write to standard output: ") + std::strerror(errno));
        return;
    }
    try {
        writeFileAtomically(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    } catch (const ImageError& error) {
        throw RunError(error.what());
    }
}

void writeJson(const std::string& path, const Json& json)
{
    writeText(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void requireWritable(const std::string& option, const std::string& path)
{
    if (path == "-")
        return;
    std::error_code error;
    // Devices are refused too, because the temporary file that is renamed would replace the device.
    if (path.empty() ||
        (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)))
        throw UsageError(fmt::format("{} \"{}\": is not the name of a file", option, path));
    const std::string directory = directoryOf(path);
    if (!std::filesystem::is_directory(directory, error))
        throw UsageError(fmt::format("{} {}: there is no directory {}", option, path, directory));
    // The temporary name is longer than the final one and must be allowed too.
    const size_t length = temporaryName(std::filesystem::path(path).filename().string()).size();
    if (const long most = pathconf(directory.c_str(), _PC_NAME_MAX);
        most > 0 && length > size_t(most))
        throw UsageError(fmt::format("{} {}: the name is too long", option, path));
    // Permissions alone do not tell: for root every folder looks writable, even those of /proc.
    if (const std::string refusal = writeRefusal(path); !refusal.empty())
        throw UsageError(
            fmt::format("{} {}: cannot write into {}: {}", option, path, directory, refusal));
}

void requireOther(const std::string& option, const std::string& output, const std::string& input)
{
    std::error_code missing; // a file that does not exist is not the same
    if (std::filesystem::equivalent(output, input, missing))
        throw UsageError(
            fmt::format("{} {}: would replace {}, which is read", option, output, input));
}

std::string commandLine(int argc, const char* const* argv, const std::string& program)
{
    std::string out = program;
    for (int i = 1; i < argc; ++i)
        out.append(" ").append(quoted(argv[i]));
    return out;
}

} // namespace candelabra::app
