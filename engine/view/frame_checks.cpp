// SPDX-License-Identifier: Apache-2.0
#include "view/frame_checks.h"

#include <bit>
#include <string>

#include "surfaces/projection.h"

namespace candelabra::lighting
{
namespace
{

constexpr uint32_t maxSampleCount = 4096;

// The sentence about what the frame asks for and has no pipelines for.
std::string missingShading(const Module& module, const CndLightingFrame& frame)
{
    const auto lacks = [&](CndShadingBits bit) {
        return (shadingOf(frame) & bit) &&
               !module.kernels.shade.allows(frame.specularMethod, uint32_t(bit));
    };
    const char* const what =
        lacks(CND_SHADING_CLUSTERED_BIT) ? "culling CLUSTERED needs CND_SHADING_CLUSTERED_BIT"
        : lacks(CND_SHADING_BRUTE_BIT)   ? "culling BRUTE needs CND_SHADING_BRUTE_BIT"
                                         : "countPairs needs CND_SHADING_COUNT_PAIRS_BIT";
    return std::string("CndLightingFrame: ") + what +
           " in CndLightingDesc::shading, or cndAddLightingPipelines for specularMethod " +
           std::to_string(frame.specularMethod);
}

} // namespace

void checkSurfaces(const Module& module, const CndLightingViewDesc& view,
                   const CndLightingFrame& frame)
{
    if (frame.structSize != sizeof frame)
        gpu::failArgument("CndLightingFrame: structSize is " + std::to_string(frame.structSize) +
                          ", this library expects " + std::to_string(sizeof frame));
    if (frame.frameSlot >= module.desc.framesInFlight)
        gpu::failArgument("CndLightingFrame: frameSlot is " + std::to_string(frame.frameSlot) +
                          ", framesInFlight is " + std::to_string(module.desc.framesInFlight));
    gpu::requireRect("CndLightingFrame", frame.x, frame.y, frame.width, frame.height,
                     {view.maxWidth, view.maxHeight});
    module.gbuffer.requireImages("CndLightingFrame", frame);
    module.hostKernels.requireSet("CndLightingFrame", frame.hostSet);
    surfaces::checkCamera(frame.camera);
}

CndLightingFrame checkedFrame(const Module& module, const CndLightingViewDesc& view,
                              const CndLightingFrame& asked)
{
    checkSurfaces(module, view, asked);
    CndLightingFrame frame = asked;
    if (frame.specularMethod == CND_SPECULAR_DEFAULT)
        frame.specularMethod = CndSpecularMethod(std::countr_zero(module.desc.specularMethods));
    if (!frame.radiance)
        gpu::failArgument("CndLightingFrame: radiance is null");
    if (uint32_t(frame.specularMethod) >= CND_SPECULAR_METHOD_COUNT)
        gpu::failArgument("CndLightingFrame: specularMethod is not a CndSpecularMethod");
    if (!module.kernels.shade.allows(frame.specularMethod))
        gpu::failArgument("CndLightingFrame: specularMethod " +
                          std::to_string(frame.specularMethod) +
                          " is not among CndLightingDesc::specularMethods; 0 means the first of "
                          "these");
    if (!module.kernels.shade.allows(frame.specularMethod, shadingOf(frame)))
        gpu::failArgument(missingShading(module, frame));
    if (frame.sampleCount > maxSampleCount)
        gpu::failArgument("CndLightingFrame: sampleCount must be at most " +
                          std::to_string(maxSampleCount) + ", is " +
                          std::to_string(frame.sampleCount));
    if (frame.lobes != CND_LOBES_CONSERVING && frame.lobes != CND_LOBES_SUM)
        gpu::failArgument("CndLightingFrame: lobes is not a CndLobeJoining");
    if (uint32_t(frame.culling) > CND_CULLING_BRUTE)
        gpu::failArgument("CndLightingFrame: culling is not a CndCulling");
    if (!areLayers(frame.layers))
        gpu::failArgument("CndLightingFrame: layers has bits beyond CND_LAYER_COUNT");
    checkInfluence(frame.influence, module.desc.influenceByError);
    const auto isInside = [](int32_t offset, uint32_t extent, uint32_t size) {
        return offset >= 0 && uint32_t(offset) <= size && extent <= size - uint32_t(offset);
    };
    const VkRect2D& r = frame.bruteRect;
    if (!r.extent.width != !r.extent.height)
        gpu::failArgument("CndLightingFrame: bruteRect has only one side of 0 (both mean all)");
    if (!isInside(r.offset.x, r.extent.width, frame.width) ||
        !isInside(r.offset.y, r.extent.height, frame.height))
        gpu::failArgument("CndLightingFrame: bruteRect is not inside the frame");
    return frame;
}

} // namespace candelabra::lighting
