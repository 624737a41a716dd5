// SPDX-License-Identifier: Apache-2.0
// The part of a light set that the host left on the device (CndDeviceLights).
#pragma once

#include <memory>

#include "candelabra/candelabra.h"
#include "gpu/kernel.h"
#include "lights/light_order.h"
#include "shared/device_light_data.h"

namespace candelabra::lighting
{

// Throws gpu::Failure naming the first field outside its documented range.
void checkDeviceLights(const gpu::Device& device, const CndDeviceLights& lights);

// Returns the extent of the host's lights and the device's lights together. `placed`: how many of
// the host's lights have a position.
LightExtent extentWith(const LightExtent& host, size_t placed, const CndDeviceLights& device);

class DeviceLights
{
public:
    explicit DeviceLights(const gpu::Device& device); // must outlive it

    // Returns new descriptors, to be given to take(), or null if the present ones already name the
    // buffers of `lights`. `newRecords`: take() will be given another buffer of records.
    std::shared_ptr<gpu::Bindings> prepare(const CndDeviceLights& lights, bool newRecords) const;
    // The descriptors in use. The caller keeps them alive while recordings use them.
    const std::shared_ptr<gpu::Bindings>& bindings() const { return bindings_; }
    // Takes the device's lights of a new set, which will fill the first records. `bindings`: what
    // prepare() returned.
    void take(const CndDeviceLights& lights, const gpu::Buffer& records,
              std::shared_ptr<gpu::Bindings> bindings);
    void takeNone() { present_ = false; }
    // Call it when the buffer of records has been replaced: the descriptors name the old one.
    void forgetBindings() { bindings_ = nullptr; }
    bool present() const { return present_; }
    const CndDeviceLights& lights() const { return lights_; } // valid if present()

    // Clears the counts. The caller puts a barrier between this and record().
    void recordReset(const gpu::Frame& frame) const noexcept;
    // Fills the records of the device's lights and counts them.
    void record(const gpu::Frame& frame) const noexcept;
    const gpu::Buffer& counts() const { return counts_; } // gpu::DeviceLightCounts

private:
    void write(const CndDeviceLights& lights, const gpu::Buffer& records) const;

    gpu::Kernel<gpu::DeviceLightsParams> kernel_;
    gpu::Buffer counts_;
    std::shared_ptr<gpu::Bindings> bindings_;
    CndDeviceLights lights_{}; // the lights whose buffers bindings_ names
    bool present_ = false;
};

} // namespace candelabra::lighting
