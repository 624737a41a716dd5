// SPDX-License-Identifier: Apache-2.0
// A host of the occluders alone, without the lighting module: it records their upload and
// prepare_occluders, and walks the trees that the device would walk.
#pragma once

#include <memory>

#include "harness/occluder_walk.h"
#include "occluders/occluder_set.h"
#include "occluders/prepared_occluders.h"

namespace candelabra::test
{

// A triangle that a segment crosses. The surface error tells instances apart.
using Crossing = std::tuple<float, float, float>;

struct OccluderHost {
    static constexpr uint32_t slotCount = 3;

    const gpu::Device& device;
    gpu::Recordings recordings;
    gpu::Timer timer; // disabled
    gpu::Buffer counters;
    gpu::RecordingSlots slots;
    lighting::PreparedOccluders::Kernel kernel;
    lighting::PreparedOccluders prepared;
    lighting::OccluderSet set;
    uint32_t slot = 0; // of the recording made last

    explicit OccluderHost(const gpu::Device& d, uint32_t triangles = 0, uint32_t instances = 0)
        : device(d),
          counters(
              gpu::createBuffer(d, "counters", 16,
                                VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                gpu::MemoryUse::Device)),
          slots(recordings, d, "occluder test", slotCount, 16),
          kernel(lighting::PreparedOccluders::createKernel(d)),
          prepared(d, recordings, kernel, slotCount),
          set(d, recordings, triangles, instances,
              [this](uint32_t places) { prepared.makeRoom(places); })
    {
    }

    // Records one frame in the next slot, whose last recording has finished.
    void record(VkCommandBuffer cmd, const double (&viewFromWorld)[16])
    {
        slot = (slot + 1) % slotCount;
        const uint64_t recording = slots.begin(slot);
        const gpu::Frame frame{device, cmd, timer, slot};
        frame.barrier();
        set.recordUpload(frame, recording);
        frame.barrier();
        set.recordRefit(frame, recording);
        prepared.record(frame, set.instances(), viewFromWorld);
        frame.barrier();
        slots.recordEnd(frame, counters);
    }

    // Returns what a segment in the world crosses, as the two trees find it after a recording.
    std::vector<Crossing> crossed(const Segment& s, uint32_t layers) const
    {
        std::vector<Crossing> out;
        const lighting::InstanceTable& instances = set.instances();
        const Segment relative{s.from - instances.origin(), s.to - instances.origin()};
        walkTree(instances.nodes(), relative, [&](uint32_t place) {
            const gpu::OccluderRecord& record = instances.records()[place];
            if (!(record.flags & layers))
                return;
            const glm::dmat3 inverse = glm::inverse(glm::dmat3(record.worldFromLocal));
            const glm::dvec3 position =
                glm::dvec3(record.positionHi) + glm::dvec3(record.positionLo);
            const Segment local{inverse * (s.from - position), inverse * (s.to - position)};
            const auto nodes = set.meshes().allNodes().subspan(record.firstNode);
            const auto triangles = set.meshes().allTriangles().subspan(record.firstTriangle);
            walkTree(nodes, local, [&](uint32_t i) {
                if (crosses(local, triangles[i]))
                    out.push_back({record.surfaceError, triangles[i].corners[0].x,
                                   triangles[i].corners[1].y});
            });
        });
        std::ranges::sort(out);
        return out;
    }
};

} // namespace candelabra::test
