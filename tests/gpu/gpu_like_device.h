// SPDX-License-Identifier: Apache-2.0
// A device that the engine takes for a GPU. On llvmpipe the engine chooses other forms of some
// kernels (gpu::Device::lanesAreCpuVector); this makes it choose those that GPUs run, so that tests
// can compare both forms on the same device.
#pragma once

#include "candelabra/candelabra.h"

namespace candelabra::test
{

// Returns the host's device as one that is not a CPU. The engine then does not know that
// llvmpipe limits loops, so tests keep lists and walks far below 65535 steps. One such device may
// be in use at a time.
CndDeviceDesc gpuLike(const CndDeviceDesc& host);

} // namespace candelabra::test
