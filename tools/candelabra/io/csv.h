// SPDX-License-Identifier: Apache-2.0
// Reads the CSV files of tools/bench/results (written by tools/update_results and tools/gpu_stats).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace candelabra::app
{

struct CsvFile {
    std::map<std::string, std::string> head; // of the lines "# key: value" before the columns
    std::vector<std::map<std::string, std::string>> rows; // cells by the names of their columns
};
// Throws RunError if the file cannot be read, or if a row has more or fewer cells than there are
// columns. A cell may be in quotes, but may not have a quote or a line break in it.
CsvFile readCsv(const std::filesystem::path& path);

} // namespace candelabra::app
