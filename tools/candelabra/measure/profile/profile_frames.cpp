// SPDX-License-Identifier: Apache-2.0
#include "measure/profile/profile_frames.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "io/statistics.h"
#include "measure/frame/frames.h"
#include "render/frame_ring.h"

namespace candelabra::app
{
namespace
{

// Whether the last warmUpWindow values say the same as those before.
bool isStable(const std::vector<double>& ms)
{
    if (ms.size() < 2 * warmUpWindow)
        return false;
    const auto middle = ms.end() - warmUpWindow;
    const double before = medianOf({middle - warmUpWindow, middle}),
                 now = medianOf({middle, ms.end()});
    return std::abs(now - before) <= stable * before;
}

} // namespace

void FrameSeries::add(const FrameStats& frame, const CpuSpans& cpu, double stampMs)
{
    for (Pass& pass : passes)
        pass.ms.push_back(0);
    double sum = 0;
    for (const PassTime& time : frame.passes) {
        auto pass = std::find_if(passes.begin(), passes.end(),
                                 [&](const Pass& p) { return p.name == time.name; });
        if (pass == passes.end())
            pass = passes.insert(pass, {time.name, std::vector<double>(gpuMs.size() + 1)});
        const double ms = std::max(0.0, time.ms - time.runs * stampMs);
        pass->ms.back() += ms;
        sum += ms;
    }
    gpuMs.push_back(sum);
    spanMs.push_back(std::max(0.0, frame.gpuMs - frame.stamps * stampMs));
    uploadMs.push_back(msBetween(cpu.start, cpu.uploaded));
    recordMs.push_back(msBetween(cpu.uploaded, cpu.recorded));
    frameMs.push_back(msBetween(cpu.start, cpu.done));
    stamps.push_back(frame.stamps);
}

double FrameSeries::shadingMs() const
{
    double ms = 0;
    for (const Pass& pass : passes)
        if (pass.name == "shade_tiles" || pass.name == "shade_unlisted")
            ms += medianOf(pass.ms);
    return ms;
}

ProfilingOverhead overheadOf(const FrameSeries& series, double stampMs)
{
    ProfilingOverhead out{.stamps = medianOf(series.stamps)};
    const double all = out.stamps * stampMs, span = medianOf(series.spanMs);
    out.share = span > 0 ? all / span : 0;
    std::vector<double> passes;
    for (size_t i = 0; i < series.gpuMs.size(); ++i)
        passes.push_back(series.spanMs[i] > 0 ? series.gpuMs[i] / series.spanMs[i] : 0);
    out.passes = medianOf(passes);
    return out;
}

Camera cameraAt(const Camera& camera, CameraPath path, uint32_t i, uint32_t rounds)
{
    if (path == CameraPath::Still)
        return camera;
    Camera turned = camera;
    const double angle = 2 * std::numbers::pi * i / std::max(rounds, 1u);
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1), angle, glm::dvec3(0, 1, 0));
    turned.forward = glm::dvec3(turn * glm::dvec4(camera.forward, 0));
    turned.up = glm::dvec3(turn * glm::dvec4(camera.up, 0));
    return turned;
}

Profile profileFrames(const VulkanContext& context, Renderer& renderer,
                      const ProfileSettings& settings, ProfileTrace* trace,
                      const std::function<void()>& onRound)
{
    GpuClock clock(context);
    FrameRing ring(context, 1);
    Profile out{.series = std::vector<FrameSeries>(settings.variants.size()),
                .stampMs = clock.stampMs()};
    bool traced = false;
    out.last.resize(settings.variants.size());
    double time = settings.variants[0].time;
    const auto round = [&](uint32_t i, std::vector<FrameSeries>& into) {
        for (size_t k = 0; k < settings.variants.size(); ++k) {
            // Whatever grows through a round weighs on each variant alike.
            const size_t v = i % 2 ? settings.variants.size() - 1 - k : k;
            FrameOptions options = settings.variants[v];
            options.camera = cameraAt(options.camera, settings.path, i, settings.rounds);
            options.time = time;
            const auto [cmd, slot, reused] = ring.begin();
            CpuSpans cpu{.start = CpuClock::now()};
            if (settings.moving)
                renderer.moveLights(time);
            cpu.uploaded = settings.moving ? CpuClock::now() : cpu.start;
            renderer.record(cmd, slot, options);
            cpu.recorded = CpuClock::now();
            ring.submit();
            cpu.submitted = CpuClock::now();
            ring.wait();
            cpu.done = CpuClock::now();
            out.last[v] = renderer.stats(slot);
            into[v].add(out.last[v], cpu, out.stampMs);
            if (traced) {
                clock.calibrate();
                trace->add(v, cpu, out.last[v], clock);
            }
        }
        if (settings.moving)
            time += frameTime;
        onRound();
    };
    std::vector<FrameSeries> warmUp(settings.variants.size());
    while (!out.settled && out.warmUpRounds < maxWarmUp) {
        round(out.warmUpRounds++, warmUp);
        out.settled = std::all_of(warmUp.begin(), warmUp.end(),
                                  [](const FrameSeries& s) { return isStable(s.frameMs); });
    }
    time = settings.variants[0].time;
    traced = trace != nullptr;
    for (uint32_t i = 0; i < settings.rounds; ++i)
        round(i, out.series);
    return out;
}

} // namespace candelabra::app
