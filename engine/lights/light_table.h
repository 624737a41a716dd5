// SPDX-License-Identifier: Apache-2.0
// The host's lights as the CPU keeps them: which record belongs to which light id, and which
// records must still be copied to the device. Records are dense and unsorted, because the device
// sorts them. When a light is removed, the last record takes the place of its record.
#pragma once

#include <span>
#include <vector>

#include "candelabra/candelabra.h"
#include "gpu/id_table.h"
#include "lights/light_order.h"
#include "lights/polygon_table.h"
#include "shared/lighting_data.h"

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
    // for a set of `count` lights, or for edits, of which `added` add a light.
    void reserveSet(size_t count);
    void reserveEdits(size_t removed, size_t added);
    // Throws gpu::Failure naming `call` and an id that no light has, or that is given twice.
    void check(const char* call, std::span<const CndLightId> ids)
    {
        ids_.check(call, "light of the set", ids);
    }

    // The memory in which records wait for their upload. It is written in order where many are
    // written, whole records at a time, and never read: it may be memory that the CPU does not
    // cache.
    struct Staging {
        std::span<gpu::LightRecord> records;
        std::span<uint32_t> places; // by staged record: the index of the host's record
    };
    // Replaces all lights. Their indices become their ids, and all records are staged.
    void set(std::span<const CndLight> lights, const Staging& staging) noexcept;
    void add(std::span<const CndLight> lights, CndLightId* ids, const Staging& staging) noexcept;
    void update(std::span<const CndLightId> ids, std::span<const CndLight> lights,
                const Staging& staging) noexcept;
    void remove(std::span<const CndLightId> ids, const Staging& staging) noexcept;

    uint32_t count() const { return uint32_t(records_.size()); }
    uint32_t typeOf(CndLightId id) const { return typeOfRecord(recordOf(id)); }
    // Estimates the extent from at most 1024 lights. It leaves out the outermost of these, so that
    // one far light does not make the grid coarse.
    LightExtent extent() const noexcept;

    // Every record is staged in order, or some are, whose places are in Staging::places.
    struct Upload {
        uint32_t records;
        bool all;
    };
    // Returns what has been staged since the last call, which is staged no longer.
    Upload take() noexcept;
    // Stages what is staged in another buffer too.
    void stageAnew(const Staging& staging) const noexcept;

private:
    static constexpr uint32_t noPolygon = UINT32_MAX;
    struct Place {
        uint32_t slot;
        uint32_t staged; // index among the staged records, if staged_ says so too
    };

    uint32_t recordOf(CndLightId id) const { return ids_.place(gpu::IdTable::slotOf(id)); }
    uint32_t typeOfRecord(uint32_t record) const
    {
        return records_[record].flags & gpu::LIGHT_TYPE_MASK;
    }
    // Returns the index of the record's polygon in the table of polygons, or noPolygon.
    uint32_t polygonOf(uint32_t record) const
    {
        return typeOfRecord(record) == CND_LIGHT_POLYGON ? records_[record].id : noPolygon;
    }
    bool isStaged(uint32_t record) const
    {
        const uint32_t at = places_[record].staged;
        return at < staged_.size() && staged_[at] == record;
    }
    void identify(gpu::LightRecord& packed, const CndLight& light, uint32_t slot,
                  uint32_t before) noexcept;
    void stage(uint32_t record, const Staging& staging) noexcept;
    void stageAt(uint32_t at, uint32_t record, const Staging& staging) noexcept;
    void remove(uint32_t slot, const Staging& staging) noexcept;

    PolygonTable& polygons_;
    std::vector<gpu::LightRecord> records_; // as the device has them after the next upload
    std::vector<Place> places_;             // indexed by record
    gpu::IdTable ids_;                      // whose places are records
    std::vector<uint32_t> staged_;          // the staged records, unless all are
    bool all_ = false;                      // all records are staged, in order
};

} // namespace candelabra::lighting
