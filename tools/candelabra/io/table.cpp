// SPDX-License-Identifier: Apache-2.0
#include "io/table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "io/error.h"

namespace candelabra::app
{

Table::Table(std::vector<std::string> header)
{
    rows_.push_back(std::move(header));
    rule();
}

void Table::add(std::vector<std::string> cells)
{
    if (cells.size() != rows_[0].size())
        throw RunError(
            fmt::format("a table row has {} cells, its header {}", cells.size(), rows_[0].size()));
    rows_.push_back(std::move(cells));
}

void Table::rule()
{
    rows_.emplace_back();
}

std::string Table::text() const
{
    std::vector<size_t> widths(rows_[0].size());
    for (const auto& row : rows_)
        for (size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());
    std::string out;
    for (const auto& row : rows_) {
        for (size_t i = 0; i < widths.size(); ++i) {
            const char* gap = i ? "  " : "";
            if (row.empty())
                out.append(gap).append(widths[i], '-');
            else
                out +=
                    fmt::format(fmt::runtime(i ? "{}{:>{}}" : "{}{:<{}}"), gap, row[i], widths[i]);
        }
        out.erase(out.find_last_not_of(' ') + 1);
        out += '\n';
    }
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
