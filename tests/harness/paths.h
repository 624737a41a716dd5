// SPDX-License-Identifier: Apache-2.0
// Paths of files that tests use. They are compiled into one small library and nowhere else, so that
// a compiler cache (ccache) serves the tests to clones in other folders. The environment variables
// CANDELABRA_TEST_SOURCE (folder), CANDELABRA_TEST_PROGRAM and CANDELABRA_TEST_PYTHON (files) name
// other places, for tests that were copied to another machine (tools/gpu_check).
#pragma once

#include <string>

namespace candelabra::test
{

// Returns the path of a file or folder of the repository, such as "tools/bench/results".
std::string sourcePath(const std::string& name);
// Returns the path of a file in tests/data.
std::string dataPath(const std::string& name);
// Returns the path of the candelabra program that was built with the tests, quoted as one word of a
// shell command.
std::string programWord();
// Returns the path of the Python interpreter of the build, quoted likewise. Empty if
// CANDELABRA_TEST_PYTHON is, because a machine lacks Python: then the XML that the program writes
// is not parsed.
std::string pythonWord();
// Returns any text quoted as one word of a shell command.
std::string shellWord(const std::string& text);

} // namespace candelabra::test
