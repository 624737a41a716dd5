// SPDX-License-Identifier: Apache-2.0
// Reads the CSV files of tools/bench/results (written by tools/update_results and tools/gpu_stats).
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace candelabra::test
{

// Returns the rows of a file, as cells by the names of their columns. Cells may not be in quotes.
inline std::vector<std::map<std::string, std::string>> csvRows(const std::string& path)
{
    std::vector<std::map<std::string, std::string>> rows;
    std::vector<std::string> columns;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream in(line);
        std::vector<std::string> cells;
        for (std::string cell; std::getline(in, cell, ',');)
            cells.push_back(cell);
        if (line.starts_with("# "))
            continue;
        if (columns.empty()) {
            columns = cells;
            continue;
        }
        auto& row = rows.emplace_back();
        for (size_t i = 0; i < cells.size(); ++i)
            row[columns.at(i)] = cells[i];
    }
    return rows;
}

} // namespace candelabra::test
