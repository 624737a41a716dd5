// SPDX-License-Identifier: Apache-2.0
// A host with a G-buffer of its own: surfaces packed on the CPU as a CndGBufferDesc says, and the
// same surfaces, as they come out of that packing, for the FULL layout.
#pragma once

#include "gpu/environment_harness.h"

namespace candelabra::test
{

// View space.
struct HostSurface {
    glm::dvec3 normal{0, 0, 1};
    double perceptualRoughness = 0.5, metalness = 0;
    glm::dvec3 baseColour{0.5};
};

struct HostPixels {
    CndGBufferDesc desc{};
    uint32_t width = 0, height = 0;
    std::vector<std::byte> images[3]; // normalRoughness, albedo, specular
    std::vector<std::byte> depth;
    CpuGBuffer asFull;    // of what shaders read
    CpuGBuffer unrounded; // of what went in, but for depth
};

// Formats of `desc` are given. No more than one of the surfaces is built at a time.
class HostPacking
{
public:
    HostPacking(const CndGBufferDesc& desc, uint32_t width, uint32_t height,
                const CndCamera& camera, float clearDepth);
    // The next pixel, in rows from the top.
    void add(const HostSurface& surface, double depth);
    const HostPixels& pixels() const { return out_; }

private:
    HostPixels out_;
    glm::dmat3 storedFromView_; // of normals
};

// One texel of a colour format; returns what a shader reads of it.
glm::dvec4 appendTexel(std::vector<std::byte>& out, VkFormat format, const glm::dvec4& value);
double appendDepth(std::vector<std::byte>& out, VkFormat format, double depth);

class HostGBufferTest : public EnvironmentTest
{
protected:
    struct HostImages {
        gpu::Image colour[3], depth;
    };
    HostImages uploadHost(const HostPixels& pixels);
    // The frame of `full` with the images of the host.
    template <typename Frame>
    static Frame withHost(Frame frame, const HostImages& images)
    {
        frame.normalRoughness = images.colour[0].view.get();
        frame.albedo = images.colour[1].view.get();
        frame.specular = images.colour[2].view.get();
        frame.depth = images.depth.view.get();
        return frame;
    }
};

} // namespace candelabra::test
