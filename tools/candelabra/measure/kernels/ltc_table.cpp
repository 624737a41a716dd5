// SPDX-License-Identifier: Apache-2.0
#include "measure/kernels/ltc_table.h"

#include <iterator>

#include "shared/ltc.h"

namespace candelabra::app
{
namespace
{

constexpr size_t rowSize = 5;
constexpr double numbers[] = {
#include "measure/kernels/ltc_table.inc"
};
static_assert(std::size(numbers) == rowSize * gpu::LTC_TABLE_SIZE * gpu::LTC_TABLE_SIZE);

} // namespace

std::vector<glm::vec4> ltcTable()
{
    std::vector<glm::vec4> texels;
    for (size_t i = 0; i < std::size(numbers); i += rowSize) {
        texels.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]);
        texels.emplace_back(numbers[i + 4], 0, 0, 0);
    }
    return texels;
}

} // namespace candelabra::app
