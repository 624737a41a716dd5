// SPDX-License-Identifier: Apache-2.0
#include "occluders/prepared_occluders.h"

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "candelabra_shaders.h"
#include "gpu/double_single.h"

namespace candelabra::lighting
{

PreparedOccluders::Kernel PreparedOccluders::createKernel(const gpu::Device& device)
{
    return {device, spirv::prepare_occluders_comp};
}

void PreparedOccluders::makeRoom(uint32_t places)
{
    const VkDeviceSize bytes = places * VkDeviceSize(sizeof(gpu::OccluderInstance));
    if (bytes <= instances_.size)
        return;
    const VkDeviceSize most = device_.limits.maxStorageBufferRange;
    const VkDeviceSize wanted = std::min(most, instances_.size + instances_.size / 2);
    gpu::Buffer larger = gpu::createBuffer(device_, "occluder instances", std::max(bytes, wanted),
                                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                               VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                                               VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                           gpu::MemoryUse::Scratch);
    gpu::createTexelView(device_, larger);
    recordings_.replace(instances_, std::move(larger));
}

void PreparedOccluders::record(const gpu::Frame& frame, const InstanceTable& instances,
                               const double (&viewFromWorld)[16]) const noexcept
{
    if (!instances.count())
        return;
    const glm::dmat4 view = glm::make_mat4(viewFromWorld);
    const glm::dmat3 rotation(view);
    const gpu::DoubleSingle camera(glm::transpose(rotation) * -glm::dvec3(view[3]));
    bindings_.write(frame.slot,
                    {gpu::Binding::of(gpu::PREPARE_OCCLUDERS_RECORDS, instances.recordBuffer()),
                     gpu::Binding::of(gpu::PREPARE_OCCLUDERS_INSTANCES, instances_)});
    kernel_.dispatchInRows(frame, bindings_.set(frame.slot),
                           {.viewFromWorld = glm::mat3(rotation),
                            .cameraHi = camera.hi,
                            .cameraLo = camera.lo,
                            .count = instances.places()},
                           gpu::divideUp(instances.places(), gpu::PREPARE_OCCLUDERS_GROUP));
}

} // namespace candelabra::lighting
