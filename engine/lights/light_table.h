// SPDX-License-Identifier: Apache-2.0
// The host's lights as this side knows them: which record each id has, and what must still reach
// the device for it. Records are dense and in no order of types: the device sorts them. The last
// one takes the place of one that is removed.
#pragma once

#include <span>
#include <vector>

#include "candelabra/candelabra.h"
#include "lights/light_order.h"
#include "shared/lighting.h"

namespace candelabra::lighting
{

class LightTable
{
public:
    // What is noexcept below needs room: for a set of so many lights, or so many edits, some of
    // which add lights.
    void reserveSet(size_t count);
    void reserveEdits(size_t edits, size_t added);
    // Throws gpu::Failure naming `call` and the first id that no light has, or that comes twice.
    void check(const char* call, std::span<const CndLightId> ids) const;

    // A set given whole: indices are ids, and all of it is to be uploaded.
    void set(std::span<const CndLight> lights) noexcept;
    // The records of the host's lights in the staging buffer that the edits will travel from.
    using Records = std::span<gpu::LightRecord>;
    CndLightId add(const CndLight& light, Records staging) noexcept;
    void update(CndLightId id, const CndLight& light, Records staging) noexcept;
    void remove(CndLightId id, Records staging) noexcept;

    uint32_t count() const { return uint32_t(lights_.size()); }
    uint32_t typeOf(CndLightId id) const { return lights_[recordOf_[slotOf(id)]].type; }
    // Estimated from at most 1024 lights; the outermost are left out, so that one far light does
    // not make the grid coarse.
    LightExtent extent() const noexcept;

    // What brings the device's records up to date: copies between records, none of which overlap,
    // then copies from the staging buffer, to the same place.
    struct Transfers {
        std::vector<VkBufferCopy> moves, uploads;
    };
    // Transfers of the edits since the last call. `firstRecord`: the first of the host's lights.
    const Transfers& take(uint32_t firstRecord) noexcept;

private:
    // Where a record comes from, besides the device's record of this index.
    static constexpr uint32_t inPlace = UINT32_MAX, staged = UINT32_MAX - 1;
    struct Light {
        float position[3];
        float influenceRadius;
        uint32_t type;
        uint32_t slot;
        uint32_t source = inPlace;
    };
    static constexpr uint32_t noRecord = UINT32_MAX;

    static uint32_t slotOf(CndLightId id) { return uint32_t(id); }
    static Light entry(const CndLight& light, uint32_t slot);
    bool isStaged(uint32_t record) const { return whole_ || lights_[record].source == staged; }
    void touch(uint32_t record, uint32_t source) noexcept;
    void forgetDuplicates() noexcept;

    std::vector<Light> lights_;         // by record
    std::vector<uint32_t> recordOf_;    // by slot, the low half of an id
    std::vector<uint32_t> generations_; // by slot, the high half
    std::vector<uint32_t> freeSlots_;
    std::vector<uint32_t> touched_; // records whose source is not inPlace, and some more
    bool whole_ = false;            // the staging buffer holds every record
    uint32_t generation_ = 0;       // of the light added last
    Transfers transfers_;
};

} // namespace candelabra::lighting
