// SPDX-License-Identifier: Apache-2.0
// The corners of the polygon lights: which of them are in use, and how they reach the device. The
// record of a light holds the index of its polygon here, so a polygon stays at its index while the
// records of lights move. Without polygons this has no memory.
#pragma once

#include <deque>
#include <vector>

#include "candelabra/lights.h"
#include "gpu/recordings.h"
#include "shared/lighting_data.h"

namespace candelabra::lighting
{

class PolygonTable
{
public:
    // `device` and `recordings` must outlive this object.
    PolygonTable(const gpu::Device& device, gpu::Recordings& recordings)
        : device_(device), recordings_(recordings)
    {
    }

    // Allocates what the noexcept functions below need to write polygons, of which `added` are new.
    // Throws gpu::Failure and then leaves the table as it was.
    void reserve(size_t written, size_t added);
    // The same for `count` polygons that replace all that are there.
    void reserveSet(size_t count);

    void clear() noexcept;
    uint32_t add(const CndLight& light, uint32_t id) noexcept; // returns its index
    void update(uint32_t index, const CndLight& light, uint32_t id) noexcept;
    void remove(uint32_t index) noexcept { free_.push_back(index); }

    // Tells whether there are polygons that no recording has uploaded yet.
    bool isChanged() const { return changedFirst_ < changedEnd_; }
    // Records the upload of the polygons that have changed since the last recording, whose number
    // is `recording`. The caller puts barriers before and after.
    void recordUpload(const gpu::Frame& frame, uint64_t recording) noexcept;

    // Returns a buffer of gpu::PolygonRecord, or null if there never was a polygon.
    const gpu::Buffer* buffer() const { return store_.buffer.size ? &store_.buffer : nullptr; }

private:
    struct Staging {
        gpu::Buffer buffer;
        uint64_t recording = 0; // number of the recording that copies from it; 0: none yet
    };
    // The buffers, which have the same size.
    struct Store {
        gpu::Buffer buffer;
        std::deque<Staging> staging; // a deque does not move its elements when it grows
    };
    void makeRoom(size_t count);
    void changed(uint32_t first, uint32_t end) noexcept;
    Staging createStaging(size_t capacity) const;

    const gpu::Device& device_;
    gpu::Recordings& recordings_;
    std::vector<gpu::PolygonRecord> polygons_; // by index, those not in use included
    std::vector<uint32_t> free_;               // indices that are not in use
    // The indices of all changed polygons are in this range.
    uint32_t changedFirst_ = UINT32_MAX, changedEnd_ = 0;
    Store store_;
    Staging* pending_ = nullptr; // takes the next upload
};

} // namespace candelabra::lighting
