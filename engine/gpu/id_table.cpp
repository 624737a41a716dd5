// SPDX-License-Identifier: Apache-2.0
#include "gpu/id_table.h"

#include <functional>

#include "gpu/failure.h"

namespace candelabra::gpu
{

std::string noneHasId(const char* kind, uint64_t id)
{
    return std::string("no ") + kind + " has the id " + std::to_string(id);
}

void IdTable::reserveAll(size_t count)
{
    places_.reserve(count);
    generations_.reserve(count);
}

void IdTable::reserve(size_t removed, size_t added)
{
    const size_t newSlots = added - std::min(added, freeSlots_.size());
    reserveMore(places_, newSlots);
    reserveMore(generations_, newSlots);
    reserveMore(freeSlots_, removed);
}

void IdTable::check(const char* call, const char* kind, std::span<const uint64_t> ids)
{
    for (const uint64_t id : ids)
        if (!has(id))
            failArgument(std::string(call) + ": " + noneHasId(kind, id));
    if (std::ranges::adjacent_find(ids, std::greater_equal<>()) == ids.end())
        return; // each is larger than the one before
    seen_.resize(places_.size());
    size_t different = 0;
    for (; different < ids.size() && !seen_[slotOf(ids[different])]; ++different)
        seen_[slotOf(ids[different])] = true;
    for (const uint64_t id : ids.first(different))
        seen_[slotOf(id)] = false;
    if (different < ids.size())
        failArgument(std::string(call) + ": the id " + std::to_string(ids[different]) +
                     " is given twice");
}

void IdTable::setAll(uint32_t count) noexcept
{
    freeSlots_.clear();
    places_.resize(count);
    generations_.assign(count, 0);
    for (uint32_t i = 0; i < count; ++i)
        places_[i] = i;
}

uint64_t IdTable::add(uint32_t place) noexcept
{
    uint32_t slot = slotCount();
    if (freeSlots_.empty()) {
        places_.push_back(place);
        generations_.push_back(0);
    } else {
        slot = freeSlots_.back();
        freeSlots_.pop_back();
        places_[slot] = place;
    }
    generation_ += generation_ == UINT32_MAX ? 2 : 1; // 0 is the generation of setAll()
    generations_[slot] = generation_;
    return uint64_t(generation_) << 32 | slot;
}

void IdTable::remove(uint32_t slot) noexcept
{
    places_[slot] = none;
    freeSlots_.push_back(slot);
}

} // namespace candelabra::gpu
