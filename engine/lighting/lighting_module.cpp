// SPDX-License-Identifier: Apache-2.0
#include "lighting/lighting_module.h"

#include <string>

#include "gpu/display_format.h"
#include "gpu/format_name.h"
#include "lights/light_limits.h"
#include "shading/light_batches.h"
#include "shading/light_family.h"

namespace candelabra::lighting
{
namespace
{

constexpr uint32_t allShading =
    CND_SHADING_CLUSTERED_BIT | CND_SHADING_BRUTE_BIT | CND_SHADING_COUNT_PAIRS_BIT;

// The member shading of the struct `owner`, in which 0 stands for all bits.
uint32_t checkedShading(const char* owner, uint32_t shading)
{
    if (shading & ~allShading)
        gpu::failArgument(std::string(owner) + ": shading has bits beyond CndShadingBits");
    return shading ? shading : allShading;
}

void checkLightTypes(const char* owner, uint32_t lightTypes)
{
    if (lightTypes >> CND_LIGHT_TYPE_COUNT)
        gpu::failArgument(std::string(owner) +
                          ": lightTypes has bits beyond the last CndLightType");
}

// Tells whether depth of this format, which the host may not have told, is precise enough for
// shadows.
bool isDepthOfShadows(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_UNDEFINED:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        return true;
    default:
        return false;
    }
}

// `desc` is not checked yet.
bool findsShadows(const CndLightingDesc& desc)
{
    return desc.structSize == sizeof desc && desc.shadows.points;
}

void checkShadows(const CndLightingDesc& desc)
{
    const uint32_t points = desc.shadows.points;
    if (points != 0 && points != 32 && points != 64)
        gpu::failArgument("CndShadowDesc: points must be 0, 32 or 64, is " +
                          std::to_string(points));
    if (points && !isDepthOfShadows(desc.gbuffer.depthFormat))
        gpu::failArgument("CndShadowDesc: shadows need depth of at least 24 bits, "
                          "CndGBufferDesc::depthFormat is " +
                          gpu::formatName(desc.gbuffer.depthFormat));
}

CndLightingDesc checkedDesc(const gpu::Device& device, CndLightingDesc desc)
{
    if (desc.structSize != sizeof desc)
        gpu::failArgument("CndLightingDesc: structSize is " + std::to_string(desc.structSize) +
                          ", this library expects " + std::to_string(sizeof desc));
    if (desc.framesInFlight < 1 || desc.framesInFlight > 8)
        gpu::failArgument("CndLightingDesc: framesInFlight must be 1..8, is " +
                          std::to_string(desc.framesInFlight));
    checkSpecularMethods("CndLightingDesc", desc.specularMethods);
    if (desc.influenceByError && desc.hostKernels.count)
        gpu::failArgument("CndLightingDesc: influenceByError cannot measure with hostKernels");
    if (!desc.specularMethods)
        desc.specularMethods = 1u << CND_SPECULAR_CONIC;
    desc.shading = checkedShading("CndLightingDesc", desc.shading);
    if (!(desc.shading & (CND_SHADING_CLUSTERED_BIT | CND_SHADING_BRUTE_BIT)))
        gpu::failArgument("CndLightingDesc: shading needs CND_SHADING_CLUSTERED_BIT or "
                          "CND_SHADING_BRUTE_BIT, or no frame could be drawn");
    checkLightTypes("CndLightingDesc", desc.lightTypes);
    checkShadows(desc);
    desc.radianceFormat = surfaces::checkedRadianceFormat(device, "CndLightingDesc: radianceFormat",
                                                          desc.radianceFormat);
    desc.overlayFormat =
        gpu::checkedDisplayFormat(device, "CndLightingDesc: overlayFormat", desc.overlayFormat);
    return desc;
}

const surfaces::HostKernels& checkedKernels(const surfaces::HostKernels& kernels,
                                            const CndLightingDesc& desc)
{
    if (kernels.findsPoints() && !desc.shadows.points)
        gpu::failArgument("CndLightingDesc: hostKernels have CND_HOST_VISIBLE_POINTS_BIT, which "
                          "needs shadows.points of 32 or 64");
    return kernels;
}

} // namespace

Lighting::Lighting(const CndDeviceDesc& device, const CndLightingDesc& desc)
    : device_(device, gpu::lightingModule | (findsShadows(desc) ? gpu::shadowKernels : 0)),
      desc_(checkedDesc(device_, desc)),
      gbuffer_(device_, desc_.gbufferLayout, desc_.gbuffer),
      hostKernels_(desc_.hostKernels, desc_.gbufferLayout),
      kernels_(device_, checkedKernels(hostKernels_, desc_), desc_, gbuffer_.code(),
               readsLightIds(desc_)),
      albedoTable_(device_),
      forwardLayout_(
          createForwardLayout(device_, desc_.forwardStages, forwardShadows(desc_, hostKernels_))),
      lights_(
          device_, recordings_, desc_.lightCapacity,
          [this](uint32_t capacity, const LightTypeCounts& types) { prepare(capacity, types); }),
      module_{device_,  desc_,        recordings_, gbuffer_, hostKernels_,
              kernels_, albedoTable_, lights_,     nullptr}
{
    if (desc_.shadows.points) {
        occluders_.emplace(device_, recordings_, desc_.shadows.triangleCapacity,
                           desc_.shadows.instanceCapacity, [this](uint32_t places) {
                               for (View* view : views_)
                                   view->makeRoomForOccluders(places);
                           });
        module_.occluders = &*occluders_;
    }

    if (const uint32_t batch = lightsPerBatch(device_, 0); batch != UINT32_MAX)
        device_.say(CND_MESSAGE_INFO,
                    "cndCreateLighting: the device ends loops after %u iterations: brute force of "
                    "more than %u sphere lights, or of fewer lights of other types, is shaded in "
                    "parts, and so are very long lists, slower",
                    device_.maxLoopIterations, batch);
    if (device_.lanesAreCpuVector && !texelBuffersSuffice(device_.limits))
        device_.say(CND_MESSAGE_INFO,
                    "cndCreateLighting: maxTexelBufferElements is %u: lights and lists are read "
                    "from storage buffers, which is slower on this device",
                    device_.limits.maxTexelBufferElements);
}

void Lighting::addPipelines(const CndLightingPipelines& added)
{
    if (added.structSize != sizeof added)
        gpu::failArgument("CndLightingPipelines: structSize is " +
                          std::to_string(added.structSize) + ", this library expects " +
                          std::to_string(sizeof added));
    checkLightTypes("CndLightingPipelines", added.lightTypes);
    checkSpecularMethods("CndLightingPipelines", added.specularMethods);
    kernels_.shade.add(added.lightTypes, added.specularMethods,
                       checkedShading("CndLightingPipelines", added.shading));
}

OccluderSet& Lighting::occluders(const char* call)
{
    if (!occluders_)
        gpu::failArgument(std::string(call) + ": CndLightingDesc::shadows.points was 0");
    return *occluders_;
}

VkDescriptorSetLayout Lighting::forwardLayout() const
{
    if (!forwardLayout_)
        gpu::failArgument("cndGetForwardSetLayout: CndLightingDesc::forwardStages was 0");
    return forwardLayout_.get();
}

// Called before the light set takes lights of these types and grows to this capacity
// (LightSet::Prepare).
void Lighting::prepare(uint32_t lightCapacity, const LightTypeCounts& types)
{
    uint32_t present = 0;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        present |= uint32_t(types[type] != 0) << type;
    const uint32_t created = kernels_.shade.add(present, 0, 0);
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        if (created >> type & 1)
            device_.say(CND_MESSAGE_INFO,
                        "lights of CndLightType %u are new: their pipelines were made now, while "
                        "the lights were set; CndLightingDesc::lightTypes makes them at creation",
                        type);
    for (View* view : views_)
        view->makeRoom(lightCapacity, types);
}

} // namespace candelabra::lighting
