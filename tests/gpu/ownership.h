// SPDX-License-Identifier: Apache-2.0
// Tracks which queue family owns which of the host's images, as barriers and dispatches are
// recorded: a function table between the modules and the driver notes what the modules do. Queue
// families may be fictitious: if the device has only one, the driver gets the barriers without
// ownership transfers.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "candelabra/candelabra.h"

namespace candelabra::test
{

class Ownership
{
public:
    // Only one may exist at a time, because Vulkan's function pointers carry no context. `real`:
    // the device has the families that command buffers and barriers name.
    Ownership(const CndDeviceDesc& host, bool real);
    ~Ownership();
    Ownership(const Ownership&) = delete;
    Ownership& operator=(const Ownership&) = delete;

    // The device description to create modules from.
    const CndDeviceDesc& desc() const { return desc_; }

    // Adds an image that no recording has used yet.
    void add(VkImage image, VkImageView view) { views_[view] = image; }
    // States the queue family to which `cmd` will be submitted.
    void begin(VkCommandBuffer cmd, uint32_t family) { families_[cmd] = family; }
    // Records barriers of the host. A barrier with two different families releases the image if it
    // is recorded for the source family, and acquires it if it is recorded for the destination
    // family. A barrier from VK_IMAGE_LAYOUT_UNDEFINED without a transfer takes the image from
    // its owner, whichever family that is.
    void barrier(VkCommandBuffer cmd, std::span<const VkImageMemoryBarrier2> barriers);
    // Runs code that records modules, to which other rules apply than to the host.
    template <typename Record>
    void module(Record&& record)
    {
        inModule_ = true;
        std::forward<Record>(record)();
        inModule_ = false;
    }
    bool isOwner(VkImage image, uint32_t family) const;

    std::set<VkImage> touched;       // images used by dispatches of modules
    std::set<std::string> called;    // functions called by modules while recording
    std::vector<std::string> faults; // rule violations of modules and of the host

    // Called by the function table.
    void onCall(const char* function);
    void onModuleBarrier(VkPipelineStageFlags stages,
                         std::span<const VkBufferMemoryBarrier> buffers,
                         std::span<const VkImageMemoryBarrier> images);
    void onWrite(const VkWriteDescriptorSet& write);
    void onBind(VkCommandBuffer cmd, VkDescriptorSet set) { bound_[cmd] = set; }
    void onDispatch(VkCommandBuffer cmd);

private:
    struct Image {
        uint32_t owner = VK_QUEUE_FAMILY_IGNORED;
        VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
        bool released = false; // released and not yet acquired
        VkImageMemoryBarrier2 release{};
    };
    struct Use {
        VkImageView view;
        VkImageLayout layout;
    };
    void apply(const VkImageMemoryBarrier2& barrier, uint32_t family);
    void fault(const std::string& what) { faults.push_back(what); }

    CndDeviceDesc desc_;
    bool real_;
    bool inModule_ = false;
    std::map<VkImageView, VkImage> views_; // views of the host's images
    std::map<VkImage, Image> images_;
    std::map<VkCommandBuffer, uint32_t> families_;
    std::map<VkCommandBuffer, VkDescriptorSet> bound_;
    std::map<VkDescriptorSet, std::map<uint32_t, Use>> sets_; // images by binding
};

} // namespace candelabra::test
