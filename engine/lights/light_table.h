// SPDX-License-Identifier: Apache-2.0
// The host's lights as the CPU keeps them: which record belongs to which light id, and which
// records must still be copied to the device. Records are dense and unsorted, because the device
// sorts them. When a light is removed, the last record takes the place of its record.
#pragma once

#include <span>
#include <vector>

#include "candelabra/candelabra.h"
#include "lights/light_order.h"
#include "lights/polygon_table.h"
#include "shared/lighting.h"

namespace candelabra::lighting
{

// Size of a light on the device.
inline constexpr VkDeviceSize recordBytes = sizeof(gpu::LightRecord);

class LightTable
{
public:
    // `polygons` must outlive the table, which keeps the polygons of its lights there.
    explicit LightTable(PolygonTable& polygons) : polygons_(polygons) {}

    // Allocates the memory that the noexcept functions below need, apart from that of the polygons:
    // for a set of `count` lights, or for `edits` edits, of which `added` add a light.
    void reserveSet(size_t count);
    void reserveEdits(size_t edits, size_t added);
    // Throws gpu::Failure naming `call` and an id that no light has, or that is given twice.
    void check(const char* call, std::span<const CndLightId> ids) const;

    // The records of the host's lights in the staging buffer from which edits are uploaded.
    using Records = std::span<gpu::LightRecord>;
    // Replaces all lights. Their indices become their ids, and all records are to be uploaded.
    void set(std::span<const CndLight> lights, Records staging) noexcept;
    CndLightId add(const CndLight& light, Records staging) noexcept;
    void update(CndLightId id, const CndLight& light, Records staging) noexcept;
    void remove(CndLightId id, Records staging) noexcept;

    uint32_t count() const { return uint32_t(lights_.size()); }
    uint32_t typeOf(CndLightId id) const { return lights_[recordOf_[slotOf(id)]].type; }
    // Estimates the extent from at most 1024 lights. It leaves out the outermost of these, so that
    // one far light does not make the grid coarse.
    LightExtent extent() const noexcept;

    // The copies that bring the device's records up to date: first the moves from record to record,
    // none of which overlap, then the uploads from the staging buffer to the same offset.
    struct Transfers {
        std::vector<VkBufferCopy> moves, uploads;
    };
    // Returns the transfers for all edits since the last call. `firstRecord`: index of the first
    // record of the host's lights.
    const Transfers& take(uint32_t firstRecord) noexcept;

private:
    // Special values of Light::source. Every other value is the index of the device's record that
    // is to be moved here.
    static constexpr uint32_t inPlace = UINT32_MAX, staged = UINT32_MAX - 1;
    struct Light {
        float position[3];
        float influenceRadius;
        uint32_t type;
        uint32_t slot;
        uint32_t source = inPlace;
        uint32_t polygon = noPolygon; // index in the table of polygons
    };
    static constexpr uint32_t noRecord = UINT32_MAX, noPolygon = UINT32_MAX;

    static uint32_t slotOf(CndLightId id) { return uint32_t(id); }
    static Light entry(const CndLight& light, uint32_t slot);
    bool isStaged(uint32_t record) const { return whole_ || lights_[record].source == staged; }
    void pack(uint32_t record, const CndLight& light, Records staging) noexcept;
    void writePolygon(uint32_t record, const CndPolygon& corners, Records staging) noexcept;
    void forgetPolygon(uint32_t record) noexcept;
    void touch(uint32_t record, uint32_t source) noexcept;
    void forgetDuplicates() noexcept;

    PolygonTable& polygons_;
    std::vector<Light> lights_;         // indexed by record
    std::vector<uint32_t> recordOf_;    // indexed by slot, which is the low half of an id
    std::vector<uint32_t> generations_; // indexed by slot: the high half of the id
    std::vector<uint32_t> freeSlots_;
    std::vector<uint32_t> touched_; // every record whose source is not inPlace, and some others
    bool whole_ = false;            // the staging buffer holds every record
    uint32_t generation_ = 0;       // generation of the light added last
    Transfers transfers_;
};

} // namespace candelabra::lighting
