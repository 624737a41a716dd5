// SPDX-License-Identifier: Apache-2.0
// Table: a table of results as an object, which is rendered as aligned text for the terminal or as
// HTML for a page. Debian has no C++ library for this; fmt aligns single cells, when the widths of
// the columns are known.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace candelabra::app
{

struct Column {
    // Implicit, so that a table whose columns need no explanation is made from their names alone.
    Column(const char* name, std::string unit = "", std::string about = "");
    // A column of words, which is aligned to the left, as the first column always is.
    static Column words(const char* name, std::string about);

    // The name and the unit, as printed above the column in text.
    std::string head() const;

    std::string name, unit;
    std::string about; // a sentence that explains the column on pages; may be empty
    bool isWords = false;
};

// Facts about a row that its cells do not hold. Tables mark rows by them.
struct RowFacts {
    bool noisy = false; // its repeated measurements differ much (isNoisy)
    std::string key;    // names the row for Table::markContradictions
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
    // Marks the rows that have one of these keys as contradicting earlier results.
    void markContradictions(std::span<const std::string> keys);

    void setTitle(std::string title);
    const std::string& title() const { return title_; }
    const std::vector<Column>& columns() const { return columns_; }

    // The title, the table and the notes as lines that each end in a newline. Numbers are aligned
    // to the right.
    std::string text() const;
    // A table in a box that scrolls sideways, with its notes and the explanations of its columns.
    std::string html() const;

private:
    struct Row {
        std::vector<std::string> cells; // none: a rule
        RowFacts facts;
        bool contradicts = false;
    };
    std::string firstCell(const Row& row) const; // with its marks
    // The notes, followed by an explanation of every mark that the table has.
    std::vector<std::string> allNotes() const;
    std::string htmlRow(const Row& row, bool ruled) const;

    std::string title_;
    std::vector<Column> columns_;
    std::vector<Row> rows_;
    std::vector<std::string> notes_;
};

// The marks of rows, which follow the name of the row.
inline constexpr const char* noisyMark = "~";
inline constexpr const char* contradictionMark = "!";
// The sentences that explain them.
std::string noisyLegend();
std::string contradictionLegend();
// Explains columns whose unit is "paired".
std::string pairedLegend();

// Several tables one after another, with an empty line between two of them.
std::string textOf(std::span<const Table> tables);

// A number for people to read: three significant digits, such as "12.3", or all digits before the
// point if there are more. Values below 0.001 and from 1e6 on have an exponent.
std::string threeDigits(double value);
// The same, or "below noise" for none.
std::string threeDigits(const std::optional<double>& value);
// 1234567 -> "1,234,567".
std::string grouped(unsigned long long value);
// "1 light", "4,000 lights": for nouns whose plural ends in s.
std::string counted(unsigned long long value, const std::string& noun);

} // namespace candelabra::app
