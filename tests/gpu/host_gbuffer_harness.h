// SPDX-License-Identifier: Apache-2.0
// A host with its own G-buffer: packs surfaces on the CPU as a CndGBufferDesc describes, and stores
// the surfaces that result from decoding in the FULL layout.
#pragma once

#include "gpu/environment_harness.h"

namespace candelabra::test
{

// A surface in view space.
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
    CpuGBuffer asFull;    // the surfaces that shaders decode
    CpuGBuffer unrounded; // the surfaces before packing, except for depth
};

// Packs surfaces as `desc` describes, which must specify its formats.
class HostPacking
{
public:
    HostPacking(const CndGBufferDesc& desc, uint32_t width, uint32_t height,
                const CndCamera& camera, float clearDepth);
    // Packs the next pixel, in rows from the top.
    void add(const HostSurface& surface, double depth);
    const HostPixels& pixels() const { return out_; }

private:
    HostPixels out_;
    // Appends what the depth image holds of the next pixel; returns the depth that it means.
    double addDepth(double depth);

    glm::dmat3 storedFromView_; // rotation of normals from view space to the stored space
};

// Appends one texel of a colour format; returns what a shader reads from it.
glm::dvec4 appendTexel(std::vector<std::byte>& out, VkFormat format, const glm::dvec4& value);
double appendDepth(std::vector<std::byte>& out, VkFormat format, double depth);

class HostGBufferTest : public EnvironmentTest
{
protected:
    struct HostImages {
        gpu::Image colour[3], depth;
    };
    HostImages uploadHost(const HostPixels& pixels);
    // Returns the frame `frame` with the images of the host.
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
