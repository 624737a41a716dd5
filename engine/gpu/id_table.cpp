// SPDX-License-Identifier: Apache-2.0
#include "gpu/id_table.h"

#include <functional>

#include "gpu/failure.h"

namespace candelabra::gpu
{

std::string elementIs(const char* array, size_t index, const char* member, uint64_t id)
{
    return std::string(array) + "[" + std::to_string(index) + "]" + member + " is " +
           std::to_string(id);
}

std::string noneHasId(const std::string& element, const char* kind)
{
    return element + ", the id of no " + kind;
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

void IdTable::check(const char* call, const char* kind, std::span<const uint64_t> ids,
                    const char* array, const char* member)
{
    for (size_t i = 0; i < ids.size(); ++i)
        if (!has(ids[i]))
            failArgument(std::string(call) + ": " +
                         noneHasId(elementIs(array, i, member, ids[i]), kind));
    if (std::ranges::adjacent_find(ids, std::greater_equal<>()) == ids.end())
        return; // each is larger than the one before
    seen_.resize(places_.size());
    size_t different = 0;
    for (; different < ids.size() && !seen_[slotOf(ids[different])]; ++different)
        seen_[slotOf(ids[different])] = true;
    for (const uint64_t id : ids.first(different))
        seen_[slotOf(id)] = false;
    if (different == ids.size())
        return;
    const auto first = std::ranges::find(ids, ids[different]) - ids.begin();
    failArgument(std::string(call) + ": " + elementIs(array, different, member, ids[different]) +
                 ", and so is " + array + "[" + std::to_string(first) + "]" + member);
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
