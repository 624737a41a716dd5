// SPDX-License-Identifier: Apache-2.0
// A device buffer whose contents the host keeps too, and of which only what has changed is copied
// to the device.
#pragma once

#include <list>
#include <vector>

#include "gpu/recordings.h"

namespace candelabra::gpu
{

class UploadedBuffer
{
public:
    // `name` is a literal. `capacity`: bytes for which to make room; with 0 there is no buffer
    // until the first reserve(). `texels`: whether it can also be bound as texels of four floats.
    // `device` and `recordings` must outlive this object.
    UploadedBuffer(const Device& device, Recordings& recordings, const char* name,
                   VkDeviceSize capacity, bool texels = false);

    // Makes room for contents of `bytes` bytes, and prepares the upload of `changed` more of them,
    // in `ranges` ranges. Throws Failure, and then leaves the contents as they were.
    void reserve(VkDeviceSize bytes, VkDeviceSize changed, size_t ranges);
    // Marks a range that reserve() was told of: the next recording uploads it.
    void markChanged(VkDeviceSize first, VkDeviceSize bytes) noexcept;

    bool isChanged() const { return changedBlocks_ != 0; }
    // Tells whether the next recording uploads some of a range.
    bool isChanged(VkDeviceSize first, VkDeviceSize bytes) const;
    // Records the upload of what has changed since the last recording. `contents` are all bytes
    // that are in use. `recording`: number of this recording. The caller puts barriers before and
    // after.
    void recordUpload(const Frame& frame, uint64_t recording,
                      std::span<const std::byte> contents) noexcept;

    const Buffer& buffer() const { return buffer_; } // of size 0 before the first reserve()

private:
    struct Staging {
        Buffer buffer;
        uint64_t recording = 0; // number of the recording that copies from it; 0: none yet
    };
    Buffer create(VkDeviceSize bytes) const;
    void prepareStaging(VkDeviceSize bytes, VkDeviceSize most);
    void retireUnused();

    const Device& device_;
    Recordings& recordings_;
    const char* name_;
    bool texels_;
    Buffer buffer_;
    std::vector<uint8_t> changed_; // by block: 1 if something in it has changed
    size_t changedBlocks_ = 0;
    std::list<Staging> staging_; // a list does not move its elements
    Staging* pending_ = nullptr; // takes the next upload
};

} // namespace candelabra::gpu
