// SPDX-License-Identifier: Apache-2.0
#include "surfaces/stored_depth.h"

#include <cmath>
#include <string>

#include "gpu/failure.h"
#include "surfaces/projection.h"

namespace candelabra::surfaces
{

static_assert(gpu::DEPTH_PROJECTED == CND_DEPTH_PROJECTED);
static_assert(gpu::DEPTH_LINEAR == CND_DEPTH_LINEAR);
static_assert(gpu::DEPTH_POSITION_VIEW == CND_DEPTH_POSITION_VIEW);
static_assert(gpu::DEPTH_POSITION_WORLD == CND_DEPTH_POSITION_WORLD);

FrameDepth frameDepth(CndDepthKind kind, const CndCamera& camera, float clearDepth)
{
    if (kind == CND_DEPTH_PROJECTED)
        return {projectionOf(camera.clipFromView, clearDepth), clearDepth};
    FrameDepth out{projectionOf(camera.clipFromView, 1), 1};
    if (out.projection.eyeIsPoint != 0) {
        out.projection.m22 = 0;
        out.projection.m32 = std::ldexp(1.0f, -10);
        out.clear = 0;
    }
    return out;
}

gpu::StoredDepth storedDepth(const CndGBufferDesc& desc, const CndCamera& camera, float clearDepth,
                             const gpu::Projection& projection)
{
    gpu::StoredDepth out{.z = {}, .clear = clearDepth};
    const double* m = camera.viewFromWorld;
    const bool looksAlongZ = projection.eyeIsPoint != 0 ? projection.m23 > 0 : projection.eye.z < 0;
    switch (desc.depthKind) {
    case CND_DEPTH_LINEAR:
        out.z.x = (looksAlongZ ? 1.0f : -1.0f) * (desc.depthUnit > 0 ? desc.depthUnit : 1.0f);
        break;
    case CND_DEPTH_POSITION_VIEW:
        out.z.z = 1;
        break;
    case CND_DEPTH_POSITION_WORLD:
        out.z = {float(m[2]), float(m[6]), float(m[10]), float(m[14])};
        break;
    default:
        break;
    }
    return out;
}

void checkClearDepth(const char* frameName, CndDepthKind kind, const CndCamera& camera,
                     float clearDepth)
{
    if (kind == CND_DEPTH_PROJECTED && clearDepth != 0 && clearDepth != 1)
        gpu::failArgument(std::string(frameName) + ": clearDepth must be 0 or 1");
    if (!std::isfinite(clearDepth))
        gpu::failArgument(std::string(frameName) + ": clearDepth must be finite");
    if (kind == CND_DEPTH_PROJECTED)
        checkDepthDirection(frameName, projectionOf(camera.clipFromView, clearDepth), clearDepth);
}

} // namespace candelabra::surfaces
