// SPDX-License-Identifier: Apache-2.0
#include "lights/light_table.h"

#include <algorithm>
#include <array>
#include <functional>

#include "lights/light_types.h"
#include "lights/pack_lights.h"

namespace candelabra::lighting
{
namespace
{

// Lights are looked up, packed and staged in blocks. The processor waits for many records at the
// same time when they are far from each other, and not for the small writes of a record before it
// copies it.
constexpr size_t tableBlock = 64;

} // namespace

void LightTable::reserveSet(size_t count)
{
    records_.reserve(count);
    places_.reserve(count);
    ids_.reserveAll(count);
}

void LightTable::reserveEdits(size_t removed, size_t added)
{
    gpu::reserveMore(records_, added);
    gpu::reserveMore(places_, added);
    ids_.reserve(removed, added);
    staged_.reserve(records_.capacity());
}

// Gives a packed record its id: the slot, or the index of its polygon. `before`: the polygon that
// the light of this slot has had, or noPolygon.
void LightTable::identify(gpu::LightRecord& packed, const CndLight& light, uint32_t slot,
                          uint32_t before) noexcept
{
    packed.id = slot;
    if (light.type == CND_LIGHT_POLYGON) {
        if (before == noPolygon)
            before = polygons_.add(light, slot);
        else
            polygons_.update(before, light, slot);
        packed.id = before;
    } else if (before != noPolygon) {
        polygons_.remove(before);
    }
}

void LightTable::stageAt(uint32_t at, uint32_t record, const Staging& staging) noexcept
{
    staged_[at] = record;
    places_[record].staged = at;
    staging.places[at] = record;
    staging.records[at] = records_[record];
}

void LightTable::stage(uint32_t record, const Staging& staging) noexcept
{
    if (all_) {
        staging.records[record] = records_[record];
        return;
    }
    const bool before = isStaged(record);
    const uint32_t at = before ? places_[record].staged : uint32_t(staged_.size());
    if (!before)
        staged_.push_back(record);
    stageAt(at, record, staging);
}

void LightTable::set(std::span<const CndLight> lights, const Staging& staging) noexcept
{
    const size_t count = lights.size();
    polygons_.clear();
    staged_.clear();
    all_ = true;
    records_.resize(count);
    places_.resize(count);
    ids_.setAll(uint32_t(count));
    for (uint32_t i = 0; i < count; ++i)
        places_[i] = {i, 0};
    for (size_t first = 0; first < count; first += tableBlock) {
        const auto block = std::span(records_).subspan(first, std::min(tableBlock, count - first));
        packLights(lights.subspan(first, block.size()), block, uint32_t(first));
        for (size_t i = 0; i < block.size(); ++i)
            if (const CndLight& light = lights[first + i]; light.type == CND_LIGHT_POLYGON)
                identify(block[i], light, uint32_t(first + i), noPolygon);
        std::ranges::copy(block, staging.records.begin() + std::ptrdiff_t(first));
    }
}

void LightTable::add(std::span<const CndLight> lights, CndLightId* ids,
                     const Staging& staging) noexcept
{
    for (size_t i = 0; i < lights.size(); ++i) {
        const uint32_t record = count();
        ids[i] = ids_.add(record);
        const uint32_t slot = gpu::IdTable::slotOf(ids[i]);
        places_.push_back({slot, UINT32_MAX});
        packLights(lights.subspan(i, 1), {&records_.emplace_back(), 1});
        identify(records_.back(), lights[i], slot, noPolygon);
        stage(record, staging);
    }
}

void LightTable::update(std::span<const CndLightId> ids, std::span<const CndLight> lights,
                        const Staging& staging) noexcept
{
    for (size_t first = 0; first < ids.size(); first += tableBlock) {
        const size_t count = std::min(tableBlock, ids.size() - first);
        struct {
            uint32_t record, polygon;
        } edits[tableBlock];
        for (size_t i = 0; i < count; ++i) {
            const uint32_t record = recordOf(ids[first + i]);
            edits[i] = {record, polygonOf(record)};
        }
        for (size_t i = 0; i < count; ++i) {
            const auto [record, polygon] = edits[i];
            packLights(lights.subspan(first + i, 1), {&records_[record], 1});
            identify(records_[record], lights[first + i], gpu::IdTable::slotOf(ids[first + i]),
                     polygon);
        }
        for (size_t i = 0; i < count; ++i)
            stage(edits[i].record, staging);
    }
}

void LightTable::remove(std::span<const CndLightId> ids, const Staging& staging) noexcept
{
    for (const CndLightId id : ids)
        remove(gpu::IdTable::slotOf(id), staging);
}

void LightTable::remove(uint32_t slot, const Staging& staging) noexcept
{
    const uint32_t record = ids_.place(slot), last = count() - 1;
    if (const uint32_t polygon = polygonOf(record); polygon != noPolygon)
        polygons_.remove(polygon);
    if (record != last) {
        records_[record] = records_[last];
        places_[record].slot = places_[last].slot;
        ids_.place(places_[record].slot) = record;
        stage(record, staging);
    }
    if (isStaged(last)) { // another one takes its place among the staged
        const uint32_t at = places_[last].staged, moved = staged_.back();
        staged_.pop_back();
        if (moved != last)
            stageAt(at, moved, staging);
    }
    records_.pop_back();
    places_.pop_back();
    ids_.remove(slot);
}

LightTable::Upload LightTable::take() noexcept
{
    const Upload upload{all_ ? count() : uint32_t(staged_.size()), all_};
    staged_.clear();
    all_ = false;
    return upload;
}

void LightTable::stageAnew(const Staging& staging) const noexcept
{
    if (all_)
        std::ranges::copy(records_, staging.records.begin());
    for (size_t at = 0; at < staged_.size(); ++at) {
        staging.places[at] = staged_[at];
        staging.records[at] = records_[staged_[at]];
    }
}

LightExtent LightTable::extent() const noexcept
{
    constexpr size_t samples = 1024;
    constexpr double outer = 0.02; // share of the lights that is left out at either end
    const size_t step = records_.size() / samples + 1;
    LightExtent extent;
    float longest = 0;
    std::array<float, samples> along;
    std::array<float, size_t(outer * samples) + 1> ends;
    const auto sample = [&](auto&& value) {
        size_t n = 0;
        for (size_t i = 0; i < records_.size(); i += step)
            if (!isDistant(typeOfRecord(uint32_t(i))))
                along[n++] = value(records_[i]);
        return n;
    };
    for (int axis = 0; axis < 3; ++axis) {
        const size_t n = sample([&](const gpu::LightRecord& r) { return r.position[axis]; });
        if (!n)
            return extent;
        const size_t cut = size_t(outer * double(n));
        // Returns the value before which `cut` others are in this order.
        const auto end = [&](auto&& order) {
            std::partial_sort_copy(along.begin(), along.begin() + n, ends.begin(),
                                   ends.begin() + cut + 1, order);
            return ends[cut];
        };
        const float low = end(std::less<>()), high = end(std::greater<>());
        const float border = (high - low) / 8; // room for lights beyond the sampled ones
        extent.low[axis] = low - border;
        longest = std::max(longest, high - low + 2 * border);
    }
    const size_t n = sample([](const gpu::LightRecord& r) { return r.influenceRadius; });
    std::nth_element(along.begin(), along.begin() + n / 2, along.begin() + n);
    extent.influenceRadius = along[n / 2];
    constexpr float shortest = 1e-15f; // the shortest length that CndLight allows
    extent.size = std::max(longest, shortest);
    return extent;
}

} // namespace candelabra::lighting
