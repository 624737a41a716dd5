// SPDX-License-Identifier: Apache-2.0
// The technical terms of the report, each explained in a sentence.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace candelabra::app
{

struct Term {
    std::string name;
    std::vector<std::string> words; // how the term is written; other cases are other words
    std::string meaning;            // a sentence
};

// In alphabetical order.
const std::vector<Term>& glossary();

// Finds which terms a page uses, and where it does so first.
class TermFinder
{
public:
    // Returns the terms that `text` has and that no earlier text had.
    std::vector<Term> firstIn(const std::string& text);
    // All that have been found, in alphabetical order.
    std::vector<Term> all() const;

private:
    std::set<std::string> found_; // their names
};

} // namespace candelabra::app
