// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/emitters.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <glm/geometric.hpp>

#include "candelabra_gbuffer_shaders.h"
#include "gbuffer/triangle_pieces.h"

namespace candelabra::gbuffer
{
namespace
{

bool isFinite(const float (&v)[3])
{
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

glm::vec3 vec(const float (&v)[3])
{
    return {v[0], v[1], v[2]};
}

gpu::EmitterRecord recordOf(const CndLight& light, size_t index)
{
    const auto require = [&](bool condition, const char* otherwise) {
        if (!condition)
            gpu::failArgument("emitter " + std::to_string(index) + " has " + otherwise);
    };
    const auto has = [&](uint32_t types) { return (types >> light.type & 1) != 0; };
    const bool distant = Emitters::isDistant(light.type);
    require((distant || isFinite(light.position)) && isFinite(light.emission),
            "a position or emission that is not finite");
    require(!has(gpu::TYPES_WITH_RADIUS) || (light.radius > 0 && std::isfinite(light.radius)),
            "a radius that is not above 0");
    const auto isLong = [](const float(&v)[3]) { return isFinite(v) && glm::length(vec(v)) > 0; };
    require((!has(gpu::TYPES_WITH_AXIS_U) || isLong(light.axisU)) &&
                (!has(gpu::TYPES_WITH_AXIS_V) || isLong(light.axisV)),
            "an axis without length");
    gpu::EmitterRecord record{
        .position = vec(light.position), .radius = light.radius, .luminance = vec(light.emission)};
    if (has(gpu::TYPES_WITH_AXIS_U))
        record.axisU = vec(light.axisU);
    if (has(gpu::TYPES_WITH_AXIS_V))
        record.axisV = vec(light.axisV);
    if (has(gpu::TYPES_WITH_DIRECTION)) {
        require(isLong(light.direction), "a direction without length");
        const glm::vec3 direction = glm::normalize(vec(light.direction));
        (distant ? record.position : record.axisU) = distant ? -direction : direction;
    }
    record.twoSided = light.twoSided ? 1.f : 0.f;
    return record;
}

gpu::EmitterCorners cornersOf(const CndLight& light, size_t index)
{
    const CndPolygon* const polygon = light.polygon;
    if (!polygon || polygon->cornerCount < 3 || polygon->cornerCount > CND_MAX_CORNERS)
        gpu::failArgument("emitter " + std::to_string(index) + " has not 3 to 8 corners");
    gpu::EmitterCorners out;
    for (uint32_t i = 0; i < CND_MAX_CORNERS; ++i) {
        const float(&corner)[2] = polygon->corners[std::min(i, polygon->cornerCount - 1)];
        if (!std::isfinite(corner[0]) || !std::isfinite(corner[1]))
            gpu::failArgument("emitter " + std::to_string(index) +
                              " has a corner that is not finite");
        for (uint32_t k = 0; k < 2; ++k)
            out.pairs[i / 2][int(i % 2 * 2 + k)] = corner[k];
    }
    return out;
}

} // namespace

Emitters::Emitters(const gpu::Device& device, uint32_t slots)
    : device_(&device), culls_(cullsTriangles(device)), slots_(slots)
{
    if (!culls_)
        return;
    cullEmitters_ = {device, spirv::cull_emitters_comp};
    cullSets_ = cullEmitters_.createBindings(slots);
}

Emitters::Buffers Emitters::createBuffers(VkDeviceSize bytes) const
{
    constexpr VkBufferUsageFlags vertices =
        VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    Buffers buffers;
    buffers.records =
        gpu::createBuffer(*device_, "emitters", bytes, vertices, gpu::MemoryUse::Upload);
    if (culls(bytes)) {
        const VkDeviceSize pieces =
            bytes / (sizeof(gpu::EmitterRecord) * gpu::PIECE_EMITTERS) + shapeCount;
        buffers.kept =
            gpu::createBuffer(*device_, "kept emitters", bytes, vertices, gpu::MemoryUse::Device);
        buffers.draws = gpu::createBuffer(
            *device_, "emitter draws", pieces * sizeof(gpu::EmitterDraw),
            VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                VK_BUFFER_USAGE_TRANSFER_SRC_BIT, // lets tests copy it
            gpu::MemoryUse::Device);
    }
    return buffers;
}

void Emitters::set(std::span<const CndLight> lights, const double origin[3])
{
    std::array<uint32_t, gpu::LIGHT_TYPE_COUNT> counts{}, next{}; // by type
    for (const CndLight& light : lights)
        if (light.type < gpu::LIGHT_TYPE_COUNT)
            ++counts[light.type];
    std::array<Group, shapeCount> groups{};
    uint32_t emitters = 0, pieces = 0;
    for (size_t shape = 0; shape < shapeCount; ++shape) {
        const uint32_t count = counts[shapes[shape]];
        groups[shape] = {emitters, count, pieces, gpu::divideUp(count, gpu::PIECE_EMITTERS)};
        next[shapes[shape]] = emitters;
        emitters += count;
        pieces += groups[shape].pieceCount;
    }
    std::vector<gpu::EmitterRecord> records(emitters);
    std::vector<gpu::EmitterCorners> corners;
    for (size_t i = 0; i < lights.size(); ++i) {
        const uint32_t type = lights[i].type;
        if (type >= gpu::LIGHT_TYPE_COUNT || !(gpu::AREA_LIGHT_TYPES >> type & 1))
            continue;
        records[next[type]++] = recordOf(lights[i], i);
        if (type == gpu::LIGHT_POLYGON)
            corners.push_back(cornersOf(lights[i], i));
    }
    if (corners.empty())
        corners.push_back({});
    const VkDeviceSize bytes =
        records.empty() ? 0 : cornersOffsetOf(records.size()) + corners.size() * sizeof(corners[0]);
    std::vector<Buffers> larger(slots_.size());
    for (size_t s = 0; s < slots_.size(); ++s)
        if (!slots_[s].buffers.hold(bytes) && !slots_[s].larger.hold(bytes))
            larger[s] = createBuffers(bytes);
    for (size_t s = 0; s < slots_.size(); ++s)
        if (larger[s].records.mapped)
            slots_[s].larger = std::move(larger[s]);
    records_ = std::move(records);
    corners_ = std::move(corners);
    groups_ = groups;
    origin_ = {origin[0], origin[1], origin[2]};
    ++version_;
}

void Emitters::update(uint32_t slotIndex, const gpu::Buffer& rasterFrame) noexcept
{
    Slot& slot = slots_[slotIndex];
    if (slot.larger.records.mapped) {
        slot.buffers = std::move(slot.larger);
        slot.larger = {};
        if (slot.buffers.kept.size)
            cullSets_.write(slotIndex,
                            {gpu::Binding::of(gpu::RAY_FRAME, rasterFrame),
                             gpu::Binding::of(gpu::CULL_EMITTERS_RECORDS, slot.buffers.records),
                             gpu::Binding::of(gpu::CULL_EMITTERS_CORNERS, slot.buffers.records),
                             gpu::Binding::of(gpu::CULL_EMITTERS_KEPT_RECORDS, slot.buffers.kept),
                             gpu::Binding::of(gpu::CULL_EMITTERS_KEPT_CORNERS, slot.buffers.kept),
                             gpu::Binding::of(gpu::CULL_EMITTERS_DRAWS, slot.buffers.draws)});
    }
    if (slot.version != version_ && !records_.empty()) {
        std::byte* const to = slot.buffers.records.mapped;
        std::memcpy(to, records_.data(), records_.size() * sizeof(gpu::EmitterRecord));
        std::memcpy(to + cornersOffset(), corners_.data(),
                    corners_.size() * sizeof(gpu::EmitterCorners));
    }
    slot.version = version_;
}

void Emitters::recordCulling(const gpu::Frame& frame) const noexcept
{
    const gpu::UntimedFrame untimed(frame); // one timer row for all shapes
    for (size_t i = 0; i < shapeCount; ++i) {
        const Group& group = groups_[i];
        if (group.count) {
            cullEmitters_.dispatch(
                untimed, cullSets_.set(frame.slot),
                {.shape = shapes[i],
                 .first = group.first,
                 .count = group.count,
                 .firstCorners = uint32_t(cornersOffset() / sizeof(glm::vec4)),
                 .firstPiece = group.firstPiece,
                 .pieceCount = group.pieceCount,
                 .snap = float(std::exp2(-double(device_->limits.subPixelPrecisionBits)))},
                gpu::divideUp(group.pieceCount, gpu::CULL_EMITTERS_GROUP));
            // All shapes write to the same buffers. They write to different places, but
            // synchronisation validation cannot know.
            frame.barrier();
        }
    }
    frame.timer.stamp(frame.cmd, "cull_emitters");
}

} // namespace candelabra::gbuffer
