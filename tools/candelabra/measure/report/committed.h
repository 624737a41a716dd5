// SPDX-License-Identifier: Apache-2.0
// Compares the ratios of a run with the results that are committed with the sources, which were
// measured at greater length. Times in milliseconds are not compared: they depend on the machine.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/csv.h"
#include "io/statistics.h"
#include "io/table.h"
#include "measure/accuracy/kernel_level.h"
#include "measure/culling/culling.h"

namespace candelabra::app
{

// A figure contradicts a committed one that is farther from its interval than this share of the
// committed figure; for a ratio, which may be near 0, also farther than this difference.
constexpr double contradictionShare = 0.25, contradictionDifference = 0.05;

// A figure of this run, which is named like the row of the table that has it. It is compared with
// committed figures of the same conditions only: those of other pictures differ for that reason.
struct ReportedFigure {
    std::string key;
    MedianInterval value;
    double allowance = contradictionDifference; // the difference that is always allowed
    std::string conditions = {}; // of the picture, such as its size; empty if there is none
};
std::vector<ReportedFigure> figuresOf(const std::vector<CullingPoint>& points);
std::vector<ReportedFigure> figuresOf(const KernelLevel& level);

// Figures by key, and those of one key by their conditions.
using CommittedFigures = std::map<std::string, std::map<std::string, double>>;

struct CommittedResults {
    std::string directory;
    std::vector<std::string> files; // those of the same device and driver
    CommittedFigures figures;
};
// Reads the results of this device and driver from the CSV files in a directory, which
// tools/update_results writes. Files that hold something else are passed over. Returns nothing if
// there is no such directory.
std::optional<CommittedResults> readCommitted(const std::string& directory,
                                              const DeviceInfo& device);
// Adds the figures of one table: "culling", "accuracy" or "price". Others have none to compare
// with.
void addFigures(const std::string& table, const CsvFile& file, CommittedFigures& figures);

bool contradicts(const ReportedFigure& figure, double committed);

struct Comparison {
    Table table;
    std::vector<std::string> contradictions; // the keys
    size_t compared = 0;
    std::string omission; // a sentence about figures of other conditions; empty if there are none
};
Comparison compareWithCommitted(const std::vector<ReportedFigure>& figures,
                                const CommittedResults& committed);

} // namespace candelabra::app
