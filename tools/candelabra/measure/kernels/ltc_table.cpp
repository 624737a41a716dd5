// SPDX-License-Identifier: Apache-2.0
#include "measure/kernels/ltc_table.h"

namespace candelabra::app
{
namespace
{

// The table is generated with: candelabra_fit ltc tools/candelabra/measure/kernels/ltc_table.inc
constexpr float texels[] = {
#include "measure/kernels/ltc_table.inc"
};
static_assert(sizeof texels ==
              gpu::LTC_TABLE_SIZE * gpu::LTC_TABLE_SIZE * gpu::LTC_TEXELS * 4 * sizeof(float));

} // namespace

std::span<const float> ltcTable()
{
    return texels;
}

} // namespace candelabra::app
