// SPDX-License-Identifier: Apache-2.0
#include "harness/paths.h"

namespace candelabra::test
{

std::string sourcePath(const std::string& name)
{
    return CANDELABRA_SOURCE_FOLDER "/" + name;
}

std::string dataPath(const std::string& name)
{
    return sourcePath("tests/data/" + name);
}

std::string programWord()
{
    return shellWord(CANDELABRA_PROGRAM);
}

std::string pythonWord()
{
    return shellWord(CANDELABRA_PYTHON);
}

std::string shellWord(const std::string& text)
{
    std::string word = "'";
    for (const char c : text)
        word += c == '\'' ? "'\\''" : std::string(1, c);
    return word + "'";
}

} // namespace candelabra::test
