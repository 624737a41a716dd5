// SPDX-License-Identifier: Apache-2.0
// Names of files with a place for a number: f.%04d.png stands for f.0000.png, f.0001.png, ...
#pragma once

#include <cstdint>
#include <string>

namespace candelabra::app
{

// Returns true if `name` has a place for a number: %d, %0Nd for at least N digits, or %Nd, which
// numberedName() refuses, because C's printf() would fill it up with spaces.
bool isNumbered(const std::string& name);

// Returns the name with the number in its place. Throws UsageError, which names `option`, if the
// name has several such places, or none, or one that is neither %d nor %0Nd with N up to 99.
std::string numberedName(const std::string& option, const std::string& name, uint32_t number);

} // namespace candelabra::app
