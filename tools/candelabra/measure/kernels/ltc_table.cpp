// SPDX-License-Identifier: Apache-2.0
#include "measure/kernels/ltc_table.h"

#include <iterator>

#include "shared/ltc.h"

namespace candelabra::app
{
namespace
{

constexpr double rows[][5] = {
#include "measure/kernels/ltc_table.inc"
};
static_assert(std::size(rows) == gpu::LTC_TABLE_SIZE * gpu::LTC_TABLE_SIZE);

} // namespace

std::vector<glm::vec4> ltcTable()
{
    std::vector<glm::vec4> texels;
    for (const auto& [sharpnessX, sharpnessY, shift, albedo, dielectricAlbedo] : rows) {
        texels.emplace_back(sharpnessX, sharpnessY, shift, albedo);
        texels.emplace_back(dielectricAlbedo, 0, 0, 0);
    }
    return texels;
}

} // namespace candelabra::app
