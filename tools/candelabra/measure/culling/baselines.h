// SPDX-License-Identifier: Apache-2.0
// Other ways to cull the lights of a frame: tiles of 16x16 pixels between their lowest and highest
// depth (Lauritzen 2010), a grid of froxels (Persson 2013), and the floor, which does not cull at
// all. They shade with the engine's functions by the closed form, so that only culling and lists
// differ. Lights are sphere lights in the order of the scene, and the camera is a perspective one.
#pragma once

#include <vector>

#include "gpu/kernel.h"
#include "measure/culling/culling.h"
#include "render/renderer.h"
#include "shared/baselines.h"
#include "surfaces/frame_uniforms.h"
#include "surfaces/host_gbuffer.h"
#include "tables/dfg_table.h"

namespace candelabra::app
{

enum class Baseline { Tiles, Froxels, Floor };

class Baselines
{
public:
    // Prepares for one frame that `renderer` draws of `scene`; both must outlive the object. The
    // frame is drawn to find the sizes of the buffers, so that no list is cut. Throws RunError if
    // the lists do not fit into the device, and for lights that are not spheres.
    Baselines(const VulkanContext& context, Renderer& renderer, const Scene& scene,
              const FrameOptions& options);

    // Draws the frame and returns the times of its passes. The radiance ends as after
    // Renderer::record.
    std::vector<PassTime> draw(Baseline baseline);
    // The statistics of the lists of Baseline::Tiles or Baseline::Froxels.
    CullingStats stats(Baseline baseline) const { return lists_[size_t(baseline)].stats; }

private:
    struct Kernels {
        explicit Kernels(const gpu::Device& device);
        gpu::Kernel<gpu::PrepareLightsParams> prepare;
        gpu::Kernel<gpu::BaselineSpheresParams> spheres;
        gpu::Kernel<gpu::BaselineTilesParams> tiles;
        gpu::Kernel<gpu::BaselineFroxelsParams> count, enter;
        gpu::Kernel<gpu::BaselineScanParams> scan;
        gpu::Kernel<gpu::NoParams> shade[2], pairs[2], floor;
    };
    struct Lists {
        gpu::Buffer heads, entries, counters, grid;
        CullingStats stats;
    };
    void createLights(const Scene& scene);
    void createFroxels();
    void writeBindings();
    void fitLists(Baseline baseline);
    void countPairs(Baseline baseline);
    void recordLights(const gpu::Frame& f) const;
    void recordTiles(const gpu::Frame& f) const;
    void recordFroxels(const gpu::Frame& f) const;
    void recordCulling(const gpu::Frame& f, Baseline baseline) const;
    void submit(const std::function<void(const gpu::Frame&)>& record);
    gpu::BaselineCounters counters(Baseline baseline) const;
    glm::uvec2 groups() const; // workgroups of the shading kernels

    const VulkanContext& context_;
    Renderer& renderer_;
    FrameOptions options_;
    CndLightingFrame frame_;
    surfaces::GBufferSource gbuffer_;
    gpu::FrameParams params_; // of frame_
    Kernels kernels_;
    gpu::Timer timer_;
    tables::DfgTable dfg_;
    uint32_t lightCount_ = 0;
    glm::dvec3 lightOrigin_{0};
    gpu::Buffer records_, order_, core_, shapes_, spheres_;
    gpu::Buffer ranges_, boxes_, cursors_, found_;
    surfaces::FrameUniforms uniforms_;
    Lists lists_[2];
    gpu::BaselineGrid froxels_{};
    struct Sets {
        gpu::Bindings prepare, spheres, tiles, count, enter, scan, shade[2], pairs[2], floor;
    } sets_;
};

} // namespace candelabra::app
