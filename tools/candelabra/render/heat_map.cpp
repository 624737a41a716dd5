// SPDX-License-Identifier: Apache-2.0
#include "render/heat_map.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "candelabra/candelabra.h"
#include "candelabra_program_shaders.h"
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

std::span<const LegendEntry> classesOf(HeatMap which)
{
    return which == HeatMap::Shadow ? visibilities : pixelClasses;
}

Legend logarithmicLegend(const char* title, uint32_t scale)
{
    std::vector<LegendMark> marks;
    for (const int lights : {0, 1, 3, 10, 30, 100, 300, 1000})
        marks.push_back({std::log(1.0f + float(lights)) / std::log(1.0f + gpu::HEAT_MAP_MOST),
                         fmt::format("{}", lights)});
    return barLegend(title, marks, scale);
}

} // namespace

Legend heatMapLegend(HeatMap which, PixelSize size)
{
    const uint32_t scale = std::max(1u, size.height / 360);
    switch (which) {
    case HeatMap::LightsPerPixel:
        return logarithmicLegend("lights in the list of the pixel", scale);
    case HeatMap::Evaluated:
        return logarithmicLegend("lights evaluated, waiting included", scale);
    case HeatMap::Efficiency:
        return barLegend("lights that contribute, of those listed",
                         {{0, "0%"}, {0.25f, "25%"}, {0.5f, "50%"}, {0.75f, "75%"}, {1, "100%"}},
                         scale);
    case HeatMap::Shadow:
        return listLegend("shares of the lights of a pixel",
                          {std::begin(visibilities), std::end(visibilities)}, scale);
    default:
        return listLegend("where a pixel finds its lights",
                          {std::begin(pixelClasses), std::end(pixelClasses)}, scale);
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
                              VK_IMAGE_ASPECT_COLOR_BIT))
{
    for (uint32_t i = 1; i < heatMapCount; ++i) {
        const Legend legend = heatMapLegend(HeatMap(i), size);
        std::vector<uint32_t> all;
        for (uint32_t step = 0; step < gpu::HEAT_MAP_STEPS; ++step)
            all.push_back(packed(viridis(float(step) / float(gpu::HEAT_MAP_STEPS - 1))));
        for (const LegendEntry& c : classesOf(HeatMap(i)))
            all.push_back(packed(c.colour));
        all.insert(all.end(), legend.pixels.begin(), legend.pixels.end());
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
                       Binding::of(gpu::HEAT_MAP_COLOURS, colours.buffer)});
    gpu::Timer untimed;
    const gpu::Frame f{*device_, cmd, untimed, slot};
    f.barrier();
    kernel_.dispatch(f, sets_.set(slot),
                     {.size = {size_.width, size_.height},
                      .legendSize = colours.legendSize,
                      .which = uint32_t(which)},
                     gpu::divideUp(size_.width, gpu::HEAT_MAP_GROUP),
                     gpu::divideUp(size_.height, gpu::HEAT_MAP_GROUP));
}

} // namespace candelabra::app
