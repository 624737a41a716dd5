// SPDX-License-Identifier: Apache-2.0
// What a frame may ask for; what the host should know of those before.
#include <string>

#include "lighting/lighting.h"
#include "surfaces/camera.h"

namespace candelabra::lighting
{
namespace
{

constexpr uint32_t maxSampleCount = 4096;

} // namespace

// What the surfaces of a frame are: also of an overlay.
void View::validateSurfaces(const CndLightingFrame& frame) const
{
    if (frame.structSize != sizeof frame)
        gpu::failArgument("CndLightingFrame: structSize is " + std::to_string(frame.structSize) +
                          ", this library expects " + std::to_string(sizeof frame));
    if (frame.frameSlot >= slots_.size())
        gpu::failArgument("CndLightingFrame: frameSlot is " + std::to_string(frame.frameSlot) +
                          ", framesInFlight is " + std::to_string(slots_.size()));
    if (!frame.width || !frame.height || frame.width > desc_.maxWidth ||
        frame.height > desc_.maxHeight)
        gpu::failArgument("CndLightingFrame: size " + std::to_string(frame.width) + "x" +
                          std::to_string(frame.height) + " is outside 1x1.." +
                          std::to_string(desc_.maxWidth) + "x" + std::to_string(desc_.maxHeight));
    if (frame.clearDepth != 0 && frame.clearDepth != 1)
        gpu::failArgument("CndLightingFrame: clearDepth must be 0 or 1");
    lighting_.gbuffer().requireImages("CndLightingFrame", frame);
    lighting_.hostKernels().requireSet("CndLightingFrame", frame.hostSet);
    checkCamera(frame.camera);
}

void View::validate(const CndLightingFrame& frame) const
{
    validateSurfaces(frame);
    if (!frame.radiance)
        gpu::failArgument("CndLightingFrame: radiance is null");
    if (uint32_t(frame.specularMethod) >= CND_SPECULAR_METHOD_COUNT)
        gpu::failArgument("CndLightingFrame: specularMethod is not a CndSpecularMethod");
    if (!lighting_.kernels().shade.allows(frame.specularMethod))
        gpu::failArgument("CndLightingFrame: specularMethod " +
                          std::to_string(frame.specularMethod) +
                          " is not among CndLightingDesc::specularMethods");
    if (frame.sampleCount > maxSampleCount)
        gpu::failArgument("CndLightingFrame: sampleCount must be at most " +
                          std::to_string(maxSampleCount) + ", is " +
                          std::to_string(frame.sampleCount));
    if (!(frame.errorBudget >= 0 && frame.errorBudget <= 1))
        gpu::failArgument("CndLightingFrame: errorBudget must be 0..1");
    if (frame.lobes != CND_LOBES_CONSERVING && frame.lobes != CND_LOBES_SUM)
        gpu::failArgument("CndLightingFrame: lobes is not a CndLobeJoining");
    if (uint32_t(frame.culling) > CND_CULLING_BRUTE)
        gpu::failArgument("CndLightingFrame: culling is not a CndCulling");
    if (!areLayers(frame.layers))
        gpu::failArgument("CndLightingFrame: layers has bits beyond CND_LAYER_COUNT");
    checkInfluence(frame.influence, lighting_.desc().influenceByError);
    const auto isInside = [](int32_t offset, uint32_t extent, uint32_t size) {
        return offset >= 0 && uint32_t(offset) <= size && extent <= size - uint32_t(offset);
    };
    const VkRect2D& r = frame.bruteRect;
    if (!r.extent.width != !r.extent.height)
        gpu::failArgument("CndLightingFrame: bruteRect has only one side of 0 (both mean all)");
    if (!isInside(r.offset.x, r.extent.width, frame.width) ||
        !isInside(r.offset.y, r.extent.height, frame.height))
        gpu::failArgument("CndLightingFrame: bruteRect is not inside the frame");
}

void View::tell(const CndLightingStats& stats) const noexcept
{
    const gpu::Device& device = lighting_.device();
    if (stats.unlistedClusters && !toldUnlisted_) {
        toldUnlisted_ = true;
        device.say(CND_MESSAGE_WARNING,
                   "cndGetLightingStats: %u clusters have no list, because "
                   "CndLightingViewDesc::listBudget, %llu bytes, was used up or the list too long "
                   "for the device: they are shaded by walking the light tree, slower",
                   stats.unlistedClusters, (unsigned long long)desc_.listBudget);
    }
    if (stats.rejectedLights && toldRejected_ != lighting_.lightSet()) {
        toldRejected_ = lighting_.lightSet();
        device.say(CND_MESSAGE_WARNING,
                   "cndGetLightingStats: %u lights of CndDeviceLights give no light, because a "
                   "field is outside its range or they are more than maxCount",
                   stats.rejectedLights);
    }
}

} // namespace candelabra::lighting
