// SPDX-License-Identifier: Apache-2.0
#include "render/heat_map.h"

#include <algorithm>
#include <span>

#include "candelabra/candelabra.h"
#include "candelabra_program_shaders.h"
#include "io/table.h"
#include "render/heat_map_legend.h"
#include "render/image_barrier.h"

namespace candelabra::app
{
namespace
{

static_assert(gpu::HEAT_MAP_CLASSES == CND_PIXEL_UNLISTED + 1);

// Colour and text of each CndPixelClass.
const LegendEntry pixelClasses[gpu::HEAT_MAP_CLASSES] = {
    {glm::vec3(0.2f), "no surface"},
    {viridis(0.25f), "one list per tile"},
    {viridis(0.6f), "a list per slice of depth"},
    {viridis(1), "no list, walks the light tree"}};

const LegendEntry visibilities[gpu::HEAT_MAP_CLASSES] = {{glm::vec3(0.2f), "asks for no light"},
                                                         {viridis(1), "lights seen wholly"},
                                                         {viridis(0.6f), "lights seen in part"},
                                                         {viridis(0), "lights not seen at all"}};

bool countsLights(HeatMap which)
{
    return which == HeatMap::LightsPerPixel || which == HeatMap::Evaluated;
}

std::span<const LegendEntry> classesOf(HeatMap which)
{
    return which == HeatMap::Shadow ? visibilities : pixelClasses;
}

// All lights from `most` on have the last colour.
Legend countLegend(const char* title, uint32_t most, uint32_t zoom)
{
    uint32_t unit = most; // a power of ten
    while (unit % 10 == 0)
        unit /= 10;
    const uint32_t parts = unit == 1 ? 2 : unit == 15 ? 3 : unit; // 2, 3 or 5
    std::vector<LegendMark> marks;
    for (uint32_t i = 0; i <= parts; ++i)
        marks.push_back(
            {float(i) / float(parts), grouped(most * i / parts) + (i == parts ? "+" : "")});
    return barLegend(title, marks, zoom);
}

} // namespace

uint32_t heatMapScaleEnd(uint32_t scale)
{
    constexpr uint32_t ends[] = {3, 5, 10, 15, 20}; // then the same times 10, and so on
    uint32_t out = ends[scale % 5];
    for (uint32_t i = 0; i < scale / 5; ++i)
        out *= 10;
    return out;
}

Legend heatMapLegend(HeatMap which, PixelSize size, uint32_t most)
{
    // Letters are at least 10 pixels high where the legend then fits.
    const uint32_t zoom = std::max(1u, std::min(std::max(2u, size.height / 270), size.width / 200));
    switch (which) {
    case HeatMap::LightsPerPixel:
        return countLegend("lights in the list of the pixel", most, zoom);
    case HeatMap::Evaluated:
        return countLegend("lights evaluated, waiting included", most, zoom);
    case HeatMap::Efficiency:
        return barLegend("lights that contribute, of those listed",
                         {{0, "0%"}, {0.25f, "25%"}, {0.5f, "50%"}, {0.75f, "75%"}, {1, "100%"}},
                         zoom);
    case HeatMap::Shadow:
        return listLegend("shares of the lights of a pixel",
                          {std::begin(visibilities), std::end(visibilities)}, zoom);
    default:
        return listLegend("where a pixel finds its lights",
                          {std::begin(pixelClasses), std::end(pixelClasses)}, zoom);
    }
}

HeatMapPass::HeatMapPass(const gpu::Device& device, PixelSize size, uint32_t framesInFlight)
    : device_(&device),
      size_(size),
      kernel_(device, spirv::heat_map_comp),
      sets_(kernel_.createBindings(framesInFlight)),
      pairs_(gpu::createImage(device, "pairs", VK_FORMAT_R32G32B32A32_SFLOAT, size.width,
                              size.height,
                              VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                  VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                              VK_IMAGE_ASPECT_COLOR_BIT)),
      counts_(
          gpu::createBuffer(device, "heat map counts", gpu::HEAT_MAP_SCALES * sizeof(uint32_t),
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                            gpu::MemoryUse::Device))
{
    for (uint32_t i = 1; i < heatMapCount; ++i) {
        const uint32_t scales = countsLights(HeatMap(i)) ? gpu::HEAT_MAP_SCALES : 1;
        std::vector<uint32_t> all;
        for (uint32_t step = 0; step < gpu::HEAT_MAP_STEPS; ++step)
            all.push_back(packed(viridis(float(step) / float(gpu::HEAT_MAP_STEPS - 1))));
        for (const LegendEntry& c : classesOf(HeatMap(i)))
            all.push_back(packed(c.colour));
        for (uint32_t scale = 0; scale < gpu::HEAT_MAP_SCALES; ++scale)
            all.push_back(heatMapScaleEnd(scale));
        Legend legend;
        for (uint32_t scale = 0; scale < scales; ++scale) {
            legend = heatMapLegend(HeatMap(i), size, heatMapScaleEnd(scale));
            all.insert(all.end(), legend.pixels.begin(), legend.pixels.end());
        }
        colours_[i] = {gpu::createBuffer(device, "heat map colours", all.size() * sizeof all[0],
                                         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                         gpu::MemoryUse::Upload),
                       {legend.width, legend.height}};
        std::copy(all.begin(), all.end(), colours_[i].buffer.as<uint32_t>().begin());
    }
}

void HeatMapPass::recordClear(VkCommandBuffer cmd) const
{
    constexpr ImageAccess anything{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_NONE,
                                   VK_IMAGE_LAYOUT_UNDEFINED};
    clearForCompute(cmd, pairs_.image.get(), anything);
}

void HeatMapPass::record(VkCommandBuffer cmd, uint32_t slot, HeatMap which, VkImageView display)
{
    using gpu::Binding;
    const Colours& colours = colours_[size_t(which)];
    sets_.write(slot, {Binding::storage(gpu::HEAT_MAP_PAIRS, pairs()),
                       Binding::storage(gpu::HEAT_MAP_DISPLAY, display),
                       Binding::of(gpu::HEAT_MAP_COLOURS, colours.buffer),
                       Binding::of(gpu::HEAT_MAP_COUNTS, counts_)});
    gpu::Timer untimed;
    const gpu::Frame f{*device_, cmd, untimed, slot};
    const auto dispatch = [&](uint32_t onlyCounts) {
        f.barrier();
        kernel_.dispatch(f, sets_.set(slot),
                         {.size = {size_.width, size_.height},
                          .legendSize = colours.legendSize,
                          .which = uint32_t(which),
                          .onlyCounts = onlyCounts},
                         gpu::divideUp(size_.width, gpu::HEAT_MAP_GROUP),
                         gpu::divideUp(size_.height, gpu::HEAT_MAP_GROUP));
    };
    if (countsLights(which)) {
        f.barrier();
        vkCmdFillBuffer(cmd, counts_.get(), 0, VK_WHOLE_SIZE, 0);
        dispatch(1);
    }
    dispatch(0);
}

} // namespace candelabra::app
