// SPDX-License-Identifier: Apache-2.0
// Table: a table of results, which becomes aligned text for the terminal. Debian has no C++ library
// for this; fmt aligns single cells, when the widths of the columns are known.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace candelabra::app
{

struct Column {
    // Implicit, so that columns without a unit are made from their names alone.
    Column(const char* name, std::string unit = "");
    // A column of words, which is aligned to the left, as the first column always is.
    static Column words(const char* name);

    // The name and the unit, as printed above the column.
    std::string head() const;

    std::string name, unit;
    bool isWords = false;
};

// Facts about a row that its cells do not hold. Tables mark rows by them.
struct RowFacts {
    bool noisy = false; // its repeated measurements differ much (isNoisy)
};

class Table
{
public:
    explicit Table(std::vector<Column> columns, std::string title = "");
    // Adds a row, which must have as many cells as there are columns.
    void add(std::vector<std::string> cells, RowFacts facts = {});
    // Draws a line across the table before the next row.
    void rule();
    // Adds a line of text below the table.
    void note(std::string text);

    // The title, the table and the notes as lines that each end in a newline. Numbers are aligned
    // to the right.
    std::string text() const;

private:
    struct Row {
        std::vector<std::string> cells; // none: a rule
        RowFacts facts;
    };
    std::string firstCell(const Row& row) const; // with its mark
    // The notes, followed by an explanation of the mark if the table has it.
    std::vector<std::string> allNotes() const;

    std::string title_;
    std::vector<Column> columns_;
    std::vector<Row> rows_;
    std::vector<std::string> notes_;
};

// The mark of noisy rows, which follows the name of the row, and the sentence that explains it.
inline constexpr const char* noisyMark = "~";
std::string noisyLegend();
// Explains columns whose unit is "paired".
std::string pairedLegend();

// Several tables one after another, with an empty line between two of them.
std::string textOf(std::span<const Table> tables);

// A number for people to read: three significant digits, such as "12.3", or all digits before the
// point if there are more. Values below 0.001 and from 1e6 on have an exponent.
std::string threeDigits(double value);
// The same, or "below noise" for none.
std::string threeDigits(const std::optional<double>& value);
// A number with separators between thousands, such as "53,740", or three significant digits below
// 1000.
std::string groupedOrThreeDigits(double value);
// 1234567 -> "1,234,567".
std::string grouped(unsigned long long value);
// "a", "a and b", "a, b and c".
std::string listed(std::span<const std::string> words);
// "1 light", "4,000 lights": for nouns whose plural ends in s.
std::string counted(unsigned long long value, const std::string& noun);

} // namespace candelabra::app
