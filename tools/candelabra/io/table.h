// SPDX-License-Identifier: Apache-2.0
// Table: aligned columns for the terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace candelabra::app
{

class Table
{
public:
    explicit Table(std::vector<std::string> header);
    // As many cells as the header has.
    void add(std::vector<std::string> cells);
    // A line across before the next row.
    void rule();
    // Lines that end in a newline: first column to the left, the others to the right.
    std::string text() const;

private:
    std::vector<std::vector<std::string>> rows_; // an empty row is a rule
};

// "12.3" with three significant digits and no exponent for 0.001 <= value < 1e6, for people.
std::string threeDigits(double value);
// 1234567 -> "1,234,567".
std::string grouped(unsigned long long value);
// "1 light", "4,000 lights": for nouns whose plural ends in s.
std::string counted(unsigned long long value, const std::string& noun);

} // namespace candelabra::app
