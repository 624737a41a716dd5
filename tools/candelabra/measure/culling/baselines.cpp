// SPDX-License-Identifier: Apache-2.0
#include "measure/culling/baselines.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "candelabra_bench_shaders.h"
#include "candelabra_shaders.h"
#include "io/error.h"
#include "lights/light_limits.h"
#include "lights/pack_lights.h"
#include "measure/kernels/light_kernels.h"
#include "shared/light_order_data.h"

namespace candelabra::app
{
namespace
{

using gpu::divideUp;
using gpu::MemoryUse;

constexpr VkBufferUsageFlags storageUse =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
constexpr VkBufferUsageFlags texelUse = storageUse | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
constexpr VkDeviceSize firstEntries = 1u << 20; // in words; the buffer grows if lists need more

uint64_t join(glm::uvec2 lowHigh)
{
    return uint64_t(lowHigh.y) << 32 | lowHigh.x;
}

gpu::Buffer texels(const gpu::Device& device, const char* name, VkDeviceSize count, MemoryUse use)
{
    gpu::Buffer out = gpu::createBuffer(device, name, count * sizeof(glm::vec4), texelUse, use);
    gpu::createTexelView(device, out);
    return out;
}

} // namespace

Baselines::Kernels::Kernels(const gpu::Device& device)
    : prepare(device, spirv::prepare_lights_comp),
      spheres(device, spirv::baseline_spheres_comp),
      tiles(device, spirv::baseline_tiles_comp, {{gpu::SPEC_FOR_CPU, lighting::forCpu(device)}}),
      count(device, spirv::baseline_froxels_comp,
            {{gpu::SPEC_FOR_CPU, lighting::forCpu(device)}, {gpu::SPEC_FROXELS_ENTER, 0}}),
      enter(device, spirv::baseline_froxels_comp,
            {{gpu::SPEC_FOR_CPU, lighting::forCpu(device)}, {gpu::SPEC_FROXELS_ENTER, 1}}),
      scan(device, spirv::baseline_scan_comp)
{
    const auto make = [&](const gpu::Spirv& spirv, uint32_t baseline) {
        return gpu::Kernel<gpu::NoParams>(device, spirv,
                                          {{gpu::SPEC_FOR_CPU, lighting::forCpu(device)},
                                           {gpu::SPEC_SPECULAR_METHOD, CND_SPECULAR_CONIC},
                                           {gpu::SPEC_LIGHT_TYPE, CND_LIGHT_SPHERE},
                                           {gpu::SPEC_GBUFFER, CND_GBUFFER_FULL},
                                           {gpu::SPEC_BASELINE, baseline}});
    };
    for (uint32_t i : {gpu::BASELINE_OF_TILES, gpu::BASELINE_OF_FROXELS}) {
        shade[i] = make(spirv::baseline_shade_comp_conic, i);
        pairs[i] = make(spirv::baseline_pairs_comp_conic, i);
    }
    floor = make(spirv::baseline_floor_comp_conic, 0);
}

Baselines::Baselines(const VulkanContext& context, Renderer& renderer, const Scene& scene,
                     const FrameOptions& options)
    : context_(context),
      renderer_(renderer),
      options_(options),
      frame_(renderer.lightingFrame(0, options)),
      gbuffer_(context.device(), CND_GBUFFER_FULL, {}),
      params_(surfaces::frameParams(frame_, gbuffer_, VK_FORMAT_R32G32B32A32_SFLOAT)),
      kernels_(context.device()),
      timer_(context.device(), "baselines", 1, true),
      dfg_(context.device()),
      uniforms_(context.device(), 1)
{
    const gpu::Device& device = context.device();
    uniforms_.write(0, params_);
    createLights(scene);
    const auto buffer = [&](const char* name, VkDeviceSize bytes, MemoryUse use) {
        return gpu::createBuffer(device, name, bytes, storageUse, use);
    };
    const glm::uvec2 size(frame_.width, frame_.height);
    const glm::uvec2 tileCount = (size + gpu::BASELINE_TILE_SIZE - 1u) / gpu::BASELINE_TILE_SIZE;
    const glm::uvec2 columns = (size + gpu::FROXEL_SIZE - 1u) / gpu::FROXEL_SIZE;
    const glm::uvec2 grids[2] = {tileCount, columns};
    const uint32_t tiles = tileCount.x * tileCount.y;
    const uint32_t froxels = columns.x * columns.y * gpu::FROXEL_SLICES;
    ranges_ = buffer("baseline ranges", tiles * sizeof(glm::vec2), MemoryUse::Readback);
    boxes_ = texels(device, "froxel boxes", 2 * froxels, MemoryUse::Upload);
    cursors_ = buffer("froxel cursors", froxels * sizeof(uint32_t), MemoryUse::Device);
    found_ = buffer("baseline evaluations", size.x * size.y * sizeof(uint32_t), MemoryUse::Device);
    for (size_t i = 0; i < 2; ++i) {
        Lists& l = lists_[i];
        const VkDeviceSize heads = i == 0 ? tiles : froxels + 1;
        l.heads = buffer("baseline heads", heads * sizeof(uint32_t), MemoryUse::Device);
        l.entries = buffer("baseline entries", firstEntries * sizeof(uint32_t), MemoryUse::Device);
        l.counters =
            buffer("baseline counters", sizeof(gpu::BaselineCounters), MemoryUse::Readback);
        l.grid = buffer("baseline grid", sizeof(gpu::BaselineGrid), MemoryUse::Upload);
        l.grid.as<gpu::BaselineGrid>()[0] = {.count = grids[i], .nearest = 1, .slicesPerOctave = 1};
        sets_.shade[i] = kernels_.shade[i].createBindings(1);
        sets_.pairs[i] = kernels_.pairs[i].createBindings(1);
    }
    sets_.prepare = kernels_.prepare.createBindings(1);
    sets_.spheres = kernels_.spheres.createBindings(1);
    sets_.tiles = kernels_.tiles.createBindings(1);
    sets_.count = kernels_.count.createBindings(1);
    sets_.enter = kernels_.enter.createBindings(1);
    sets_.scan = kernels_.scan.createBindings(1);
    sets_.floor = kernels_.floor.createBindings(1);
    writeBindings();
    submit([&](const gpu::Frame& f) { dfg_.recordFill(f); });
    fitLists(Baseline::Tiles);
    createFroxels();
    fitLists(Baseline::Froxels);
    for (const Baseline b : {Baseline::Froxels, Baseline::Tiles})
        countPairs(b);
}

void Baselines::createLights(const Scene& scene)
{
    const gpu::Device& device = context_.device();
    std::vector<CndLight> lights;
    lightsAtTime(scene, 0, lights);
    for (const CndLight& light : lights)
        if (light.type != CND_LIGHT_SPHERE)
            throw RunError("the baselines of culling take sphere lights only");
    lightCount_ = uint32_t(lights.size());
    lightOrigin_ = scene.lightOrigin;
    const VkDeviceSize n = lightCount_;
    records_ = gpu::createBuffer(device, "baseline records", n * sizeof(gpu::LightRecord),
                                 storageUse, MemoryUse::Upload);
    order_ = gpu::createBuffer(device, "baseline order", n * sizeof(gpu::LightKey), storageUse,
                               MemoryUse::Upload);
    lighting::packLights(lights, records_.as<gpu::LightRecord>());
    for (uint32_t i = 0; i < lightCount_; ++i)
        order_.as<gpu::LightKey>()[i] = {.key = 0, .light = i};
    core_ = texels(device, "baseline core", std::max<VkDeviceSize>(n, gpu::FLOOR_LIGHTS) * 2,
                   MemoryUse::Device);
    shapes_ = gpu::createBuffer(device, "baseline shapes", n * sizeof(gpu::LightShape), storageUse,
                                MemoryUse::Device);
    spheres_ = texels(device, "baseline spheres", n, MemoryUse::Device);
}

// The grid of froxels between the nearest and the farthest surface, whose depths were found while
// the tiles were fitted to the depth buffer.
void Baselines::createFroxels()
{
    double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
    for (const glm::vec2& range : ranges_.as<glm::vec2>())
        if (range.y > 0) {
            nearest = std::min(nearest, double(range.x));
            farthest = std::max(farthest, double(range.y));
        }
    if (farthest == 0)
        nearest = farthest = 1; // no pixel shows a surface
    nearest *= 0.999;
    farthest *= 1.001;
    gpu::BaselineGrid& grid = lists_[1].grid.as<gpu::BaselineGrid>()[0];
    grid.nearest = float(nearest);
    grid.slicesPerOctave = float(gpu::FROXEL_SLICES / std::log2(farthest / nearest));
    froxels_ = grid;
    const auto boxes = boxes_.as<glm::vec4>();
    const gpu::Projection& m = params_.projection;
    const glm::dvec2 size(frame_.width, frame_.height);
    size_t at = 0;
    for (uint32_t z = 0; z < gpu::FROXEL_SLICES; ++z)
        for (uint32_t y = 0; y < grid.count.y; ++y)
            for (uint32_t x = 0; x < grid.count.x; ++x) {
                glm::dvec3 low(1e30), high(-1e30);
                for (uint32_t corner = 0; corner < 8; ++corner) {
                    const glm::uvec3 c(corner & 1, corner >> 1 & 1, corner >> 2);
                    const glm::dvec2 pixel(double(x + c.x) * gpu::FROXEL_SIZE,
                                           double(y + c.y) * gpu::FROXEL_SIZE);
                    const glm::dvec2 ndc = 2.0 * pixel / size - 1.0;
                    const double d =
                        nearest * std::exp2(double(z + c.z) / double(grid.slicesPerOctave));
                    const glm::dvec3 p((ndc.x + double(m.m20)) * d / double(m.m00),
                                       (ndc.y + double(m.m21)) * d / double(m.m11), -d);
                    low = glm::min(low, p);
                    high = glm::max(high, p);
                }
                const glm::dvec3 margin(1e-5 * -low.z);
                boxes[at++] = glm::vec4(glm::vec3(low - margin), 0);
                boxes[at++] = glm::vec4(glm::vec3(high + margin), 0);
            }
}

void Baselines::writeBindings()
{
    using namespace gpu;
    sets_.prepare.write(
        0, {Binding::of(PREPARE_LIGHTS_RECORDS, records_), Binding::of(PREPARE_LIGHTS_CORE, core_),
            Binding::of(PREPARE_LIGHTS_SHAPES, shapes_), Binding::of(PREPARE_LIGHTS_ORDER, order_),
            // The next two are bound, but neither written nor read.
            Binding::of(PREPARE_LIGHTS_IDS, order_), Binding::of(PREPARE_LIGHTS_POLYGONS, order_)});
    sets_.spheres.write(0, {Binding::of(BASELINE_SPHERES_CORE, core_),
                            Binding::of(BASELINE_SPHERES_OUTPUT, spheres_)});
    sets_.tiles.write(0, {Binding::sampled(BASELINE_TILES_DEPTH, frame_.depth),
                          Binding::ofTexels(BASELINE_SPHERE_TEXELS, spheres_),
                          Binding::of(BASELINE_TILES_HEADS, lists_[0].heads),
                          Binding::of(BASELINE_TILES_ENTRIES, lists_[0].entries),
                          Binding::of(BASELINE_TILES_COUNTERS, lists_[0].counters),
                          Binding::of(BASELINE_TILES_RANGES, ranges_),
                          Binding::of(BASELINE_SPHERES, spheres_)});
    for (const Bindings* set : {&sets_.count, &sets_.enter})
        set->write(0, {Binding::ofTexels(BASELINE_SPHERE_TEXELS, spheres_),
                       Binding::ofTexels(BASELINE_FROXELS_BOXES, boxes_),
                       Binding::of(BASELINE_FROXELS_HEADS, lists_[1].heads),
                       Binding::of(BASELINE_FROXELS_CURSORS, cursors_),
                       Binding::of(BASELINE_FROXELS_ENTRIES, lists_[1].entries),
                       Binding::of(BASELINE_SPHERES, spheres_),
                       Binding::of(BASELINE_FROXELS_BOX_WORDS, boxes_)});
    sets_.scan.write(0, {Binding::of(BASELINE_SCAN_HEADS, lists_[1].heads),
                         Binding::of(BASELINE_SCAN_CURSORS, cursors_),
                         Binding::of(BASELINE_SCAN_COUNTERS, lists_[1].counters)});
    const Binding core = Binding::ofTexels(LIGHT_CORE_TEXELS, core_);
    const Binding coreWords = Binding::of(LIGHT_CORE, core_);
    const Binding shapes = Binding::of(SHADE_SHAPES, shapes_);
    const Binding ids = Binding::of(SHADE_LIGHT_IDS, order_); // bound, but not read
    const std::array gbuffer = gbuffer_.views(frame_).bindings();
    const Binding uniforms = uniforms_.at(0);
    const Binding depth = Binding::sampled(SHADE_DEPTH, frame_.depth);
    const Binding radiance = Binding::storage(RADIANCE_IMAGE, frame_.radiance);
    const Binding dfg = Binding::ofTexels(SHADE_DFG, dfg_.buffer());
    const Binding found = Binding::of(BASELINE_FOUND, found_);
    for (size_t i = 0; i < 2; ++i) {
        const Binding heads = Binding::of(BASELINE_HEADS, lists_[i].heads);
        const Binding entries = Binding::of(BASELINE_ENTRIES, lists_[i].entries);
        const Binding grid = Binding::of(BASELINE_GRID, lists_[i].grid);
        sets_.shade[i].write(
            0, {core, coreWords, shapes, ids, uniforms, depth, radiance, dfg, heads, entries, grid},
            gbuffer);
        sets_.pairs[i].write(0,
                             {core, coreWords, shapes, ids, uniforms, depth, dfg, heads, entries,
                              grid, Binding::of(BASELINE_COUNTERS, lists_[i].counters), found},
                             gbuffer);
    }
    sets_.floor.write(0, {core, coreWords, shapes, ids, uniforms, depth, radiance, dfg, found},
                      gbuffer);
}

void Baselines::submit(const std::function<void(const gpu::Frame&)>& record)
{
    context_.submitAndWait([&](VkCommandBuffer cmd) {
        renderer_.recordUnlit(cmd, options_);
        timer_.begin(cmd, 0);
        const gpu::Frame f{context_.device(), cmd, timer_, 0};
        f.barrier();
        record(f);
        f.barrier();
        f.hostBarrier();
        shaderToHostBarrier(context_.device(), cmd);
        renderer_.recordBruteEnd(cmd);
    });
}

gpu::BaselineCounters Baselines::counters(Baseline baseline) const
{
    return lists_[size_t(baseline)].counters.as<gpu::BaselineCounters>()[0];
}

// Draws the frame again with larger buffers until the lists fit.
void Baselines::fitLists(Baseline baseline)
{
    Lists& lists = lists_[size_t(baseline)];
    const VkDeviceSize limit = context_.device().limits.maxStorageBufferRange;
    for (;;) {
        submit([&](const gpu::Frame& f) { recordCulling(f, baseline); });
        const gpu::BaselineCounters c = counters(baseline);
        const bool tiles = baseline == Baseline::Tiles;
        lists.stats.listEntries = c.listEntries;
        lists.stats.listBytes =
            lists.heads.size +
            sizeof(uint32_t) * VkDeviceSize(tiles ? c.entryCursor : c.listEntries);
        if (!c.overflowed)
            return;
        const VkDeviceSize bytes = 2 * lists.entries.size;
        if (bytes > limit)
            throw RunError("the lists of a baseline do not fit the device's maxStorageBufferRange");
        lists.entries = gpu::createBuffer(context_.device(), "baseline entries", bytes, storageUse,
                                          MemoryUse::Device);
        writeBindings();
    }
}

void Baselines::countPairs(Baseline baseline)
{
    const size_t i = size_t(baseline);
    submit([&](const gpu::Frame& f) {
        recordCulling(f, baseline);
        kernels_.pairs[i].dispatch(f, sets_.pairs[i].set(0), {}, groups().x, groups().y);
    });
    const gpu::BaselineCounters c = counters(baseline);
    CullingStats& stats = lists_[i].stats;
    stats.listedPairs = join(c.listedPairs);
    stats.evaluatedPairs = join(c.evaluatedPairs);
    stats.insidePairs = join(c.insidePairs);
    stats.contributingPairs = join(c.contributingPairs);
}

glm::uvec2 Baselines::groups() const
{
    return {divideUp(frame_.width, gpu::TILE_SIZE), divideUp(frame_.height, gpu::TILE_SIZE)};
}

void Baselines::recordLights(const gpu::Frame& f) const
{
    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, frame_.camera.viewFromWorld, sizeof viewFromWorld);
    const gpu::PrepareLightsParams params{
        .viewFromWorld = glm::mat3(glm::dmat3(viewFromWorld)),
        .originView = glm::vec3(viewFromWorld * glm::dvec4(lightOrigin_, 1)),
        .lightCount = lightCount_,
        .layers = gpu::ALL_LAYERS};
    kernels_.prepare.dispatch(f, sets_.prepare.set(0), params,
                              divideUp(lightCount_, gpu::PREPARE_LIGHTS_GROUP));
    f.barrier();
    kernels_.spheres.dispatch(f, sets_.spheres.set(0), {lightCount_},
                              divideUp(lightCount_, gpu::BASELINE_GROUP));
    f.barrier();
}

void Baselines::recordTiles(const gpu::Frame& f) const
{
    const glm::uvec2 count = lists_[0].grid.as<gpu::BaselineGrid>()[0].count;
    gpu::BaselineTilesParams params{.projection = params_.projection,
                                    .size = {frame_.width, frame_.height},
                                    .tileCountX = count.x,
                                    .tileCount = count.x * count.y,
                                    .firstLight = 0,
                                    .endLight = 0,
                                    .entryCapacity =
                                        uint32_t(lists_[0].entries.size / sizeof(uint32_t)),
                                    .clearDepth = frame_.clearDepth,
                                    .invImageSize = 1.0f / glm::vec2(frame_.width, frame_.height)};
    // 32 lights take at most 68 iterations of loops: for each light one to test and one to write
    // it, one more for all 32, and the exits of three loops.
    constexpr uint32_t pixelIterations = 1024;
    const uint32_t limit = context_.device().maxLoopIterations;
    const uint32_t batch = limit == UINT32_MAX ? lightCount_ : (limit - pixelIterations) / 68 * 32;
    for (uint32_t first = 0; first < lightCount_; first = params.endLight) {
        params.firstLight = first;
        params.endLight = first + std::min(batch, lightCount_ - first);
        kernels_.tiles.dispatch(f, sets_.tiles.set(0), params,
                                divideUp(params.tileCount, gpu::BASELINE_GROUP));
        f.barrier();
    }
}

void Baselines::recordFroxels(const gpu::Frame& f) const
{
    const uint32_t capacity = uint32_t(lists_[1].entries.size / sizeof(uint32_t));
    const gpu::BaselineFroxelsParams params{.projection = params_.projection,
                                            .froxelCount = froxels_.count,
                                            .pixelsPerNdc =
                                                0.5f * glm::vec2(frame_.width, frame_.height),
                                            .nearest = froxels_.nearest,
                                            .slicesPerOctave = froxels_.slicesPerOctave,
                                            .lightCount = lightCount_,
                                            .entryCapacity = capacity};
    const uint32_t lights = divideUp(lightCount_, gpu::BASELINE_GROUP);
    kernels_.count.dispatch(f, sets_.count.set(0), params, lights);
    f.barrier();
    const uint32_t froxels = froxels_.count.x * froxels_.count.y * gpu::FROXEL_SLICES;
    kernels_.scan.dispatch(f, sets_.scan.set(0), {froxels, capacity}, 1);
    f.barrier();
    kernels_.enter.dispatch(f, sets_.enter.set(0), params, lights);
    f.barrier();
}

void Baselines::recordCulling(const gpu::Frame& f, Baseline baseline) const
{
    const Lists& lists = lists_[size_t(baseline)];
    f.device.CmdFillBuffer(f.cmd, lists.counters.get(), 0, VK_WHOLE_SIZE, 0);
    f.device.CmdFillBuffer(f.cmd, lists.heads.get(), 0, VK_WHOLE_SIZE, 0);
    f.barrier();
    recordLights(f);
    if (baseline == Baseline::Tiles)
        recordTiles(f);
    else
        recordFroxels(f);
}

std::vector<PassTime> Baselines::draw(Baseline baseline)
{
    submit([&](const gpu::Frame& f) {
        const auto [x, y] = std::pair(groups().x, groups().y);
        if (baseline == Baseline::Floor) {
            kernels_.floor.dispatch(f, sets_.floor.set(0), {}, x, y);
            return;
        }
        const size_t i = size_t(baseline);
        recordCulling(f, baseline);
        kernels_.shade[i].dispatch(f, sets_.shade[i].set(0), {}, x, y);
    });
    std::vector<CndKernelTime> times(CND_MAX_KERNEL_TIMES);
    uint32_t count = 0;
    if (timer_.read(0, times.data(), count) != CND_SUCCESS)
        count = 0;
    return passesOf({times.data(), count});
}

} // namespace candelabra::app
