// SPDX-License-Identifier: Apache-2.0
#include "harness/paths.h"

#include <cstdlib>

namespace candelabra::test
{
namespace
{

std::string valueOf(const char* variable, const char* otherwise)
{
    const char* value = std::getenv(variable);
    return value ? value : otherwise;
}

} // namespace

std::string sourcePath(const std::string& name)
{
    return valueOf("CANDELABRA_TEST_SOURCE", CANDELABRA_SOURCE_FOLDER) + "/" + name;
}

std::string dataPath(const std::string& name)
{
    return sourcePath("tests/data/" + name);
}

std::string programWord()
{
    return shellWord(valueOf("CANDELABRA_TEST_PROGRAM", CANDELABRA_PROGRAM));
}

std::string pythonWord()
{
    const std::string python = valueOf("CANDELABRA_TEST_PYTHON", CANDELABRA_PYTHON);
    return python.empty() ? "" : shellWord(python);
}

std::string shellWord(const std::string& text)
{
    std::string word = "'";
    for (const char c : text)
        word += c == '\'' ? "'\\''" : std::string(1, c);
    return word + "'";
}

} // namespace candelabra::test
