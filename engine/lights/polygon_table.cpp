// SPDX-License-Identifier: Apache-2.0
#include "lights/polygon_table.h"

#include <algorithm>
#include <cstring>

#include "lights/pack_lights.h"

namespace candelabra::lighting
{
namespace
{

constexpr VkDeviceSize polygonBytes = sizeof(gpu::PolygonRecord);
// The capacity starts here and grows by half.
constexpr size_t firstCapacity = 64;

} // namespace

void PolygonTable::reserve(size_t written, size_t added)
{
    if (written)
        makeRoom(polygons_.size() + added - std::min(added, free_.size()));
}

void PolygonTable::reserveSet(size_t count)
{
    if (count)
        makeRoom(count);
}

// Makes room for `count` polygons and prepares their upload.
void PolygonTable::makeRoom(size_t count)
{
    const size_t present = size_t(store_.buffer.size / polygonBytes);
    const bool grows = count > present;
    const size_t capacity =
        grows ? std::max({count, firstCapacity, present + present / 2}) : present;
    polygons_.reserve(capacity);
    free_.reserve(capacity);
    if (!grows) {
        // An upload that is not recorded yet can take more, and so can one that has been read.
        const uint64_t running = recordings_.oldestRunning();
        const auto reusable = std::ranges::find_if(store_.staging, [&](const Staging& s) {
            return &s == pending_ || s.recording < running;
        });
        pending_ = reusable != store_.staging.end()
                       ? &*reusable
                       : &store_.staging.emplace_back(createStaging(capacity));
        return;
    }
    Store larger;
    larger.buffer =
        gpu::createBuffer(device_, "polygons", capacity * polygonBytes,
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                          gpu::MemoryUse::Device);
    larger.staging.push_back(createStaging(capacity));
    recordings_.replace(store_, std::move(larger));
    pending_ = &store_.staging.front();
    changed(0, uint32_t(polygons_.size()));
}

PolygonTable::Staging PolygonTable::createStaging(size_t capacity) const
{
    return {gpu::createBuffer(device_, "polygon staging", capacity * polygonBytes,
                              VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::MemoryUse::Upload)};
}

void PolygonTable::changed(uint32_t first, uint32_t end) noexcept
{
    changedFirst_ = std::min(changedFirst_, first);
    changedEnd_ = std::max(changedEnd_, end);
}

void PolygonTable::clear() noexcept
{
    polygons_.clear();
    free_.clear();
    changedFirst_ = UINT32_MAX;
    changedEnd_ = 0;
}

uint32_t PolygonTable::add(const CndLight& light, uint32_t id) noexcept
{
    if (free_.empty()) {
        polygons_.push_back(packPolygon(light, id));
        const uint32_t index = uint32_t(polygons_.size()) - 1;
        changed(index, index + 1);
        return index;
    }
    const uint32_t index = free_.back();
    free_.pop_back();
    update(index, light, id);
    return index;
}

// A light that only moves keeps its corners, so that nothing is uploaded.
void PolygonTable::update(uint32_t index, const CndLight& light, uint32_t id) noexcept
{
    const gpu::PolygonRecord record = packPolygon(light, id);
    if (std::memcmp(&record, &polygons_[index], sizeof record) == 0)
        return;
    polygons_[index] = record;
    changed(index, index + 1);
}

void PolygonTable::recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept
{
    if (!isChanged())
        return;
    const VkDeviceSize first = changedFirst_ * polygonBytes;
    const VkDeviceSize bytes = (changedEnd_ - changedFirst_) * polygonBytes;
    std::memcpy(pending_->buffer.mapped + first, &polygons_[changedFirst_], bytes);
    const VkBufferCopy copy{first, first, bytes};
    device_.CmdCopyBuffer(frame.cmd, pending_->buffer.get(), store_.buffer.get(), 1, &copy);
    pending_->recording = recording;
    pending_ = nullptr;
    changedFirst_ = UINT32_MAX;
    changedEnd_ = 0;
}

} // namespace candelabra::lighting
