// SPDX-License-Identifier: Apache-2.0
#include "gpu/uploaded_buffer.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace candelabra::gpu
{
namespace
{

// Blocks bound the number of copies that scattered changes need.
constexpr VkDeviceSize blockBytes = 4096;
constexpr VkDeviceSize smallestStaging = 16 * blockBytes;
// Staging that so many recordings have not used is freed by the next change.
constexpr uint64_t keptFor = 64;

VkDeviceSize blocksOf(VkDeviceSize bytes)
{
    return bytes / blockBytes + (bytes % blockBytes != 0);
}

} // namespace

UploadedBuffer::UploadedBuffer(const Device& device, Recordings& recordings, const char* name,
                               VkDeviceSize capacity, bool texels)
    : device_(device), recordings_(recordings), name_(name), texels_(texels)
{
    if (capacity) {
        buffer_ = create(capacity);
        changed_.resize(blocksOf(buffer_.size));
    }
}

Buffer UploadedBuffer::create(VkDeviceSize bytes) const
{
    constexpr VkDeviceSize texelBytes = 4 * sizeof(float);
    const VkBufferUsageFlags more = texels_ ? VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT : 0;
    const VkDeviceSize whole = texels_ ? (bytes + texelBytes - 1) / texelBytes * texelBytes : bytes;
    Buffer out =
        createBuffer(device_, name_, whole,
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                         VK_BUFFER_USAGE_TRANSFER_DST_BIT | more,
                     MemoryUse::Device);
    if (texels_)
        createTexelView(device_, out);
    return out;
}

void UploadedBuffer::reserve(VkDeviceSize bytes, VkDeviceSize changed, size_t ranges)
{
    const bool grows = bytes > buffer_.size;
    Buffer larger;
    if (grows) {
        const VkDeviceSize half = buffer_.size + buffer_.size / 2;
        const VkDeviceSize most =
            std::max<VkDeviceSize>(bytes, device_.limits.maxStorageBufferRange);
        larger = create(std::min(std::max(bytes, half), most));
        changed_.resize(blocksOf(larger.size));
    }
    const VkDeviceSize blocks =
        grows ? blocksOf(bytes) : changedBlocks_ + blocksOf(changed) + 2 * ranges;
    retireUnused();
    prepareStaging(std::min(blocks * blockBytes, bytes), grows ? larger.size : buffer_.size);
    if (grows) {
        recordings_.replace(buffer_, std::move(larger));
        markChanged(0, bytes);
    }
}

// Chooses staging that no recording in flight reads and that has room for so many bytes.
void UploadedBuffer::prepareStaging(VkDeviceSize bytes, VkDeviceSize most)
{
    if (pending_ && pending_->buffer.size >= bytes)
        return;
    const uint64_t running = recordings_.oldestRunning();
    for (Staging& staging : staging_)
        if (staging.recording < running && staging.buffer.size >= bytes) {
            pending_ = &staging;
            return;
        }
    // Many small changes before one recording double it, so that they do not allocate each time.
    const VkDeviceSize twice = std::max(smallestStaging, pending_ ? 2 * pending_->buffer.size : 0);
    staging_.push_back({createBuffer(device_, std::string(name_) + " staging",
                                     std::max(bytes, std::min(twice, most)),
                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload)});
    pending_ = &staging_.back();
}

void UploadedBuffer::retireUnused()
{
    const uint64_t running = recordings_.oldestRunning();
    for (auto staging = staging_.begin(); staging != staging_.end();)
        if (&*staging != pending_ && staging->recording + keptFor < running) {
            recordings_.replace(staging->buffer, Buffer());
            staging = staging_.erase(staging);
        } else {
            ++staging;
        }
}

void UploadedBuffer::markChanged(VkDeviceSize first, VkDeviceSize bytes) noexcept
{
    for (size_t block = first / blockBytes; block < blocksOf(first + bytes); ++block)
        changedBlocks_ += !std::exchange(changed_[block], uint8_t(1));
}

bool UploadedBuffer::isChanged(VkDeviceSize first, VkDeviceSize bytes) const
{
    const auto begin = changed_.begin() + std::ptrdiff_t(first / blockBytes);
    const auto end = changed_.begin() + std::ptrdiff_t(blocksOf(first + bytes));
    return isChanged() && std::find(begin, end, uint8_t(1)) != end;
}

void UploadedBuffer::recordUpload(const Frame& frame, uint64_t recording,
                                  std::span<const std::byte> contents) noexcept
{
    if (!isChanged())
        return;
    std::array<VkBufferCopy, 64> copies;
    uint32_t count = 0;
    VkDeviceSize staged = 0;
    const auto flush = [&] {
        if (count)
            device_.CmdCopyBuffer(frame.cmd, pending_->buffer.get(), buffer_.get(), count,
                                  copies.data());
        count = 0;
    };
    for (size_t block = 0; block < blocksOf(contents.size()); ++block) {
        if (!changed_[block])
            continue;
        const size_t first = block;
        while (block < changed_.size() && changed_[block])
            ++block;
        const VkDeviceSize at = first * blockBytes;
        const VkDeviceSize bytes = std::min<VkDeviceSize>(block * blockBytes, contents.size()) - at;
        std::memcpy(pending_->buffer.mapped + staged, contents.data() + at, bytes);
        copies[count++] = {staged, at, bytes};
        staged += bytes;
        if (count == copies.size())
            flush();
    }
    flush();
    std::fill(changed_.begin(), changed_.end(), uint8_t(0));
    changedBlocks_ = 0;
    pending_->recording = recording;
    pending_ = nullptr;
}

} // namespace candelabra::gpu
