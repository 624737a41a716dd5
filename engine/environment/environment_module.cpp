// SPDX-License-Identifier: Apache-2.0
#include "environment/environment_module.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "candelabra_shaders.h"
#include "surfaces/projection.h"

namespace candelabra::environment
{
namespace
{

using gpu::Binding;
using gpu::divideUp;

static_assert(gpu::LOBES_CONSERVING == CND_LOBES_CONSERVING);
static_assert(gpu::LOBES_SUM == CND_LOBES_SUM);

constexpr uint32_t defaultCubeSize = 256;

// Devices that limit loops end them after 65,535 iterations in all
// (decision 12). For a row of the image, environment_cube takes one iteration per column and some
// more.
constexpr uint32_t cubeIterations = 60000, cubeRowOverhead = 16;

CndEnvironmentDesc checkedDesc(const gpu::Device& device, CndEnvironmentDesc desc)
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

// Returns the samples of a level of the prefiltered cube, as environment_prefilter reads them.
std::array<glm::vec4, gpu::ENVIRONMENT_SAMPLES> lobeSamples(double alpha, uint32_t sourceSize)
{
    using std::numbers::pi;
    constexpr double count = gpu::ENVIRONMENT_SAMPLES;
    const double goldenAngle = pi * (3 - std::sqrt(5.0));
    const double texelSolidAngle = 4 * pi / (6.0 * sourceSize * sourceSize);
    // The mips that are read blur the lobe, so its samples are those of one up to 5% narrower.
    const double narrowed = alpha * (0.95 + 0.05 * alpha), a2 = narrowed * narrowed;
    const double above = 1 / (1 + a2); // the share of microfacet normals whose l has NoL > 0
    std::array<glm::vec4, gpu::ENVIRONMENT_SAMPLES> out;
    double weights = 0;
    for (uint32_t i = 0; i < out.size(); ++i) {
        // The microfacet normals have the density D NoH (Walter et al. 2007, eq. 35). v = n, so
        // VoH = NoH.
        const double u = (i + 0.5) / count * above, phi = goldenAngle * i;
        const double c2 = (1 - u) / (1 + (a2 - 1) * u); // squared NoH
        const double NoL = 2 * c2 - 1, sine = 2 * std::sqrt((1 - c2) * c2);
        const double width = c2 * (a2 - 1) + 1;
        const double pdf = a2 / (4 * pi * width * width * above); // D NoH / (4 VoH), above
        const double share = 1 / (pdf * count);
        // Wider texels blur the lobe, smaller ones let a small sun show the samples.
        const double texels = 0.87 * std::sqrt(share / texelSolidAngle);
        const double mip = std::max(std::round(std::log2(texels)), 0.0);
        // BRDF NoL / pdf = G2 / NoV = 1 / (1 + Lambda(l)), since Lambda(v) = 0 (Heitz 2014, eq.
        // 72).
        const double tan2 = sine * sine / (NoL * NoL);
        const double weight = 1 / (0.5 + 0.5 * std::sqrt(1 + a2 * tan2));
        out[i] = {sine * std::cos(phi), sine * std::sin(phi), mip, weight};
        weights += weight;
    }
    for (glm::vec4& sample : out)
        sample.w = float(sample.w / weights);
    return out;
}

// The alpha of a level of the prefiltered cube but the first.
double alphaOf(uint32_t level, uint32_t cubeSize)
{
    return std::exp2(-double(levelCount(cubeSize) - 1 - level));
}

gpu::Buffer createLobeSamples(const gpu::Device& device, uint32_t cubeSize)
{
    const uint32_t levels = levelCount(cubeSize);
    gpu::Buffer out = gpu::createBuffer(device, "environment lobe samples",
                                        (levels - 1) * gpu::ENVIRONMENT_SAMPLES * sizeof(glm::vec4),
                                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Upload);
    const std::span<glm::vec4> all = out.as<glm::vec4>();
    for (uint32_t level = 1; level < levels; ++level)
        std::ranges::copy(lobeSamples(alphaOf(level, cubeSize), cubeSize),
                          all.begin() + (level - 1) * gpu::ENVIRONMENT_SAMPLES);
    return out;
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
      desc_(checkedDesc(device_, desc)),
      gbuffer_(device_, desc_.gbufferLayout, desc_.gbuffer),
      uniforms_(device_, desc_.framesInFlight),
      timer_(device_, "environment", desc_.framesInFlight + 1, desc_.timestamps),
      dfg_(device_),
      cube_(device_, spirv::environment_cube_comp),
      mip_(device_, spirv::environment_mip_comp),
      prefilter_(device_, spirv::environment_prefilter_comp),
      cellsKernel_(device_, spirv::environment_cells_comp),
      irradianceKernel_(device_, spirv::environment_irradiance_comp),
      hostKernels_(desc_.hostKernels, desc_.gbufferLayout),
      shade_(device_,
             surfaces::addingTo(desc_.radianceFormat,
                                hostKernels_.used(spirv::shade_environment_comp),
                                gpu::RADIANCE_IMAGE),
             {{gpu::SPEC_GBUFFER, gbuffer_.code()}}, hostKernels_.setLayout()),
      sampler_(createSampler(device_)),
      recorded_(desc_.framesInFlight)
{
    const uint32_t mips = mipCount(desc_.cubeSize), levels = levelCount(desc_.cubeSize);
    source_ = gpu::createCubeImage(device_, "environment", desc_.cubeSize, mips);
    prefiltered_ = gpu::createCubeImage(device_, "prefiltered environment", desc_.cubeSize, levels);
    irradiance_ = gpu::createCubeImage(device_, "environment irradiance",
                                       gpu::ENVIRONMENT_IRRADIANCE_SIZE, 1);
    lobeSamples_ = createLobeSamples(device_, desc_.cubeSize);
    cells_ = gpu::createBuffer(device_, "environment cells",
                               gpu::ENVIRONMENT_CELL_ROWS * gpu::ENVIRONMENT_CELL_COLUMNS *
                                   sizeof(gpu::mat3),
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Scratch);
    sets_ = {.cube = cube_.createBindings(1),
             .mip = mip_.createBindings(mips - 1),
             .prefilter = prefilter_.createBindings(levels - 1),
             .cells = cellsKernel_.createBindings(1),
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
             Binding::storage(gpu::ENVIRONMENT_PREFILTER_OUTPUT, prefiltered_.mips[level].get()),
             Binding::of(gpu::ENVIRONMENT_PREFILTER_SAMPLES, lobeSamples_)});
    sets_.irradiance.write(
        0, {Binding::of(gpu::ENVIRONMENT_IRRADIANCE_CELLS, cells_),
            Binding::storage(gpu::ENVIRONMENT_IRRADIANCE_OUTPUT, irradiance_.mips[0].get())});
}

void Environment::recordMap(VkCommandBuffer cmd, const CndEnvironmentMap& map)
{
    if (map.structSize != sizeof map)
        gpu::failArgument("CndEnvironmentMap: structSize is " + std::to_string(map.structSize) +
                          ", this library expects " + std::to_string(sizeof map));
    gpu::requireRect("CndEnvironmentMap", 0, 0, map.width, map.height);
    if (!map.equirectangular)
        gpu::failArgument("CndEnvironmentMap: equirectangular is null");
    sets_.cube.write(0,
                     {Binding::sampled(gpu::ENVIRONMENT_IMAGE, map.equirectangular),
                      Binding::storage(gpu::ENVIRONMENT_CUBE_OUTPUT, source_.mips[0].get()),
                      Binding::storage(gpu::ENVIRONMENT_CUBE_MIRROR, prefiltered_.mips[0].get())});
    sets_.cells.write(0, {Binding::sampled(gpu::ENVIRONMENT_IMAGE, map.equirectangular),
                          Binding::of(gpu::ENVIRONMENT_CELLS_OUTPUT, cells_)});

    const gpu::Frame f{device_, cmd, timer_, mapSlot()};
    device_.beginLabel(cmd, "candelabra environment map");
    timer_.begin(cmd, f.slot);
    f.barrier(); // waits for earlier frames, which use the same images
    recordLayouts(f);
    gbuffer_.record(f);
    dfg_.recordFill(f);
    recordCube(f, map);
    recordIrradiance(f, map);
    recordPrefiltering(f);
    f.barrier();
    device_.endLabel(cmd);
    mapped_ = true;
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
    // Texels around a pole gather from rows up to two diagonals of a texel away from it, the
    // farthest and with a margin of 3 rows.
    // These rows are divided into parts, as in partsOfTexels() of environment_cube.comp.
    const uint32_t parts =
        1 + uint32_t(0.625 * 1.3 * std::numbers::pi * desc_.cubeSize / map.height);
    const uint32_t rows = std::max(cubeIterations / parts / (map.width + cubeRowOverhead), 1u);
    const uint32_t most =
        uint32_t(2 * std::numbers::sqrt2 * 2 / desc_.cubeSize * map.height / std::numbers::pi) + 3;
    for (uint32_t skipped = 0; skipped < most; skipped += rows) {
        if (skipped > 0)
            f.barrier();
        cube_.dispatch(f, sets_.cube.set(0),
                       {.imageSize = {map.width, map.height},
                        .cubeSize = desc_.cubeSize,
                        .skippedRows = skipped,
                        .rows = rows},
                       groups(desc_.cubeSize), groups(desc_.cubeSize), 6);
    }
    for (uint32_t mip = 1; mip < source_.mips.size(); ++mip) {
        f.barrier();
        const uint32_t size = desc_.cubeSize >> mip;
        mip_.dispatch(f, sets_.mip.set(mip - 1), {size}, groups(size), groups(size), 6);
    }
}

// Records the light of every normal, which follows from the image, not from the cube.
void Environment::recordIrradiance(const gpu::Frame& f, const CndEnvironmentMap& map) const noexcept
{
    cellsKernel_.dispatch(f, sets_.cells.set(0), {.imageSize = {map.width, map.height}},
                          gpu::ENVIRONMENT_CELL_COLUMNS / gpu::ENVIRONMENT_GROUP,
                          gpu::ENVIRONMENT_CELL_ROWS / gpu::ENVIRONMENT_GROUP);
    f.barrier(); // also for the cube's last mip
    constexpr uint32_t size = gpu::ENVIRONMENT_IRRADIANCE_SIZE;
    constexpr uint32_t rows = divideUp(size, gpu::ENVIRONMENT_IRRADIANCE_NORMALS);
    irradianceKernel_.dispatch(f, sets_.irradiance.set(0), {},
                               divideUp(size, gpu::ENVIRONMENT_GROUP),
                               divideUp(rows, gpu::ENVIRONMENT_GROUP), 3);
}

void Environment::recordPrefiltering(const gpu::Frame& f) const noexcept
{
    for (uint32_t level = 1; level < prefiltered_.mips.size(); ++level) {
        const uint32_t size = desc_.cubeSize >> level;
        const uint32_t groups = divideUp(size, gpu::ENVIRONMENT_GROUP);
        prefilter_.dispatch(f, sets_.prefilter.set(level - 1),
                            {.size = size, .firstSample = (level - 1) * gpu::ENVIRONMENT_SAMPLES},
                            groups, groups, 6);
    }
}

void Environment::validate(const CndEnvironmentFrame& frame) const
{
    if (frame.structSize != sizeof frame)
        gpu::failArgument("CndEnvironmentFrame: structSize is " + std::to_string(frame.structSize) +
                          ", this library expects " + std::to_string(sizeof frame));
    if (!mapped_)
        gpu::failArgument("cndRecordEnvironment: cndRecordEnvironmentMap must be recorded first");
    if (frame.frameSlot >= recorded_.size())
        gpu::failArgument("CndEnvironmentFrame: frameSlot is " + std::to_string(frame.frameSlot) +
                          ", framesInFlight is " + std::to_string(recorded_.size()));
    gpu::requireRect("CndEnvironmentFrame", frame.x, frame.y, frame.width, frame.height);
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
                       uniforms_.at(frame.frameSlot),
                       Binding::storage(RADIANCE_IMAGE, frame.radiance),
                       cubeSampled(SHADE_ENVIRONMENT_CUBE, source_, sampler_.get()),
                       cubeSampled(SHADE_ENVIRONMENT_PREFILTERED, prefiltered_, sampler_.get()),
                       cubeSampled(SHADE_ENVIRONMENT_IRRADIANCE, irradiance_, sampler_.get()),
                       Binding::ofTexels(SHADE_ENVIRONMENT_DFG, dfg_.buffer())},
                      images.bindings());
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
