// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "lighting/camera.h"
#include "lighting/lighting.h"

namespace candelabra::lighting
{
namespace
{

using gpu::divideUp;

constexpr VkDeviceSize defaultListBudget = 64u << 20;
// Bytes of coarse masks; when light count and resolution need more, coarse tiles get larger.
constexpr VkDeviceSize maskBudget = 64u << 20;
constexpr uint32_t maxGroupsPerDimension = 65535; // Vulkan's guaranteed maxComputeWorkGroupCount
constexpr uint32_t maxSide = 16384;               // pixels, of a view
constexpr uint32_t defaultSampleCount = 64;
constexpr uint32_t maxSampleCount = 4096;
static_assert(maxSide / gpu::TILE_SIZE * (maxSide / gpu::TILE_SIZE) <=
              maxGroupsPerDimension * gpu::TILE_BOUNDS_GROUP);

constexpr VkBufferUsageFlags storageUse = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

struct Readback {
    gpu::LightingCounters counters;
    uint32_t marker; // low half of the recording's number, written last
};

uint32_t tiles(uint32_t pixels)
{
    return divideUp(pixels, gpu::TILE_SIZE);
}

uint64_t join(glm::uvec2 lowHigh)
{
    return uint64_t(lowHigh.y) << 32 | lowHigh.x;
}

bool readsDirectionalAlbedo(const CndLightingFrame& frame)
{
    return frame.lobes != CND_LOBES_SUM || frame.energyCompensation;
}

// Of loops inside the evaluation of one light, at most: outlines of tubes have 16 edges and are
// walked for the diffuse lobe and two specular ones, discs have a series of 9 terms.
uint32_t loopIterations(uint32_t lightType, CndSpecularMethod method, uint32_t sampleCount)
{
    const uint32_t shape = lightType == CND_LIGHT_TUBE ? 64 : isSphere(lightType) ? 0 : 24;
    return shape + (method == CND_SPECULAR_SAMPLED ? sampleCount : 0);
}

CndLightingViewDesc checked(const gpu::Device& device, CndLightingViewDesc desc)
{
    if (desc.structSize != sizeof desc)
        gpu::failArgument("CndLightingViewDesc: structSize is " + std::to_string(desc.structSize) +
                          ", this library expects " + std::to_string(sizeof desc));
    for (const uint32_t side : {desc.maxWidth, desc.maxHeight})
        if (side < 1 || side > maxSide)
            gpu::failArgument("CndLightingViewDesc: maxWidth and maxHeight must be 1..16384, are " +
                              std::to_string(desc.maxWidth) + " and " +
                              std::to_string(desc.maxHeight));
    if (!desc.listBudget)
        desc.listBudget =
            std::min<VkDeviceSize>(defaultListBudget, device.limits.maxStorageBufferRange);
    if (desc.listBudget > device.limits.maxStorageBufferRange)
        gpu::failUnsupported("CndLightingViewDesc: listBudget " + std::to_string(desc.listBudget) +
                             " exceeds the device's maxStorageBufferRange " +
                             std::to_string(device.limits.maxStorageBufferRange));
    return desc;
}

} // namespace

// Everything a frame's dispatches are sized with.
struct View::Plan {
    gpu::Projection projection;
    glm::uvec2 size;
    glm::vec2 invImageSize; // one value for all kernels: GPU divisions may differ in the last bit
    float clearDepth;
    uint32_t lightCount;
    uint32_t tileCountX, tileCountY;
    uint32_t factor, coarseCountX, coarseCount;
    uint32_t sampleCount;
    gpu::PrepareLightsParams prepare;
};

View::View(Lighting& lighting, const CndLightingViewDesc& desc)
    : lighting_(lighting),
      desc_(checked(lighting.device(), desc)),
      timer_(lighting.device(), "lighting", lighting.desc().framesInFlight,
             lighting.desc().timestamps),
      slots_(lighting.desc().framesInFlight)
{
    const gpu::Device& device = lighting.device();
    const uint32_t slots = lighting.desc().framesInFlight;
    const Kernels& k = lighting.kernels();
    sets_ = {.prepareLights = k.prepareLights.createBindings(slots),
             .tileBounds = k.tileBounds.createBindings(slots),
             .coarseBounds = k.coarseBounds.createBindings(slots),
             .coarseMasks = k.coarseMasks.createBindings(slots),
             .tileLists = k.tileLists.createBindings(slots),
             .countPairs = k.shade.countPairs(CND_LIGHT_SPHERE).createBindings(slots),
             .shadeTiles = k.shade.anyVariant().tiles.createBindings(slots),
             .shadeBrute = k.shade.anyVariant().brute.createBindings(slots)};
    const VkDeviceSize tileCount = VkDeviceSize(tiles(desc_.maxWidth)) * tiles(desc_.maxHeight);
    const auto make = [&](const char* name, VkDeviceSize bytes, VkBufferUsageFlags use) {
        return gpu::createBuffer(device, name, bytes, use, gpu::MemoryUse::Device);
    };
    tileBounds_ = make("tile bounds", tileCount * sizeof(gpu::TileBounds), storageUse);
    coarseBounds_ = make("coarse bounds", maxCoarseTiles() * sizeof(gpu::TileBounds), storageUse);
    lists_ = make("tile lists", tileCount * sizeof(gpu::TileList), storageUse);
    entries_ = make("list entries", desc_.listBudget, storageUse);
    counters_ =
        make("lighting counters", sizeof(gpu::LightingCounters),
             storageUse | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    for (uint32_t i = 0; i < slots; ++i) {
        readback_.push_back(gpu::createBuffer(device, "lighting statistics", sizeof(Readback),
                                              VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                              gpu::MemoryUse::Readback));
        // Reused memory may hold the marker of an earlier view's recording.
        readback_.back().as<Readback>()[0].marker = 0;
    }
    growLightBuffers();
    lighting.add(this);
}

// Coarse tiles of the largest frame when they are as small as they get.
VkDeviceSize View::maxCoarseTiles() const
{
    return VkDeviceSize(divideUp(tiles(desc_.maxWidth), gpu::COARSE_FACTOR_MIN)) *
           divideUp(tiles(desc_.maxHeight), gpu::COARSE_FACTOR_MIN);
}

// Mask words of one coarse tile and one batch of at most `lights`.
VkDeviceSize View::maskRowBytes(uint32_t lights) const
{
    const uint32_t batch = std::min(lights, lighting_.lightsPerBatch(0));
    return VkDeviceSize(divideUp(batch, gpu::MASK_BITS)) * sizeof(uint32_t);
}

void View::growLightBuffers()
{
    const gpu::Device& device = lighting_.device();
    const VkDeviceSize lights = lighting_.lightCapacity();
    gpu::Buffer core = gpu::createBuffer(
        device, "light core", lights * gpu::LIGHT_CORE_STRIDE * sizeof(glm::vec4),
        storageUse | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, gpu::MemoryUse::Device);
    gpu::createTexelView(device, core);
    gpu::Buffer aux =
        gpu::createBuffer(device, "light aux", lights * gpu::LIGHT_AUX_STRIDE * sizeof(glm::vec4),
                          storageUse, gpu::MemoryUse::Device);
    const VkDeviceSize rowBytes = maskRowBytes(uint32_t(lights));
    const VkDeviceSize budget =
        std::min<VkDeviceSize>(maskBudget, device.limits.maxStorageBufferRange);
    gpu::Buffer masks = gpu::createBuffer(
        device, "coarse masks", std::max(rowBytes, std::min(rowBytes * maxCoarseTiles(), budget)),
        storageUse, gpu::MemoryUse::Device);
    lighting_.replace(core_, std::move(core));
    lighting_.replace(aux_, std::move(aux));
    lighting_.replace(masks_, std::move(masks));
}

void View::validate(const CndLightingFrame& frame) const
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
    if (!frame.normalRoughness || !frame.albedo || !frame.depth || !frame.radiance ||
        (lighting_.desc().gbufferLayout == CND_GBUFFER_FULL && !frame.specular))
        gpu::failArgument("CndLightingFrame: a G-buffer or radiance view is null");
    const auto isInside = [](int32_t offset, uint32_t extent, uint32_t size) {
        return offset >= 0 && uint32_t(offset) <= size && extent <= size - uint32_t(offset);
    };
    const VkRect2D& r = frame.bruteRect;
    if (!r.extent.width != !r.extent.height)
        gpu::failArgument("CndLightingFrame: bruteRect has only one side of 0 (both mean all)");
    if (!isInside(r.offset.x, r.extent.width, frame.width) ||
        !isInside(r.offset.y, r.extent.height, frame.height))
        gpu::failArgument("CndLightingFrame: bruteRect is not inside the frame");
    checkCamera(frame.camera);
}

View::Plan View::plan(const CndLightingFrame& frame) const
{
    Plan p{.projection = projectionOf(frame.camera.clipFromView, frame.clearDepth),
           .size = {frame.width, frame.height},
           .invImageSize = 1.0f / glm::vec2(frame.width, frame.height),
           .clearDepth = frame.clearDepth,
           .lightCount = lighting_.lightCount(),
           .tileCountX = tiles(frame.width),
           .tileCountY = tiles(frame.height),
           .factor = gpu::COARSE_FACTOR_MIN,
           .sampleCount = frame.sampleCount ? frame.sampleCount : defaultSampleCount};
    const VkDeviceSize rowBytes = maskRowBytes(p.lightCount);
    for (;; p.factor *= 2) {
        p.coarseCountX = divideUp(p.tileCountX, p.factor);
        p.coarseCount = p.coarseCountX * divideUp(p.tileCountY, p.factor);
        if (p.coarseCount == 1 ||
            (p.coarseCount * rowBytes <= masks_.size && p.coarseCount <= maxGroupsPerDimension))
            break;
    }
    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, frame.camera.viewFromWorld, sizeof viewFromWorld);
    const double* o = lighting_.origin();
    p.prepare = {.viewFromWorld = glm::mat3(glm::dmat3(viewFromWorld)),
                 .originView = glm::vec3(viewFromWorld * glm::dvec4(o[0], o[1], o[2], 1)),
                 .lightCount = p.lightCount};
    return p;
}

void View::record(VkCommandBuffer cmd, const CndLightingFrame& frame)
{
    validate(frame);
    const Plan plan = this->plan(frame);
    writeBindings(frame);

    const uint32_t slot = frame.frameSlot;
    slots_[slot] = {lighting_.nextRecording(), plan.lightCount};
    const gpu::Frame f{lighting_.device(), cmd, timer_, slot};
    f.device.beginLabel(cmd, "candelabra lighting");
    timer_.begin(cmd, slot);

    f.barrier(); // against the frame before, which uses the same buffers
    lighting_.recordUpload(cmd, slots_[slot].recording);
    f.device.CmdFillBuffer(cmd, counters_.get(), 0, VK_WHOLE_SIZE, 0);
    f.barrier();
    if (plan.lightCount) {
        lighting_.recordTables(f, readsDirectionalAlbedo(frame));
        recordPrepare(f, plan);
        if (frame.culling == CND_CULLING_CLUSTERED)
            recordBounds(f, plan);
        f.barrier();
        uint32_t first = 0;
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
            const uint32_t end = first + lighting_.typeCounts()[type];
            while (first < end) {
                const uint32_t largest = lighting_.lightsPerBatch(
                    loopIterations(type, frame.specularMethod, plan.sampleCount));
                const Batch batch{type, first, std::min(largest, end - first)};
                if (frame.culling == CND_CULLING_CLUSTERED)
                    recordLists(f, plan, batch);
                recordShading(f, frame, plan, batch);
                f.barrier();
                first += batch.count;
            }
        }
    }
    recordReadback(f);
    f.device.endLabel(cmd);
}

void View::recordPrepare(const gpu::Frame& f, const Plan& plan) const noexcept
{
    lighting_.kernels().prepareLights.dispatch(
        f, sets_.prepareLights.set(f.slot), plan.prepare,
        divideUp(plan.lightCount, gpu::PREPARE_LIGHTS_GROUP));
}

void View::recordBounds(const gpu::Frame& f, const Plan& p) const noexcept
{
    const Kernels& k = lighting_.kernels();
    const uint32_t tileCount = p.tileCountX * p.tileCountY;
    k.tileBounds.dispatch(f, sets_.tileBounds.set(f.slot),
                          {.projection = p.projection,
                           .size = p.size,
                           .tileCountX = p.tileCountX,
                           .tileCount = tileCount,
                           .clearDepth = p.clearDepth,
                           .invImageSize = p.invImageSize},
                          divideUp(tileCount, gpu::TILE_BOUNDS_GROUP));
    f.barrier();
    k.coarseBounds.dispatch(f, sets_.coarseBounds.set(f.slot),
                            {.tileCountX = p.tileCountX,
                             .tileCountY = p.tileCountY,
                             .coarseCountX = p.coarseCountX,
                             .coarseCount = p.coarseCount,
                             .factor = p.factor},
                            divideUp(p.coarseCount, gpu::COARSE_BOUNDS_GROUP));
}

void View::recordLists(const gpu::Frame& f, const Plan& p, Batch batch) const noexcept
{
    const Kernels& k = lighting_.kernels();
    const uint32_t wordCount = divideUp(batch.count, gpu::MASK_BITS);
    if (batch.first) // the whole of the counters was cleared before the first
        f.device.CmdFillBuffer(f.cmd, counters_.get(), offsetof(gpu::LightingCounters, listCursor),
                               sizeof(uint32_t), 0);
    k.coarseMasks.dispatch(f, sets_.coarseMasks.set(f.slot), {batch.first, batch.count, wordCount},
                           divideUp(wordCount, gpu::COARSE_MASKS_GROUP), p.coarseCount);
    f.barrier();
    k.tileLists.dispatch(f, sets_.tileLists.set(f.slot),
                         {.tileCountX = p.tileCountX,
                          .tileCountY = p.tileCountY,
                          .coarseCountX = p.coarseCountX,
                          .factor = p.factor,
                          .wordCount = wordCount,
                          .firstLight = batch.first,
                          .lightCount = batch.count,
                          .capacity = uint32_t(entries_.size / sizeof(uint32_t))},
                         divideUp(p.tileCountX, gpu::TILE_LISTS_GROUP_X),
                         divideUp(p.tileCountY, gpu::TILE_LISTS_GROUP_Y));
    f.barrier();
}

void View::recordShading(const gpu::Frame& f, const CndLightingFrame& frame, const Plan& p,
                         Batch batch) const noexcept
{
    const ShadeKernels& shade = lighting_.kernels().shade;
    gpu::ShadeParams params{.projection = p.projection,
                            .size = p.size,
                            .origin = {0, 0},
                            .firstLight = batch.first,
                            .lightCount = batch.count,
                            .tileCountX = p.tileCountX,
                            .clearDepth = p.clearDepth,
                            .invImageSize = p.invImageSize,
                            .sampleCount = p.sampleCount,
                            .sampleSeed = frame.sampleSeed,
                            .errorBudget = frame.errorBudget,
                            .lobes = uint32_t(frame.lobes),
                            .energyCompensation = frame.energyCompensation != VK_FALSE};
    const ShadeKernels::Variant& kernels =
        shade.variant(batch.type, frame.specularMethod, frame.errorBudget > 0);
    if (frame.culling == CND_CULLING_BRUTE) {
        const VkRect2D& r = frame.bruteRect;
        if (r.extent.width && r.extent.height) {
            params.origin = {r.offset.x, r.offset.y};
            params.size = params.origin + glm::uvec2(r.extent.width, r.extent.height);
        }
        const glm::uvec2 pixels = params.size - params.origin;
        kernels.brute.dispatch(f, sets_.shadeBrute.set(f.slot), params, tiles(pixels.x),
                               tiles(pixels.y));
        return;
    }
    kernels.tiles.dispatch(f, sets_.shadeTiles.set(f.slot), params, p.tileCountX, p.tileCountY);
    if (frame.countPairs)
        shade.countPairs(batch.type)
            .dispatch(f, sets_.countPairs.set(f.slot), params, p.tileCountX, p.tileCountY);
}

void View::recordReadback(const gpu::Frame& f) const noexcept
{
    const gpu::Device& d = f.device;
    const VkBuffer target = readback_[f.slot].get();
    const VkBufferCopy copy{.size = sizeof(gpu::LightingCounters)};
    d.CmdCopyBuffer(f.cmd, counters_.get(), target, 1, &copy);
    f.barrier(); // the marker says that all of the frame is done
    d.CmdFillBuffer(f.cmd, target, offsetof(Readback, marker), sizeof(uint32_t),
                    uint32_t(slots_[f.slot].recording));
    f.hostBarrier();
}

uint64_t View::oldestRunning() const
{
    uint64_t oldest = 0;
    for (size_t i = 0; i < slots_.size(); ++i) {
        const uint64_t recording = slots_[i].recording;
        const bool finished = readback_[i].as<Readback>()[0].marker == uint32_t(recording);
        if (recording && !finished && (!oldest || recording < oldest))
            oldest = recording;
    }
    return oldest;
}

uint64_t View::oldestPending() const
{
    uint64_t oldest = 0;
    for (const SlotState& slot : slots_)
        if (slot.recording && (!oldest || slot.recording < oldest))
            oldest = slot.recording;
    return oldest;
}

CndResult View::stats(uint32_t slot, CndLightingStats& out) const noexcept
{
    if (slot >= slots_.size() || !slots_[slot].recording || out.structSize != sizeof out)
        return CND_ERROR_INVALID_ARGUMENT;
    const Readback read = readback_[slot].as<Readback>()[0];
    if (read.marker != uint32_t(slots_[slot].recording))
        return CND_NOT_READY;
    const gpu::LightingCounters& c = read.counters;
    out.lightCount = slots_[slot].lightCount;
    out.tileCount = c.surfaceTiles;
    out.listEntries = c.listEntries;
    out.maxListLength = c.maxListLength;
    out.unlistedTiles = c.unlistedTiles;
    out.listedPairs = join(c.listedPairs);
    out.insidePairs = join(c.insidePairs);
    out.evaluatedPairs = join(c.evaluatedPairs);
    return timer_.read(slot, out.kernelTimes, out.kernelTimeCount) ? CND_SUCCESS : CND_NOT_READY;
}

} // namespace candelabra::lighting
