// SPDX-License-Identifier: Apache-2.0
// Tests that the committed table of linearly transformed cosines is what tools/fit would write.
#include <iostream>
#include <span>

#include <gtest/gtest.h>

#include "fit/ltc_lobe.h"
#include "measure/kernels/ltc_table.h"
#include "shared/ltc.h"

namespace candelabra::test
{
namespace
{

constexpr int size = int(gpu::LTC_TABLE_SIZE);

struct Entry {
    fit::LtcShape shape;
    double albedo;
};

Entry entryAt(int i, int j, uint32_t lobe)
{
    const float* e = &app::ltcTable()[4 * (gpu::LTC_TEXELS * (j * size + i) + lobe)];
    return {{e[0], e[1], e[2]}, e[3]};
}

fit::LtcLobe lobeAt(int i, int j, double F0)
{
    const double low = gpu::LTC_MIN_ROUGHNESS;
    const double roughness = low + (1 - low) * i / (size - 1);
    const double v = double(j) / (size - 1);
    const double lowest = gpu::LTC_MIN_NOV;
    return {roughness * roughness, lowest + (1 - lowest) * (1 - v * v) * (1 - v * v), F0};
}

} // namespace

TEST(LtcTable, HoldsTheLobesIntegralsAndFitsThem)
{
    double mean = 0, largestAlbedoError = 0;
    int count = 0;
    for (uint32_t lobe = 0; lobe < gpu::LTC_TEXELS; ++lobe)
        for (int j = 0; j < size; j += 6)
            for (int i = 0; i < size; i += 6) {
                const fit::LtcLobe fitted = lobeAt(i, j, lobe ? gpu::LTC_DIELECTRIC_F0 : 1);
                const Entry entry = entryAt(i, j, lobe);
                largestAlbedoError =
                    std::max(largestAlbedoError, std::abs(entry.albedo - fitted.albedo()));
                mean += fitted.error(entry.shape).mean;
                ++count;
            }
    mean *= 100.0 / count;
    std::cout << "mean error of " << count << " entries " << mean
              << " % of the peak, largest error of an albedo " << largestAlbedoError << "\n";
    EXPECT_LE(mean, 3.3); // half of the entries are at grazing angles; averaged over all angles the
                          // error is lower
    EXPECT_LE(largestAlbedoError, 1e-6);
}

// A descent that starts from the shape of another entry ends at the entry in the table.
TEST(LtcTable, IsWhatTheFitFinds)
{
    double inTable = 0, fitted = 0;
    for (const int i : {3, 15, 27})
        for (const int j : {4, 16, 26}) {
            const fit::LtcLobe lobe = lobeAt(i, j, 1);
            inTable += lobe.error(entryAt(i, j, 0).shape).cost;
            const fit::LtcShape start = entryAt(i + 2, j + 2, 0).shape;
            EXPECT_GT(lobe.error(start).cost, lobe.error(entryAt(i, j, 0).shape).cost);
            fitted += lobe.error(lobe.fitted(start, {0.2, 0.05})).cost;
        }
    std::cout << "cost of nine entries, fitted again, over that of the table: " << fitted / inTable
              << "\n";
    EXPECT_NEAR(fitted / inTable, 1, 0.01);
}

} // namespace candelabra::test
