// SPDX-License-Identifier: Apache-2.0
// The instances of occluders as one view sees them, which prepare_occluders writes.
#pragma once

#include "gpu/recordings.h"
#include "occluders/instance_table.h"

namespace candelabra::lighting
{

class PreparedOccluders
{
public:
    using Kernel = gpu::Kernel<gpu::PrepareOccludersParams>;
    static Kernel createKernel(const gpu::Device& device);

    // `slots`: the number of frame slots. All arguments must outlive this object.
    PreparedOccluders(const gpu::Device& device, gpu::Recordings& recordings, const Kernel& kernel,
                      uint32_t slots)
        : device_(device),
          recordings_(recordings),
          kernel_(kernel),
          bindings_(kernel.createBindings(slots))
    {
    }

    // Makes room for so many records. Throws gpu::Failure and then leaves everything as it was.
    void makeRoom(uint32_t places);

    // Records the kernel, if there are occluders, for the view of a camera (CndCamera). The caller
    // puts barriers before and after.
    void record(const gpu::Frame& frame, const InstanceTable& instances,
                const double (&viewFromWorld)[16]) const noexcept;

    const gpu::Buffer& buffer() const { return instances_; } // gpu::OccluderInstance, by place

private:
    const gpu::Device& device_;
    gpu::Recordings& recordings_;
    const Kernel& kernel_;
    gpu::Bindings bindings_;
    gpu::Buffer instances_;
};

} // namespace candelabra::lighting
