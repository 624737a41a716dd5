// SPDX-License-Identifier: Apache-2.0
// Table: aligned columns for the terminal. Debian has no C++ library for this; fmt aligns single
// cells, when the widths of the columns are known.
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
    // Adds a row, which must have as many cells as the header.
    void add(std::vector<std::string> cells);
    // Draws a line across the table before the next row.
    void rule();
    // The table as lines that each end in a newline. The first column is aligned to the left, the
    // others to the right.
    std::string text() const;

private:
    std::vector<std::vector<std::string>> rows_; // an empty row is a rule
};

// A number for people to read: three significant digits, such as "12.3", or all digits before the
// point if there are more. Values below 0.001 and from 1e6 on have an exponent.
std::string threeDigits(double value);
// 1234567 -> "1,234,567".
std::string grouped(unsigned long long value);
// "1 light", "4,000 lights": for nouns whose plural ends in s.
std::string counted(unsigned long long value, const std::string& noun);

} // namespace candelabra::app
