// SPDX-License-Identifier: Apache-2.0
#include "environment/environment.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "candelabra_shaders.h"
#include "surfaces/camera.h"

namespace candelabra::environment
{
namespace
{

using gpu::Binding;
using gpu::divideUp;

static_assert(gpu::LOBES_CONSERVING == CND_LOBES_CONSERVING);
static_assert(gpu::LOBES_SUM == CND_LOBES_SUM);

constexpr uint32_t defaultCubeSize = 256;

CndEnvironmentDesc checked(const gpu::Device& device, CndEnvironmentDesc desc)
{
    if (desc.structSize != sizeof desc)
        gpu::failArgument("CndEnvironmentDesc: structSize is " + std::to_string(desc.structSize) +
                          ", this library expects " + std::to_string(sizeof desc));
    if (desc.framesInFlight < 1 || desc.framesInFlight > 8)
        gpu::failArgument("CndEnvironmentDesc: framesInFlight must be 1..8, is " +
                          std::to_string(desc.framesInFlight));
    if (!desc.cubeSize)
        desc.cubeSize = defaultCubeSize;
    if (desc.cubeSize < 64 || desc.cubeSize > 2048 || !std::has_single_bit(desc.cubeSize))
        gpu::failArgument("CndEnvironmentDesc: cubeSize must be a power of two from 64 to 2048, "
                          "is " +
                          std::to_string(desc.cubeSize));
    desc.radianceFormat = surfaces::checkedRadianceFormat(
        device, "CndEnvironmentDesc: radianceFormat", desc.radianceFormat);
    return desc;
}

uint32_t mipCount(uint32_t size)
{
    return uint32_t(std::bit_width(size));
}

uint32_t levelCount(uint32_t cubeSize)
{
    return mipCount(cubeSize / gpu::ENVIRONMENT_LAST_LEVEL_SIZE);
}

gpu::Handle<VkSampler> createSampler(const gpu::Device& device)
{
    const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                   .magFilter = VK_FILTER_LINEAR,
                                   .minFilter = VK_FILTER_LINEAR,
                                   .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                   .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                   .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                   .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                   .maxLod = VK_LOD_CLAMP_NONE};
    VkSampler sampler{};
    gpu::check(device.CreateSampler(device.handle, &info, device.allocationCallbacks, &sampler),
               "creating the environment's sampler");
    gpu::Handle<VkSampler> owner(device, sampler);
    device.name(VK_OBJECT_TYPE_SAMPLER, sampler, "environment sampler");
    return owner;
}

Binding cubeSampled(uint32_t binding, const gpu::CubeImage& cube, VkSampler sampler)
{
    return {.binding = binding,
            .image = cube.view.get(),
            .layout = VK_IMAGE_LAYOUT_GENERAL,
            .sampler = sampler};
}

bool isRotation(const glm::dmat3& m)
{
    const glm::dmat3 product = glm::transpose(m) * m;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            if (!(std::abs(product[c][r] - (c == r)) <= 1e-5)) // also false for NaN
                return false;
    return glm::determinant(m) > 0;
}

glm::dmat3 rotationOf(const float (&columns)[9])
{
    glm::dmat3 m;
    for (int i = 0; i < 9; ++i)
        m[i / 3][i % 3] = double(columns[i]);
    return m;
}

} // namespace

Environment::Environment(const CndDeviceDesc& device, const CndEnvironmentDesc& desc)
    : device_(device, gpu::environmentModule),
      desc_(checked(device_, desc)),
      gbuffer_(device_, desc_.gbufferLayout, desc_.gbuffer),
      uniforms_(device_, desc_.framesInFlight),
      timer_(device_, "environment", desc_.framesInFlight + 1, desc_.timestamps),
      dfg_(device_),
      cube_(device_, spirv::environment_cube_comp),
      mip_(device_, spirv::environment_mip_comp),
      prefilter_(device_, spirv::environment_prefilter_comp),
      irradianceKernel_(device_, spirv::environment_irradiance_comp),
      hostKernels_(desc_.hostKernels, desc_.gbufferLayout),
      shade_(device_,
             surfaces::addingTo(desc_.radianceFormat,
                                hostKernels_.used(spirv::shade_environment_comp),
                                gpu::SHADE_ENVIRONMENT_RADIANCE),
             {{gpu::SPEC_GBUFFER, gbuffer_.code()}}, hostKernels_.setLayout()),
      sampler_(createSampler(device_)),
      recorded_(desc_.framesInFlight)
{
    const uint32_t mips = mipCount(desc_.cubeSize), levels = levelCount(desc_.cubeSize);
    source_ = gpu::createCubeImage(device_, "environment", desc_.cubeSize, mips);
    prefiltered_ = gpu::createCubeImage(device_, "prefiltered environment", desc_.cubeSize, levels);
    irradiance_ = gpu::createCubeImage(device_, "environment irradiance",
                                       gpu::ENVIRONMENT_IRRADIANCE_SIZE, 1);
    sets_ = {.cube = cube_.createBindings(1),
             .mip = mip_.createBindings(mips - 1),
             .prefilter = prefilter_.createBindings(levels - 1),
             .irradiance = irradianceKernel_.createBindings(1),
             .shade = shade_.createBindings(desc_.framesInFlight)};
    for (uint32_t mip = 1; mip < mips; ++mip)
        sets_.mip.write(mip - 1,
                        {Binding::storage(gpu::ENVIRONMENT_MIP_INPUT, source_.mips[mip - 1].get()),
                         Binding::storage(gpu::ENVIRONMENT_MIP_OUTPUT, source_.mips[mip].get())});
    for (uint32_t level = 1; level < levels; ++level)
        sets_.prefilter.write(
            level - 1,
            {cubeSampled(gpu::ENVIRONMENT_PREFILTER_SOURCE, source_, sampler_.get()),
             Binding::storage(gpu::ENVIRONMENT_PREFILTER_OUTPUT, prefiltered_.mips[level].get())});
    const uint32_t sourceMip =
        mips - mipCount(gpu::ENVIRONMENT_IRRADIANCE_SOURCE_SIZE); // at least 1: cubeSize >= 64
    sets_.irradiance.write(
        0, {Binding::storage(gpu::ENVIRONMENT_IRRADIANCE_SOURCE, source_.mips[sourceMip].get()),
            Binding::storage(gpu::ENVIRONMENT_IRRADIANCE_OUTPUT, irradiance_.mips[0].get())});
}

void Environment::recordMap(VkCommandBuffer cmd, const CndEnvironmentMap& map)
{
    if (map.structSize != sizeof map)
        gpu::failArgument("CndEnvironmentMap: structSize is " + std::to_string(map.structSize) +
                          ", this library expects " + std::to_string(sizeof map));
    for (const uint32_t side : {map.width, map.height})
        if (side < 1 || side > 16384)
            gpu::failArgument("CndEnvironmentMap: size " + std::to_string(map.width) + "x" +
                              std::to_string(map.height) + " is outside 1x1..16384x16384");
    if (!map.equirectangular)
        gpu::failArgument("CndEnvironmentMap: equirectangular is null");
    sets_.cube.write(0,
                     {Binding::sampled(gpu::ENVIRONMENT_CUBE_IMAGE, map.equirectangular),
                      Binding::storage(gpu::ENVIRONMENT_CUBE_OUTPUT, source_.mips[0].get()),
                      Binding::storage(gpu::ENVIRONMENT_CUBE_MIRROR, prefiltered_.mips[0].get())});

    const gpu::Frame f{device_, cmd, timer_, mapSlot()};
    recordMapBegin(f);
    recordCube(f, map);
    recordPrefiltering(f);
    f.barrier();
    device_.endLabel(cmd);
    mapped_ = true;
}

// Records what precedes any preparation of the cube maps, whose previous contents are discarded.
void Environment::recordMapBegin(const gpu::Frame& f) noexcept
{
    device_.beginLabel(f.cmd, "candelabra environment map");
    timer_.begin(f.cmd, f.slot);
    f.barrier(); // waits for earlier frames, which use the same images
    recordLayouts(f);
    gbuffer_.record(f);
    dfg_.recordFill(f);
}

// Moves the cube maps to layout GENERAL, in which they stay. Their previous contents are discarded.
void Environment::recordLayouts(const gpu::Frame& f) const noexcept
{
    for (const gpu::CubeImage* cube : {&source_, &prefiltered_, &irradiance_})
        f.layoutBarrier(cube->image.get(), VK_IMAGE_LAYOUT_GENERAL);
}

void Environment::recordCube(const gpu::Frame& f, const CndEnvironmentMap& map) const noexcept
{
    const auto groups = [](uint32_t size) { return divideUp(size, gpu::ENVIRONMENT_GROUP); };
    // A cube face spans a quarter of the image's width and half of its height.
    const uint32_t perTexel =
        std::max(divideUp(map.width, 4 * desc_.cubeSize), divideUp(map.height, 2 * desc_.cubeSize));
    cube_.dispatch(f, sets_.cube.set(0),
                   {.imageSize = {map.width, map.height},
                    .cubeSize = desc_.cubeSize,
                    .samples = std::min(perTexel, gpu::ENVIRONMENT_MAX_SAMPLES)},
                   groups(desc_.cubeSize), groups(desc_.cubeSize), 6);
    for (uint32_t mip = 1; mip < source_.mips.size(); ++mip) {
        f.barrier();
        const uint32_t size = desc_.cubeSize >> mip;
        mip_.dispatch(f, sets_.mip.set(mip - 1), {size}, groups(size), groups(size), 6);
    }
    f.barrier();
}

void Environment::recordPrefiltering(const gpu::Frame& f) const noexcept
{
    const uint32_t last = uint32_t(prefiltered_.mips.size()) - 1;
    for (uint32_t level = 1; level <= last; ++level) {
        const uint32_t size = desc_.cubeSize >> level;
        const uint32_t groups = divideUp(size, gpu::ENVIRONMENT_GROUP);
        prefilter_.dispatch(
            f, sets_.prefilter.set(level - 1),
            {.size = size, .sourceSize = desc_.cubeSize, .alpha = std::exp2(-float(last - level))},
            groups, groups, 6);
    }
    constexpr uint32_t groups = gpu::ENVIRONMENT_IRRADIANCE_SIZE / gpu::ENVIRONMENT_GROUP;
    irradianceKernel_.dispatch(f, sets_.irradiance.set(0),
                               {.sourceSize = gpu::ENVIRONMENT_IRRADIANCE_SOURCE_SIZE}, groups,
                               groups, 6);
}

void Environment::validate(const CndEnvironmentFrame& frame) const
{
    if (frame.structSize != sizeof frame)
        gpu::failArgument("CndEnvironmentFrame: structSize is " + std::to_string(frame.structSize) +
                          ", this library expects " + std::to_string(sizeof frame));
    if (!mapped_)
        gpu::failArgument("cndRecordEnvironment: cndRecordEnvironmentMap or "
                          "cndRecordEnvironmentMapLoad must be recorded first");
    if (frame.frameSlot >= recorded_.size())
        gpu::failArgument("CndEnvironmentFrame: frameSlot is " + std::to_string(frame.frameSlot) +
                          ", framesInFlight is " + std::to_string(recorded_.size()));
    for (const uint32_t side : {frame.width, frame.height})
        if (side < 1 || side > 16384)
            gpu::failArgument("CndEnvironmentFrame: size " + std::to_string(frame.width) + "x" +
                              std::to_string(frame.height) + " is outside 1x1..16384x16384");
    gbuffer_.requireImages("CndEnvironmentFrame", frame);
    if (!frame.radiance)
        gpu::failArgument("CndEnvironmentFrame: radiance is null");
    if (!(frame.scale >= 0 && std::isfinite(frame.scale)))
        gpu::failArgument("CndEnvironmentFrame: scale must be finite and >= 0");
    if (frame.lobes != CND_LOBES_CONSERVING && frame.lobes != CND_LOBES_SUM)
        gpu::failArgument("CndEnvironmentFrame: lobes is not a CndLobeJoining");
    if (!isRotation(rotationOf(frame.worldFromEnvironment)))
        gpu::failArgument("CndEnvironmentFrame: worldFromEnvironment must be a rotation");
    hostKernels_.requireSet("CndEnvironmentFrame", frame.hostSet);
    surfaces::checkCamera(frame.camera);
}

void Environment::record(VkCommandBuffer cmd, const CndEnvironmentFrame& frame)
{
    using namespace gpu;
    validate(frame);
    const FrameParams params = surfaces::frameParams(frame, gbuffer_, desc_.radianceFormat);
    uniforms_.write(frame.frameSlot, params);
    const surfaces::GBufferViews images = gbuffer_.views(frame);
    sets_.shade.write(frame.frameSlot,
                      {Binding::sampled(SHADE_ENVIRONMENT_DEPTH, images.depth),
                       uniforms_.at(frame.frameSlot, SHADE_ENVIRONMENT_FRAME),
                       Binding::storage(SHADE_ENVIRONMENT_RADIANCE, frame.radiance),
                       cubeSampled(SHADE_ENVIRONMENT_CUBE, source_, sampler_.get()),
                       cubeSampled(SHADE_ENVIRONMENT_PREFILTERED, prefiltered_, sampler_.get()),
                       cubeSampled(SHADE_ENVIRONMENT_IRRADIANCE, irradiance_, sampler_.get()),
                       Binding::ofTexels(SHADE_ENVIRONMENT_DFG, dfg_.buffer())},
                      images.bindings(SHADE_ENVIRONMENT_GBUFFER));
    recorded_[frame.frameSlot] = true;

    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, frame.camera.viewFromWorld, sizeof viewFromWorld);
    const glm::dmat3 environmentFromView =
        glm::transpose(glm::dmat3(viewFromWorld) *
                       rotationOf(frame.worldFromEnvironment)); // inverse of a rotation

    const Frame f{device_, cmd, timer_, frame.frameSlot, frame.hostSet};
    device_.beginLabel(cmd, "candelabra environment");
    timer_.begin(cmd, f.slot);
    shade_.dispatch(f, sets_.shade.set(f.slot),
                    {.environmentFromView = glm::mat3(environmentFromView),
                     .lastLevel = float(prefiltered_.mips.size() - 1),
                     .scale = frame.scale,
                     .showsBackground = frame.background != VK_FALSE,
                     .depth = surfaces::storedDepth(gbuffer_.desc(), frame.camera, frame.clearDepth,
                                                    params.projection)},
                    divideUp(frame.width, SHADE_ENVIRONMENT_GROUP),
                    divideUp(frame.height, SHADE_ENVIRONMENT_GROUP));
    device_.endLabel(cmd);
}

CndResult Environment::stats(uint32_t slot, CndEnvironmentStats& out) const noexcept
{
    if (slot >= recorded_.size() || !recorded_[slot] || out.structSize != sizeof out)
        return CND_ERROR_INVALID_ARGUMENT;
    const CndResult result = timer_.read(slot, out.kernelTimes, out.kernelTimeCount);
    if (result != CND_SUCCESS)
        return result;
    return timer_.read(mapSlot(), out.mapKernelTimes, out.mapKernelTimeCount);
}

} // namespace candelabra::environment
