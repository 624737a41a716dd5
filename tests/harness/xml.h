// SPDX-License-Identifier: Apache-2.0
// Checks XML that the program wrote with an independent parser: Python's expat.
#pragma once

#include <cstdio>
#include <string>

#include "harness/paths.h"

namespace candelabra::test
{

// Returns what is wrong with the file; empty if it is well-formed, or if there is no Python
// (pythonWord).
inline std::string xmlFault(const std::string& path)
{
    if (pythonWord().empty())
        return "";
    const std::string command = pythonWord() +
                                " -c 'import sys, xml.dom.minidom as m\n"
                                "m.parse(sys.argv[1])' " +
                                shellWord(path) + " 2>&1";
    std::FILE* pipe = popen(command.c_str(), "r");
    if (!pipe)
        return "python3 did not start";
    std::string said;
    for (int c; (c = std::fgetc(pipe)) != EOF;)
        said += static_cast<char>(c);
    const int status = pclose(pipe);
    return status == 0 ? "" : path + ": " + said;
}

} // namespace candelabra::test
