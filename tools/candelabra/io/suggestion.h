// SPDX-License-Identifier: Apache-2.0
// Finds what a user probably meant by a word that is not known.
#pragma once

#include <string>
#include <vector>

namespace candelabra::app
{

// Returns the known word that takes the fewest edits to make from `word`: a letter added, left out
// or replaced, or two neighbours exchanged. Returns an empty text if even that one takes more than
// one edit for every three letters, unless `word` is the beginning of one known word alone. Upper
// and lower case, and dashes in front, make no difference.
std::string closestWord(const std::string& word, const std::vector<std::string>& known);

// Returns "; did you mean WORD?" with the closest word, or an empty text if there is none.
std::string didYouMean(const std::string& word, const std::vector<std::string>& known);

} // namespace candelabra::app
