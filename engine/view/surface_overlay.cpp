// SPDX-License-Identifier: Apache-2.0
// The surface overlay, a picture of what kernels read from the G-buffer, which one kernel draws.
#include <cmath>
#include <cstring>
#include <string>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "view/frame_checks.h"
#include "view/view.h"

namespace candelabra::lighting
{

static_assert(gpu::SURFACE_ALL == CND_SURFACE_ALL);
static_assert(gpu::SURFACE_NORMAL == CND_SURFACE_NORMAL);
static_assert(gpu::SURFACE_ROUGHNESS == CND_SURFACE_ROUGHNESS);
static_assert(gpu::SURFACE_ALBEDO == CND_SURFACE_ALBEDO);
static_assert(gpu::SURFACE_F0 == CND_SURFACE_F0);
static_assert(gpu::SURFACE_POSITION == CND_SURFACE_POSITION);
static_assert(gpu::SURFACE_FAULTS == CND_SURFACE_FAULTS);

void View::recordOverlay(VkCommandBuffer cmd, const CndLightingFrame& frame,
                         const CndSurfaceOverlay& overlay)
{
    using namespace gpu;
    checkSurfaces(module_, desc_, frame);
    if (overlay.structSize != sizeof overlay)
        failArgument("CndSurfaceOverlay: structSize is " + std::to_string(overlay.structSize) +
                     ", this library expects " + std::to_string(sizeof overlay));
    if (uint32_t(overlay.quantity) > CND_SURFACE_FAULTS)
        failArgument("CndSurfaceOverlay: quantity is not a CndSurfaceQuantity");
    if (!overlay.image)
        failArgument("CndSurfaceOverlay: image is null");
    const FrameParams params =
        surfaces::frameParams(frame, module_.gbuffer, module_.desc.radianceFormat);
    overlayUniforms_.write(frame.frameSlot, params);
    const surfaces::GBufferViews images = module_.gbuffer.views(frame);
    sets_.surfaceOverlay.write(frame.frameSlot,
                               {Binding::sampled(SHADE_DEPTH, images.depth),
                                overlayUniforms_.at(frame.frameSlot),
                                Binding::storage(SURFACE_OVERLAY_IMAGE, overlay.image)},
                               images.bindings());

    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, frame.camera.viewFromWorld, sizeof viewFromWorld);
    const glm::dmat3 worldFromView = glm::transpose(glm::dmat3(viewFromWorld)); // a rotation
    const glm::dvec3 eye = -(worldFromView * glm::dvec3(viewFromWorld[3]));
    glm::vec3 eyeInPeriod;
    for (int i = 0; i < 3; ++i) // far from the origin float32 would be too coarse
        eyeInPeriod[i] = float(std::fmod(eye[i], double(SURFACE_PERIOD)));

    Timer untimed; // kernel times are those of cndRecordLighting
    const Frame f{module_.device, cmd, untimed, frame.frameSlot, frame.hostSet};
    f.device.beginLabel(cmd, "candelabra surface overlay");
    module_.gbuffer.record(f);
    module_.kernels.surfaceOverlay.dispatch(
        f, sets_.surfaceOverlay.set(f.slot),
        {.quantity = uint32_t(overlay.quantity),
         .eyeWorld = eyeInPeriod,
         .depth = surfaces::storedDepth(module_.gbuffer.desc(), frame.camera, frame.clearDepth,
                                        params.projection)},
        divideUp(frame.width, SURFACE_OVERLAY_GROUP),
        divideUp(frame.height, SURFACE_OVERLAY_GROUP));
    f.device.endLabel(cmd);
}

} // namespace candelabra::lighting
