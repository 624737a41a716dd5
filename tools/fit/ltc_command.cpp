// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iostream>
#include <thread>

#include "fit/commands.h"
#include "fit/ltc_lobe.h"
#include "io/error.h"
#include "io/report.h"
#include "shared/ltc.h"

namespace
{

using candelabra::fit::LtcLobe;
using candelabra::fit::LtcShape;
using namespace candelabra;

constexpr int size = int(gpu::LTC_TABLE_SIZE);

struct Entry {
    LtcShape shape;
    LtcLobe::Error error;
    double albedo = 0;
};

LtcLobe lobeAt(double i, double j, double F0)
{
    const double low = gpu::LTC_MIN_ROUGHNESS;
    const double roughness = low + (1 - low) * i / (size - 1);
    const double v = j / (size - 1);
    const double lowest = gpu::LTC_MIN_NOV;
    return {roughness * roughness, lowest + (1 - lowest) * (1 - v * v) * (1 - v * v), F0};
}

// Calls function(i) for every row i of the table, on all cores.
void forRows(const std::function<void(int)>& function)
{
    std::atomic<int> next = 0;
    std::vector<std::jthread> threads;
    for (unsigned t = 0; t < std::max(1u, std::thread::hardware_concurrency()); ++t)
        threads.emplace_back([&] {
            for (int i = next++; i < size; i = next++)
                function(i);
        });
}

using Table = std::vector<Entry>; // [j * size + i]

// Fits a shape from `start`, and puts it into the entry if it is better than what is there.
void improve(Entry& entry, const LtcLobe& lobe, const LtcShape& start,
             std::initializer_list<double> steps)
{
    const LtcShape shape = lobe.fitted(start, steps);
    const LtcLobe::Error error = lobe.error(shape);
    if (error.cost < entry.error.cost)
        entry = {shape, error, lobe.albedo()};
}

// First fits every row from the normal towards grazing views; each fit starts from the result of
// the one before. Then fits every entry again, from the results of all its neighbours, twice: this
// removes jumps between entries that are in different local minima.
Table fitTable(double F0)
{
    Table table(size * size);
    forRows([&](int i) {
        LtcShape start;
        for (int j = 0; j < size; ++j) {
            Entry& entry = table[j * size + i];
            entry.error.cost = INFINITY;
            improve(entry, lobeAt(i, j, F0), start, {0.2, 0.05});
            start = entry.shape;
        }
    });
    for (int pass = 0; pass < 2; ++pass) {
        const Table before = table;
        forRows([&](int i) {
            for (int j = 0; j < size; ++j) {
                const LtcLobe lobe = lobeAt(i, j, F0);
                for (const auto& [di, dj] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
                    if (i + di >= 0 && i + di < size && j + dj >= 0 && j + dj < size)
                        improve(table[j * size + i], lobe, before[(j + dj) * size + i + di].shape,
                                {0.05});
            }
        });
    }
    return table;
}

// The error of the shapes that the shader interpolates halfway between entries.
LtcLobe::Error interpolationError(const Table& table, double F0)
{
    LtcLobe::Error sum;
    std::vector<LtcLobe::Error> rows(size);
    forRows([&](int i) {
        for (int j = 0; i + 1 < size && j + 1 < size; ++j) {
            LtcShape mean{0, 0, 0};
            for (const int k : {0, 1, size, size + 1}) {
                const LtcShape& s = table[j * size + i + k].shape;
                mean.sharpnessX += s.sharpnessX / 4;
                mean.sharpnessY += s.sharpnessY / 4;
                mean.shift += s.shift / 4;
            }
            const LtcLobe::Error error = lobeAt(i + 0.5, j + 0.5, F0).error(mean);
            rows[i].mean += error.mean / ((size - 1) * (size - 1));
            rows[i].largest = std::max(rows[i].largest, error.largest);
        }
    });
    for (const LtcLobe::Error& row : rows) {
        sum.mean += row.mean;
        sum.largest = std::max(sum.largest, row.largest);
    }
    return sum;
}

std::string residuals(const char* lobe, const Table& table, double F0)
{
    std::vector<double> means;
    double mean = 0, largest = 0;
    for (const Entry& entry : table) {
        means.push_back(entry.error.mean);
        mean += entry.error.mean / (size * size);
        largest = std::max(largest, entry.error.largest);
    }
    std::sort(means.begin(), means.end());
    const LtcLobe::Error between = interpolationError(table, F0);
    char text[512];
    std::snprintf(
        text, sizeof text,
        "// %s: mean %.2f, largest %.1f; of the entries' means: median %.2f, 99th "
        "percentile %.2f,\n//   largest %.2f; halfway between entries, interpolated: mean "
        "%.2f, largest %.1f.\n",
        lobe, 100 * mean, 100 * largest, 100 * means[means.size() / 2],
        100 * means[means.size() * 99 / 100], 100 * means.back(), 100 * between.mean,
        100 * between.largest);
    return text;
}

} // namespace

namespace candelabra::fit
{

void runLtc(const std::string& output)
{
    app::requireWritable("OUTPUT", output);
    const Table white = fitTable(1), dielectric = fitTable(double(gpu::LTC_DIELECTRIC_F0));
    const std::string text = "// Residuals, percent of the highest response to a light of the same "
                             "size.\n" +
                             residuals("F = 1", white, 1) +
                             residuals("dielectric", dielectric, double(gpu::LTC_DIELECTRIC_F0));
    std::cout << text;
    std::ofstream file(output);
    file << "// Made by candelabra_fit; not edited by hand.\n" << text;
    for (int i = 0; i < size * size; ++i) {
        for (const Entry& e : {white[i], dielectric[i]}) {
            char numbers[96];
            std::snprintf(numbers, sizeof numbers, "%.7ef, %.7ef, %.7ef, %.7ef,",
                          e.shape.sharpnessX, e.shape.sharpnessY, e.shape.shift, e.albedo);
            file << numbers;
        }
        file << "\n";
    }
    file.close();
    if (!file)
        throw app::RunError("cannot write " + output);
}

} // namespace candelabra::fit
