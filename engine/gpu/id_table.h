// SPDX-License-Identifier: Apache-2.0
// The ids of things that hosts add and remove. An id is never reused. Its low half is the index of
// a slot, which later things may use as well; its high half is the generation of this use.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace candelabra::gpu
{

// Makes room for `more` elements. The capacity grows by half at least, so that many small calls do
// not copy the vector each time.
template <typename T>
void reserveMore(std::vector<T>& v, size_t more)
{
    if (v.capacity() - v.size() < more)
        v.reserve(std::max(v.size() + more, v.capacity() + v.capacity() / 2));
}

// Names an element of an array that the host passed: its index and the id in it, such as "ids[3] is
// 17". `member`: what of the element is the id, such as ".mesh"; "": the element itself.
std::string elementIs(const char* array, size_t index, const char* member, uint64_t id);
// The sentence about an id that no `kind` has, such as "light". `element`: what elementIs()
// returns.
std::string noneHasId(const std::string& element, const char* kind);

class IdTable
{
public:
    static constexpr uint32_t none = UINT32_MAX;
    static uint32_t slotOf(uint64_t id) { return uint32_t(id); }

    // Allocates the memory that the noexcept functions below need: for setAll(), or for add() and
    // remove().
    void reserveAll(size_t count);
    void reserve(size_t removed, size_t added);
    bool has(uint64_t id) const
    {
        const uint32_t slot = slotOf(id);
        return slot < places_.size() && places_[slot] != none &&
               generations_[slot] == uint32_t(id >> 32);
    }
    // Throws Failure naming `call` and an id that no `kind` has, such as "light of the set", or
    // that is given twice. `array`, `member`: where the host passed the ids (elementIs).
    void check(const char* call, const char* kind, std::span<const uint64_t> ids,
               const char* array = "ids", const char* member = "");

    // Forgets all ids. Ids 0, 1 ... are in use then, at the places of the same numbers.
    void setAll(uint32_t count) noexcept;
    uint64_t add(uint32_t place) noexcept; // returns the new id
    void remove(uint32_t slot) noexcept;

    // Where the thing is that has this slot. The owner of the table keeps it up to date.
    uint32_t& place(uint32_t slot) { return places_[slot]; }
    uint32_t place(uint32_t slot) const { return places_[slot]; }
    uint32_t slotCount() const { return uint32_t(places_.size()); }

private:
    std::vector<uint32_t> places_;      // indexed by slot; none: the slot is free
    std::vector<uint32_t> generations_; // indexed by slot: the high half of the id
    std::vector<uint32_t> freeSlots_;
    std::vector<bool> seen_;  // used by check(); indexed by slot; false between calls
    uint32_t generation_ = 0; // generation of the thing added last
};

} // namespace candelabra::gpu
