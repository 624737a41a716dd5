// SPDX-License-Identifier: Apache-2.0
#include "tables/dfg_table.h"

#include "candelabra_shaders.h"

namespace candelabra::tables
{
namespace
{

constexpr uint32_t entryCount = gpu::DFG_SIZE * gpu::DFG_SIZE;

gpu::Buffer createEntries(const gpu::Device& device)
{
    gpu::Buffer out = gpu::createBuffer(
        device, "directional albedo table", entryCount * sizeof(glm::vec4),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
        gpu::MemoryUse::Device);
    gpu::createTexelView(device, out);
    return out;
}

} // namespace

DfgTable::DfgTable(const gpu::Device& device)
    : kernel_(device, spirv::dfg_table_comp),
      bindings_(kernel_.createBindings(1)),
      entries_(createEntries(device))
{
    bindings_.write(0, {gpu::Binding::of(gpu::DFG_TABLE_ENTRIES, entries_)});
}

void DfgTable::recordFill(const gpu::Frame& frame) noexcept
{
    if (recorded_)
        return;
    recorded_ = true;
    kernel_.dispatch(frame, bindings_.set(0), {entryCount},
                     gpu::divideUp(entryCount, gpu::DFG_TABLE_GROUP));
}

} // namespace candelabra::tables
