// SPDX-License-Identifier: Apache-2.0
#include "tables/ltc_table.h"

namespace candelabra::tables
{
namespace
{

// The table is generated with: candelabra_fit ltc engine/tables/ltc_table.inc
constexpr float table[] = {
#include "tables/ltc_table.inc"
};
static_assert(sizeof table ==
              gpu::LTC_TABLE_SIZE * gpu::LTC_TABLE_SIZE * gpu::LTC_TEXELS * 4 * sizeof(float));

} // namespace

std::span<const float> ltcTable()
{
    return table;
}

} // namespace candelabra::tables
