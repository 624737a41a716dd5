// SPDX-License-Identifier: Apache-2.0
// Names of files with a place for a number: f.%04d.png stands for f.0000.png, f.0001.png, ...
#pragma once

#include <cstdint>
#include <string>

namespace candelabra::app
{

// Returns true if `name` has a place for a number: %d, or %0Nd for at least N digits.
bool isNumbered(const std::string& name);

// Returns the name with the number in its place. Throws UsageError, which names `option`, if the
// name has several such places, or none.
std::string numberedName(const std::string& option, const std::string& name, uint32_t number);

// Returns the same name with `word` in place of the number.
std::string namedInstead(const std::string& name, const std::string& word);

} // namespace candelabra::app
