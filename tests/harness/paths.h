// SPDX-License-Identifier: Apache-2.0
// Where the tests find files. The paths are compiled into one small library and nowhere else, so
// that a compiler cache (ccache) serves the tests to clones in other folders.
#pragma once

#include <string>

namespace candelabra::test
{

// A file or folder of the repository: "tools/candelabra/schemas".
std::string sourcePath(const std::string& name);
// A file of tests/data.
std::string dataPath(const std::string& name);
// The candelabra program that was built together with the tests, as one word of a shell's command.
std::string programWord();
// Any text as one word of a shell's command.
std::string shellWord(const std::string& text);

} // namespace candelabra::test
