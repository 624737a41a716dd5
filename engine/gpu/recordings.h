// SPDX-License-Identifier: Apache-2.0
// Recordings of a module: which of them the device may still have to run, and what must stay alive
// until it has. A recording is one call of a record function for one frame slot of one view.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gpu/kernel.h"

namespace candelabra::gpu
{

class RecordingSlots;

// Tells whether the device has written `value` to `marker`, in memory of the host, as the last
// command of a recording. If so, the host's later reads see what the commands before it wrote:
// neither the compiler nor the processor moves a read across this one.
inline bool hasArrived(uint32_t& marker, uint32_t value)
{
    return std::atomic_ref(marker).load(std::memory_order_acquire) == value;
}

// The recordings of all views of a module, numbered from 1 in the order in which they are made.
class Recordings
{
public:
    Recordings() = default;
    Recordings(const Recordings&) = delete; // RecordingSlots refer to it
    Recordings& operator=(const Recordings&) = delete;

    // Number of the oldest recording whose commands have not all run: what older ones read may be
    // overwritten. One more than the last number when every recording has run.
    uint64_t oldestRunning() const;
    // Number of the oldest recording that the host has not promised to be finished (it promises
    // that by recording the slot again): what older ones use may be destroyed. One more than the
    // last number when there is none.
    uint64_t oldestPending() const;

    // Keeps `object` alive until all recordings made so far are finished.
    void retire(std::shared_ptr<void> object) { retired_.push_back({std::move(object), last_}); }
    // Gives `old` the value `with` and keeps the old value alive until all recordings made so far
    // are finished.
    template <typename T>
    void replace(T& old, T&& with)
    {
        replaceUntil(last_, old, std::move(with));
    }
    // The same for a value that the next recording may use as well.
    template <typename T>
    void replaceAfterNext(T& old, T&& with)
    {
        replaceUntil(last_ + 1, old, std::move(with));
    }
    // Destroys what was kept for recordings that are finished now.
    void freeRetired();

private:
    friend class RecordingSlots;
    struct Retired {
        std::shared_ptr<void> object;
        uint64_t lastUser; // number of the last recording that may use it
    };
    template <typename T>
    void replaceUntil(uint64_t lastUser, T& old, T&& with)
    {
        retired_.push_back({nullptr, lastUser}); // first: when it fails, `old` may be in use
        retired_.back().object = std::make_shared<T>(std::move(old));
        old = std::move(with);
    }
    uint64_t oldest(uint64_t (RecordingSlots::*ofView)() const) const;

    std::vector<const RecordingSlots*> views_;
    std::vector<Retired> retired_;
    uint64_t last_ = 0; // number of the recording made last
};

// The frame slots of one view: which recording each holds, and a buffer per slot in which the host
// finds what the recording has counted. The device writes the number of the recording last of all
// into that buffer, so that the host can see that every command of it has run.
class RecordingSlots
{
public:
    // `name` and `readBytes` are the debug name and the size in bytes of the buffers that are read
    // back. `recordings` and `device` must outlive this object.
    RecordingSlots(Recordings& recordings, const Device& device, const std::string& name,
                   uint32_t count, VkDeviceSize readBytes);
    ~RecordingSlots() { std::erase(recordings_.views_, this); }
    RecordingSlots(const RecordingSlots&) = delete;
    RecordingSlots& operator=(const RecordingSlots&) = delete;

    uint32_t count() const { return uint32_t(slots_.size()); }
    // Begins a recording in a slot and returns its number. With it the host promises that the
    // recording that the slot held is finished.
    uint64_t begin(uint32_t slot) noexcept;
    // Copies `from`, which all commands of the recording have written, to the slot's buffer, and
    // marks the recording as run.
    void recordEnd(const Frame& frame, const Buffer& from) const noexcept;

    bool isUsed(uint32_t slot) const { return slots_[slot].recording != 0; }
    // Returns what the slot's recording has counted, or null until all its commands have run.
    template <typename T>
    const T* read(uint32_t slot) const
    {
        return hasRun(slot) ? &slots_[slot].readback.template as<T>()[0] : nullptr;
    }

private:
    friend class Recordings;
    // The same numbers as in Recordings, for this view alone; 0 when there is none.
    uint64_t oldestRunning() const;
    uint64_t oldestPending() const;
    bool hasRun(uint32_t slot) const;
    uint32_t& marker(uint32_t slot) const;

    struct Slot {
        Buffer readback;        // readBytes_, then the marker: the low half of a recording's number
        uint64_t recording = 0; // its number; 0: the slot was never used
    };

    Recordings& recordings_;
    VkDeviceSize readBytes_;
    std::vector<Slot> slots_;
};

} // namespace candelabra::gpu
