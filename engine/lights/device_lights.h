// SPDX-License-Identifier: Apache-2.0
// The part of a light set that the host left on the device (CndDeviceLights).
#pragma once

#include <memory>

#include "candelabra/candelabra.h"
#include "gpu/kernel.h"
#include "lights/light_order.h"
#include "shared/device_lights.h"

namespace candelabra::lighting
{

// Throws gpu::Failure naming the first field outside its documented range.
void checkDeviceLights(const gpu::Device& device, const CndDeviceLights& lights);

// Where the lights of both parts lie. `placed`: lights of the host that have a place.
LightExtent extentWith(const LightExtent& host, size_t placed, const CndDeviceLights& device);

class DeviceLights
{
public:
    explicit DeviceLights(const gpu::Device& device); // must outlive it

    // Descriptors to be given to take(); none when those of the last call still hold, which they do
    // for the same buffers and records.
    std::shared_ptr<gpu::Bindings> prepare(const CndDeviceLights& lights, bool newRecords) const;
    // The descriptors in use. The caller keeps them alive while recordings use them.
    const std::shared_ptr<gpu::Bindings>& bindings() const { return bindings_; }
    // Takes the lights of a new set; they will fill the first of the records.
    void take(const CndDeviceLights& lights, const gpu::Buffer& records,
              std::shared_ptr<gpu::Bindings> bindings);
    void takeNone() { present_ = false; }
    // The records of the last call are replaced: its descriptors no longer hold.
    void forgetBindings() { bindings_ = nullptr; }
    bool present() const { return present_; }
    const CndDeviceLights& lights() const { return lights_; } // present()

    // Clears the counts; then, behind a barrier, fills the records of the device's lights.
    void recordReset(const gpu::Frame& frame) const noexcept;
    void record(const gpu::Frame& frame) const noexcept;
    const gpu::Buffer& counts() const { return counts_; } // gpu::DeviceLightCounts

private:
    void write(const CndDeviceLights& lights, const gpu::Buffer& records) const;

    gpu::Kernel<gpu::DeviceLightsParams> kernel_;
    gpu::Buffer counts_;
    std::shared_ptr<gpu::Bindings> bindings_;
    CndDeviceLights lights_{}; // of bindings_
    bool present_ = false;
};

} // namespace candelabra::lighting
