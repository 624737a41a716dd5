// SPDX-License-Identifier: Apache-2.0
#include "lights/light_table.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "gpu/failure.h"
#include "lights/light_types.h"
#include "lights/pack_lights.h"

namespace candelabra::lighting
{
namespace
{

// Makes room for `more` elements. The capacity grows by half at least, so that many small calls do
// not copy the vector each time.
template <typename T>
void reserveMore(std::vector<T>& v, size_t more)
{
    if (v.capacity() - v.size() < more)
        v.reserve(std::max(v.size() + more, v.capacity() + v.capacity() / 2));
}

std::string text(CndLightId id)
{
    return std::to_string(uint32_t(id)) + " (generation " + std::to_string(id >> 32) + ")";
}

// Adds the copy of one record: it extends the last region if it continues it, or is a new region.
void append(std::vector<VkBufferCopy>& regions, VkDeviceSize from, VkDeviceSize to) noexcept
{
    if (!regions.empty()) {
        VkBufferCopy& last = regions.back();
        if (last.srcOffset + last.size == from && last.dstOffset + last.size == to) {
            last.size += recordBytes;
            return;
        }
    }
    regions.push_back({from, to, recordBytes});
}

} // namespace

void LightTable::reserveSet(size_t count)
{
    lights_.reserve(count);
    recordOf_.reserve(count);
    generations_.reserve(count);
    transfers_.uploads.reserve(1);
}

void LightTable::reserveEdits(size_t edits, size_t added)
{
    reserveMore(lights_, added);
    const size_t newSlots = added - std::min(added, freeSlots_.size());
    reserveMore(recordOf_, newSlots);
    reserveMore(generations_, newSlots);
    reserveMore(freeSlots_, edits);
    if (touched_.size() > 2 * lights_.size() + 1024)
        forgetDuplicates();
    reserveMore(touched_, edits);
    for (std::vector<VkBufferCopy>* regions : {&transfers_.moves, &transfers_.uploads})
        if (regions->capacity() < touched_.capacity() + 1)
            regions->reserve(touched_.capacity() + 1);
}

// Lights that are added and removed between two recordings put the same records on the list many
// times. This makes the list anew, with each record once.
void LightTable::forgetDuplicates() noexcept
{
    touched_.clear();
    for (uint32_t record = 0; record < lights_.size(); ++record)
        if (lights_[record].source != inPlace)
            touched_.push_back(record);
}

void LightTable::check(const char* call, std::span<const CndLightId> ids) const
{
    for (const CndLightId id : ids)
        if (const uint32_t slot = slotOf(id); slot >= recordOf_.size() ||
                                              recordOf_[slot] == noRecord ||
                                              generations_[slot] != uint32_t(id >> 32))
            gpu::failArgument(std::string(call) + ": no light of the set has the id " + text(id));
    std::vector<CndLightId> sorted(ids.begin(), ids.end());
    std::sort(sorted.begin(), sorted.end());
    if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
        gpu::failArgument(std::string(call) + ": the id " + text(*twice) + " is given twice");
}

LightTable::Light LightTable::entry(const CndLight& light, uint32_t slot)
{
    const float* p = light.position;
    return {{p[0], p[1], p[2]}, light.influenceRadius, light.type, slot};
}

// Packs the light of a record, whose entry is already there.
void LightTable::pack(uint32_t record, const CndLight& light, Records staging) noexcept
{
    packLights({&light, 1}, staging.subspan(record), lights_[record].slot);
    if (light.type == CND_LIGHT_POLYGON)
        writePolygon(record, *light.polygon, staging);
}

// Writes the corners of a record that has been packed.
void LightTable::writePolygon(uint32_t record, const CndPolygon& corners, Records staging) noexcept
{
    Light& light = lights_[record];
    if (light.polygon == noPolygon)
        light.polygon = polygons_.add(corners, light.slot);
    else
        polygons_.update(light.polygon, corners, light.slot);
    staging[record].id = light.polygon;
}

void LightTable::forgetPolygon(uint32_t record) noexcept
{
    if (lights_[record].polygon != noPolygon)
        polygons_.remove(lights_[record].polygon);
    lights_[record].polygon = noPolygon;
}

void LightTable::set(std::span<const CndLight> lights, Records staging) noexcept
{
    packLights(lights, staging);
    polygons_.clear();
    lights_.clear();
    recordOf_.clear();
    freeSlots_.clear();
    touched_.clear();
    for (uint32_t i = 0; i < lights.size(); ++i) {
        lights_.push_back(entry(lights[i], i));
        recordOf_.push_back(i);
        if (lights[i].type == CND_LIGHT_POLYGON)
            writePolygon(i, *lights[i].polygon, staging);
    }
    generations_.assign(lights.size(), 0);
    whole_ = true;
}

void LightTable::touch(uint32_t record, uint32_t source) noexcept
{
    if (whole_)
        return;
    if (lights_[record].source == inPlace)
        touched_.push_back(record);
    lights_[record].source = source;
}

CndLightId LightTable::add(const CndLight& light, Records staging) noexcept
{
    const uint32_t record = count();
    uint32_t slot = uint32_t(recordOf_.size());
    if (freeSlots_.empty()) {
        recordOf_.push_back(record);
        generations_.push_back(0);
    } else {
        slot = freeSlots_.back();
        freeSlots_.pop_back();
        recordOf_[slot] = record;
    }
    generation_ += generation_ == UINT32_MAX ? 2 : 1; // 0 is the generation of lights set whole
    generations_[slot] = generation_;
    lights_.push_back(entry(light, slot));
    touch(record, staged);
    pack(record, light, staging);
    return CndLightId(generation_) << 32 | slot;
}

void LightTable::update(CndLightId id, const CndLight& light, Records staging) noexcept
{
    const uint32_t record = recordOf_[slotOf(id)];
    touch(record, staged);
    if (light.type != CND_LIGHT_POLYGON)
        forgetPolygon(record);
    Light& at = lights_[record];
    std::copy_n(light.position, 3, at.position);
    at.influenceRadius = light.influenceRadius;
    at.type = light.type;
    pack(record, light, staging);
}

void LightTable::remove(CndLightId id, Records staging) noexcept
{
    const uint32_t slot = slotOf(id), record = recordOf_[slot], last = count() - 1;
    forgetPolygon(record);
    if (record != last) {
        // The light of the last record moves here, with the source of that record. Moves never read
        // a record that a move writes: they write below the smallest count that the table has had
        // since the last transfers and read from there on. Records added since are staged.
        const uint32_t from = lights_[last].source == inPlace ? last : lights_[last].source;
        if (isStaged(last))
            staging[record] = staging[last];
        touch(record, from);
        const uint32_t source = lights_[record].source;
        lights_[record] = lights_[last];
        lights_[record].source = source;
        recordOf_[lights_[record].slot] = record;
    }
    lights_.pop_back();
    recordOf_[slot] = noRecord;
    freeSlots_.push_back(slot);
}

LightExtent LightTable::extent() const noexcept
{
    constexpr size_t samples = 1024;
    constexpr double outer = 0.02; // share of the lights that is left out at either end
    const size_t step = lights_.size() / samples + 1;
    LightExtent extent;
    float longest = 0;
    std::array<float, samples> along;
    const auto sample = [&](auto&& value) {
        size_t n = 0;
        for (size_t i = 0; i < lights_.size(); i += step)
            if (!isDistant(lights_[i].type))
                along[n++] = value(lights_[i]);
        return n;
    };
    for (int axis = 0; axis < 3; ++axis) {
        const size_t n = sample([&](const Light& light) { return light.position[axis]; });
        if (!n)
            return extent;
        std::sort(along.begin(), along.begin() + n);
        const size_t cut = size_t(outer * double(n));
        const float low = along[cut], high = along[n - 1 - cut];
        const float border = (high - low) / 8; // room for lights beyond the sampled ones
        extent.low[axis] = low - border;
        longest = std::max(longest, high - low + 2 * border);
    }
    const size_t n = sample([](const Light& light) { return light.influenceRadius; });
    std::nth_element(along.begin(), along.begin() + n / 2, along.begin() + n);
    extent.influenceRadius = along[n / 2];
    constexpr float shortest = 1e-15f; // the shortest length that CndLight allows
    extent.size = std::max(longest, shortest);
    return extent;
}

const LightTable::Transfers& LightTable::take(uint32_t firstRecord) noexcept
{
    auto& [moves, uploads] = transfers_;
    moves.clear();
    uploads.clear();
    const VkDeviceSize first = firstRecord * recordBytes;
    if (whole_ && !lights_.empty())
        uploads.push_back({first, first, lights_.size() * recordBytes});
    whole_ = false;
    for (const uint32_t record : touched_) {
        if (record >= lights_.size() || lights_[record].source == inPlace)
            continue; // the record no longer exists, or its copy is already on the list
        const uint32_t source = std::exchange(lights_[record].source, inPlace);
        const VkDeviceSize to = first + record * recordBytes;
        if (source == staged)
            append(uploads, to, to);
        else
            append(moves, first + source * recordBytes, to);
    }
    touched_.clear();
    return transfers_;
}

} // namespace candelabra::lighting
