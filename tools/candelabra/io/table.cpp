// SPDX-License-Identifier: Apache-2.0
#include "io/table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "io/error.h"
#include "io/statistics.h"

namespace candelabra::app
{

Column::Column(const char* title, std::string inUnit) : name(title), unit(std::move(inUnit)) {}

Column Column::words(const char* name)
{
    Column out(name);
    out.isWords = true;
    return out;
}

std::string Column::head() const
{
    return unit.empty() ? name : name + " " + unit;
}

std::string noisyLegend()
{
    return fmt::format("{} marks a row whose repeats are noisy: their middle half spans more than "
                       "{:.0f}% of their median.",
                       noisyMark, 100 * noisyShare);
}

std::string pairedLegend()
{
    return "paired: the median of the ratios of single rounds, which differs from the quotient of "
           "the medians.";
}

Table::Table(std::vector<Column> columns, std::string title)
    : title_(std::move(title)), columns_(std::move(columns))
{
    columns_[0].isWords = true;
}

void Table::add(std::vector<std::string> cells, RowFacts facts)
{
    if (cells.size() != columns_.size())
        throw RunError(
            fmt::format("a table row has {} cells, its header {}", cells.size(), columns_.size()));
    rows_.push_back({.cells = std::move(cells), .facts = std::move(facts)});
}

void Table::rule()
{
    rows_.push_back({});
}

void Table::note(std::string text)
{
    notes_.push_back(std::move(text));
}

std::string Table::firstCell(const Row& row) const
{
    std::string out = row.cells[0];
    if (row.facts.noisy)
        out.append(" ").append(noisyMark);
    return out;
}

std::vector<std::string> Table::allNotes() const
{
    std::vector<std::string> out = notes_;
    if (std::ranges::any_of(rows_, [](const Row& row) { return row.facts.noisy; }))
        out.push_back(noisyLegend());
    return out;
}

std::string Table::text() const
{
    std::vector<std::vector<std::string>> lines(2); // the header and a rule
    for (const Column& column : columns_)
        lines[0].push_back(column.head());
    for (const Row& row : rows_) {
        lines.push_back(row.cells);
        if (!row.cells.empty())
            lines.back()[0] = firstCell(row);
    }
    std::vector<size_t> widths(columns_.size());
    for (const auto& line : lines)
        for (size_t i = 0; i < line.size(); ++i)
            widths[i] = std::max(widths[i], line[i].size());
    std::string out = title_.empty() ? "" : title_ + "\n";
    for (const auto& line : lines) {
        for (size_t i = 0; i < widths.size(); ++i) {
            const char* gap = i ? "  " : "";
            if (line.empty())
                out.append(gap).append(widths[i], '-');
            else
                out += fmt::format(fmt::runtime(columns_[i].isWords ? "{}{:<{}}" : "{}{:>{}}"), gap,
                                   line[i], widths[i]);
        }
        out.erase(out.find_last_not_of(' ') + 1);
        out += '\n';
    }
    for (const std::string& note : allNotes())
        out += note + "\n";
    return out;
}

std::string textOf(std::span<const Table> tables)
{
    std::string out;
    for (const Table& table : tables)
        out += (out.empty() ? "" : "\n") + table.text();
    return out;
}

std::string threeDigits(double value)
{
    const double size = std::abs(value);
    if (!std::isfinite(value) || (size != 0 && (size < 1e-3 || size >= 1e6)))
        return fmt::format("{:.2e}", value);
    // The number of digits before the point of the rounded value decides how many follow it.
    const int decimals = size < 0.0999995 ? (size < 0.00999995 ? 5 : 4)
                         : size < 0.9995  ? 3
                         : size < 9.995   ? 2
                         : size < 99.95   ? 1
                                          : 0;
    return fmt::format("{:.{}f}", value, value == 0 ? 0 : decimals);
}

std::string threeDigits(const std::optional<double>& value)
{
    return value ? threeDigits(*value) : "below noise";
}

std::string groupedOrThreeDigits(double value)
{
    return value >= 999.5 && value < 1e15 ? grouped(std::llround(value)) : threeDigits(value);
}

std::string listed(std::span<const std::string> words)
{
    std::string out;
    for (size_t i = 0; i < words.size(); ++i)
        out += (i == 0 ? "" : i + 1 < words.size() ? ", " : " and ") + words[i];
    return out;
}

std::string grouped(unsigned long long value)
{
    std::string digits = std::to_string(value);
    for (size_t i = digits.size(); i > 3; i -= 3)
        digits.insert(i - 3, ",");
    return digits;
}

std::string counted(unsigned long long value, const std::string& noun)
{
    return grouped(value) + " " + noun + (value == 1 ? "" : "s");
}

} // namespace candelabra::app
