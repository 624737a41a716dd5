// SPDX-License-Identifier: Apache-2.0
// Which queue family owns which image of the host's, as barriers and dispatches are recorded: a
// function table between the modules and the driver books what the modules do. Families need only
// be declared: where the device has one family, what it gets is without transfers.
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
    // One at a time: Vulkan's function pointers carry no context. `real`: the device has the
    // families that command buffers and barriers name.
    Ownership(const CndDeviceDesc& host, bool real);
    ~Ownership();
    Ownership(const Ownership&) = delete;
    Ownership& operator=(const Ownership&) = delete;

    // For modules.
    const CndDeviceDesc& desc() const { return desc_; }

    // An image that nothing was recorded for.
    void add(VkImage image, VkImageView view) { views_[view] = image; }
    // What is recorded here goes to a queue of this family.
    void begin(VkCommandBuffer cmd, uint32_t family) { families_[cmd] = family; }
    // Barriers of the host's, recorded. Two families that differ: released by the first of these,
    // then acquired by the second. From VK_IMAGE_LAYOUT_UNDEFINED: whoever had it, it is taken.
    void barrier(VkCommandBuffer cmd, std::span<const VkImageMemoryBarrier2> barriers);
    // Recording of modules: by other rules than the host's.
    template <typename Record>
    void module(Record&& record)
    {
        inModule_ = true;
        std::forward<Record>(record)();
        inModule_ = false;
    }
    bool isOwner(VkImage image, uint32_t family) const;

    std::set<VkImage> touched;       // by dispatches of modules
    std::set<std::string> called;    // by modules while recording
    std::vector<std::string> faults; // of modules and of the host

    // Of the function table.
    void onCall(const char* function);
    void onModuleBarrier(const VkDependencyInfo& info);
    void onWrite(const VkWriteDescriptorSet& write);
    void onBind(VkCommandBuffer cmd, VkDescriptorSet set) { bound_[cmd] = set; }
    void onDispatch(VkCommandBuffer cmd);

private:
    struct Image {
        uint32_t owner = VK_QUEUE_FAMILY_IGNORED;
        VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
        bool released = false; // and not yet acquired
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
    std::map<VkImageView, VkImage> views_; // of the host's
    std::map<VkImage, Image> images_;
    std::map<VkCommandBuffer, uint32_t> families_;
    std::map<VkCommandBuffer, VkDescriptorSet> bound_;
    std::map<VkDescriptorSet, std::map<uint32_t, Use>> sets_; // images by binding
};

} // namespace candelabra::test
