// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/emitters.h"

#include <cmath>
#include <cstring>
#include <string>

namespace candelabra::gbuffer
{
namespace
{

gpu::EmitterRecord recordOf(const CndLight& light, size_t index)
{
    const auto& p = light.position;
    const auto& e = light.emission;
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]) ||
        !std::isfinite(e[0]) || !std::isfinite(e[1]) || !std::isfinite(e[2]))
        gpu::failArgument("emitter " + std::to_string(index) +
                          " has a position or emission that is not finite");
    if (!(light.radius > 0) || !std::isfinite(light.radius))
        gpu::failArgument("emitter " + std::to_string(index) + " has a radius that is not above 0");
    return {{p[0], p[1], p[2]}, light.radius, {e[0], e[1], e[2]}};
}

} // namespace

void Emitters::set(std::span<const CndLight> lights, const double origin[3])
{
    std::vector<gpu::EmitterRecord> records;
    records.reserve(lights.size());
    for (size_t i = 0; i < lights.size(); ++i)
        if (lights[i].type == CND_LIGHT_SPHERE)
            records.push_back(recordOf(lights[i], i));

    const VkDeviceSize bytes = records.size() * sizeof(gpu::EmitterRecord);
    std::vector<gpu::Buffer> larger(slots_.size());
    for (size_t s = 0; s < slots_.size(); ++s)
        if (slots_[s].buffer.size < bytes && slots_[s].larger.size < bytes)
            larger[s] =
                gpu::createBuffer(*device_, "emitters", bytes, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                                  gpu::MemoryUse::Upload);
    for (size_t s = 0; s < slots_.size(); ++s)
        if (larger[s].mapped)
            slots_[s].larger = std::move(larger[s]);
    records_ = std::move(records);
    origin_ = {origin[0], origin[1], origin[2]};
    ++version_;
}

const gpu::Buffer& Emitters::update(uint32_t slotIndex) noexcept
{
    Slot& slot = slots_[slotIndex];
    if (slot.larger.mapped) {
        slot.buffer = std::move(slot.larger);
        slot.larger = {};
    }
    if (slot.version != version_ && !records_.empty())
        std::memcpy(slot.buffer.mapped, records_.data(),
                    records_.size() * sizeof(gpu::EmitterRecord));
    slot.version = version_;
    return slot.buffer;
}

} // namespace candelabra::gbuffer
