// SPDX-License-Identifier: Apache-2.0
#include "io/csv.h"

#include <fstream>

#include <fmt/format.h>

#include "io/error.h"

namespace candelabra::app
{
namespace
{

// Commas between quotes do not separate.
std::vector<std::string> cellsOf(const std::string& line)
{
    std::vector<std::string> out(1);
    bool quoted = false;
    for (const char c : line) {
        if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            out.emplace_back();
        else
            out.back() += c;
    }
    return out;
}

} // namespace

CsvFile readCsv(const std::filesystem::path& path)
{
    std::ifstream file(path);
    if (!file)
        throw RunError(fmt::format("{}: cannot be read", path.string()));
    CsvFile out;
    std::vector<std::string> columns;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("# ")) {
            const size_t colon = line.find(": ");
            if (colon != std::string::npos)
                out.head[line.substr(2, colon - 2)] = line.substr(colon + 2);
            continue;
        }
        const std::vector<std::string> cells = cellsOf(line);
        if (columns.empty()) {
            columns = cells;
            continue;
        }
        if (cells.size() != columns.size())
            throw RunError(fmt::format("{}: a row has {} cells, but there are {} columns",
                                       path.string(), cells.size(), columns.size()));
        auto& row = out.rows.emplace_back();
        for (size_t i = 0; i < columns.size(); ++i)
            row[columns[i]] = cells[i];
    }
    return out;
}

} // namespace candelabra::app
