// SPDX-License-Identifier: Apache-2.0
#include "view/frame_plan.h"

#include <cstring>
#include <numeric>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "surfaces/frame_uniforms.h"

namespace candelabra::lighting
{
namespace
{

// Tiles longer than this many radii of influence are split into slices. Half and twice as many were
// measured to be as fast (DECISIONS 25).
constexpr float splitLength = 2;
constexpr uint32_t defaultSampleCount = 64;

// Returns the number of lights by type, or 0 for types that the frame leaves out.
LightTypeCounts typesOf(const LightSet& lights, const CndLightingFrame& frame)
{
    if (frame.culling == CND_CULLING_BRUTE) // what culling is compared with: it leaves nothing out
        return lights.typeCounts();
    const uint32_t layers = layersOf(frame.layers);
    return influenceOf(frame) == CND_INFLUENCE_GIVEN
               ? lights.countsInView(frame.camera, layers)
               : lights.countsInLayers(layers); // each light may reach the view, wherever it is
}

gpu::FrameParams frameParams(const Module& module, const CndLightingFrame& frame)
{
    gpu::FrameParams out = surfaces::frameParams(frame, module.gbuffer, module.desc.radianceFormat);
    out.sampleCount = frame.sampleCount ? frame.sampleCount : defaultSampleCount;
    out.sampleSeed = frame.sampleSeed;
    if (!module.gbuffer.depthIsProjected())
        out.firstDepthTexel = {};
    return out;
}

gpu::PrepareLightsParams prepareParams(const LightSet& lights, const CndLightingFrame& frame)
{
    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, frame.camera.viewFromWorld, sizeof viewFromWorld);
    const double* o = lights.origin();
    const LightTypeCounts& counts = lights.typeCounts();
    const auto firstPolygon =
        std::accumulate(counts.begin(), counts.begin() + CND_LIGHT_POLYGON, 0u);
    return {.viewFromWorld = glm::mat3(glm::dmat3(viewFromWorld)),
            .originView = glm::vec3(viewFromWorld * glm::dvec4(o[0], o[1], o[2], 1)),
            .lightCount = lights.count(),
            .layers = layersOf(frame.layers),
            .uncut = influenceOf(frame) != CND_INFLUENCE_GIVEN,
            .firstPolygon = firstPolygon,
            .firstCornerShape = lights.capacity()};
}

} // namespace

FramePlan planFrame(const Module& module, const CndLightingFrame& frame)
{
    const LightSet& lights = module.lights;
    const bool occluders = module.occluders && !frame.shadowsOff &&
                           (module.occluders->instances().layers() & layersOf(frame.layers));
    return {.frame = frame,
            .params = frameParams(module, frame),
            .tileCount = {tilesAlong(frame.width), tilesAlong(frame.height)},
            .lights = typesOf(lights, frame),
            .trees = treeShapes(lights.typeCounts()),
            // Radii that do not come from the host are known on the device alone.
            .splitLength =
                influenceOf(frame) == CND_INFLUENCE_GIVEN
                    ? std::min(splitLength * lights.extent().influenceRadius, gpu::UNBOUNDED)
                    : gpu::UNBOUNDED,
            .prepare = prepareParams(lights, frame),
            .occluders = occluders,
            .shadows = occluders || (module.hostKernels.findsPoints() && !frame.shadowsOff)};
}

} // namespace candelabra::lighting
