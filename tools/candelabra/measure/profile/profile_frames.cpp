// SPDX-License-Identifier: Apache-2.0
#include "measure/profile/profile_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "io/statistics.h"
#include "measure/frame/frames.h"
#include "render/frame_ring.h"
#include "render/frame_stamps.h"
#include "render/readback.h"

namespace candelabra::app
{

namespace
{

constexpr uint32_t stampsInARow = 100;

// Returns the time that a timestamp adds to a frame: the median of several measurements of
// timestamps in a row. 0 if the device has no timestamps. The GPU must be idle.
double stampCost(const VulkanContext& context)
{
    FrameStamps stamps(context.device(), context.timestampValidBits(), 1, stampsInARow);
    std::vector<double> each;
    for (int round = 0; round < 9; ++round) {
        context.submitAndWait([&](VkCommandBuffer cmd) {
            stamps.begin(cmd, 0);
            for (uint32_t i = 0; i < stampsInARow; ++i)
                stamps.stamp(cmd, 0);
        });
        const std::vector<double> ends = stamps.read(0);
        each.push_back(ends.empty() ? 0 : ends.back() / stampsInARow);
    }
    return medianOf(each);
}

double msBetween(CpuClock::time_point from, CpuClock::time_point to)
{
    return std::chrono::duration<double, std::milli>(to - from).count();
}

// Returns true if the last warmUpWindow values have about the same median as the warmUpWindow
// before.
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

void FrameSeries::add(const FrameStats& frame, const CpuSpans& cpu,
                      CpuClock::time_point previousDone, double stampMs)
{
    for (Pass& pass : passes)
        pass.ms.push_back(0);
    double sum = 0;
    for (const PassTime& time : frame.passes) {
        auto pass = std::ranges::find(passes, time.name, &Pass::name);
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
    frameMs.push_back(msBetween(std::max(cpu.start, previousDone), cpu.done));
    stamps.push_back(frame.stamps);
}

std::vector<double> FrameSeries::shadingMs() const
{
    std::vector<double> ms(gpuMs.size());
    for (const Pass& pass : passes)
        if (pass.name == "shade_tiles" || pass.name == "shade_unlisted")
            std::ranges::transform(ms, pass.ms, ms.begin(), std::plus<>());
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

namespace
{

// Draws frames in a ring, and adds each to a series once the GPU has finished it.
class RingOfFrames
{
public:
    RingOfFrames(const VulkanContext& context, const ProfileSettings& settings)
        : moving_(settings.moving),
          ring_(context, settings.framesInFlight),
          pending_(settings.framesInFlight)
    {
    }
    // `finish(cpu, stats, previousDone)` is called when the GPU has finished the frame: before
    // draw() returns if one frame is in flight, else in a later draw() or in finishAll().
    using Finish =
        std::function<void(const CpuSpans&, const FrameStats&, CpuClock::time_point previousDone)>;
    void draw(Renderer& renderer, const FrameOptions& options, Finish finish)
    {
        const auto [cmd, slot, reused] = ring_.begin();
        if (pending_[slot].finish)
            finished(slot);
        Pending& frame = pending_[slot] = {.renderer = &renderer, .finish = std::move(finish)};
        frame.cpu.start = CpuClock::now();
        if (moving_)
            renderer.moveLights(options.time);
        frame.cpu.uploaded = moving_ ? CpuClock::now() : frame.cpu.start;
        renderer.record(cmd, slot, options);
        frame.cpu.recorded = CpuClock::now();
        ring_.submit();
        next_ = (slot + 1) % ring_.slots();
        if (ring_.slots() == 1)
            finishAll();
    }
    // Waits for the frames in flight, the oldest first.
    void finishAll()
    {
        for (uint32_t i = 0; i < ring_.slots(); ++i) {
            const uint32_t slot = (next_ + i) % ring_.slots();
            if (!pending_[slot].finish)
                continue;
            ring_.wait(slot);
            finished(slot);
        }
    }

private:
    struct Pending {
        Renderer* renderer = nullptr;
        CpuSpans cpu{};
        Finish finish; // empty: the slot has no frame
    };
    void finished(uint32_t slot)
    {
        Pending frame = std::exchange(pending_[slot], {});
        frame.cpu.done = CpuClock::now();
        frame.finish(frame.cpu, frame.renderer->stats(slot), std::exchange(done_, frame.cpu.done));
    }

    bool moving_;
    FrameRing ring_;
    std::vector<Pending> pending_; // by slot
    uint32_t next_ = 0;            // slot of the next frame
    CpuClock::time_point done_{};  // end of the last finished frame
};

} // namespace

Profile profileFrames(const VulkanContext& context, Renderer& renderer,
                      const ProfileSettings& settings, const std::function<void()>& onRound)
{
    RingOfFrames frames(context, settings);
    const auto rendererOf = [&](size_t v) -> Renderer& {
        return v && settings.other ? *settings.other : renderer;
    };
    Profile out{.series = std::vector<FrameSeries>(settings.variants.size()),
                .stampMs = stampCost(context)};
    out.last.resize(settings.variants.size());
    double time = settings.variants[0].time;
    const auto round = [&](uint32_t i, std::vector<FrameSeries>& into) {
        for (size_t k = 0; k < settings.variants.size(); ++k) {
            // The order alternates, so that whatever grows during a round affects all variants
            // alike.
            const size_t v = i % 2 ? settings.variants.size() - 1 - k : k;
            FrameOptions options = settings.variants[v];
            options.camera = cameraAt(options.camera, settings.path, i, settings.rounds);
            options.time = time;
            frames.draw(rendererOf(v), options,
                        [&, v](const CpuSpans& cpu, const FrameStats& stats,
                               CpuClock::time_point previousDone) {
                            into[v].add(stats, cpu, previousDone, out.stampMs);
                            out.last[v] = stats;
                        });
        }
        if (settings.moving)
            time += frameTime;
    };
    std::vector<FrameSeries> warmUp(settings.variants.size());
    const CpuClock::time_point start = CpuClock::now();
    const auto enough = [&] {
        return (out.settled || out.warmUpRounds >= maxWarmUp) &&
               msBetween(start, CpuClock::now()) >= 1000 * settings.warmUpSeconds;
    };
    while (!enough()) {
        round(out.warmUpRounds++, warmUp);
        if (out.warmUpRounds <= maxWarmUp)
            onRound();
        out.settled =
            std::ranges::all_of(warmUp, [](const FrameSeries& s) { return isStable(s.frameMs); });
    }
    frames.finishAll();
    time = settings.variants[0].time;
    for (uint32_t i = 0; i < settings.rounds; ++i) {
        round(i, out.series);
        onRound();
    }
    frames.finishAll();
    for (size_t v = 0; v < settings.variants.size(); ++v) {
        frames.draw(rendererOf(v), settings.variants[v],
                    [](const CpuSpans&, const FrameStats&, CpuClock::time_point) {});
        frames.finishAll();
        out.drawnTriangles.push_back(readDrawnTriangles(context, rendererOf(v)));
    }
    return out;
}

namespace
{

bool hasTime(const std::vector<double>& ms)
{
    return std::ranges::any_of(ms, [](double t) { return t > 0; });
}

std::string percent(double share)
{
    return fmt::format("{:.1f}%", 100 * share);
}

const std::vector<double>* timesOf(const FrameSeries& series, const std::string& pass)
{
    for (const FrameSeries::Pass& p : series.passes)
        if (p.name == pass)
            return &p.ms;
    return nullptr;
}

Json spreadJson(const Spread& s)
{
    return {{"minMs", s.min},
            {"medianMs", s.median},
            {"p95Ms", s.p95},
            {"p99Ms", s.p99},
            {"coefficientOfVariation", s.cv}};
}

// Calls `row(name, times of a, times of b)` for every pass of either and for every time of the
// whole frame.
template <typename Row>
void forBoth(const FrameSeries& a, const FrameSeries& b, Row&& row)
{
    const std::vector<double> none(a.gpuMs.size());
    for (const FrameSeries::Pass& pass : a.passes) {
        const std::vector<double>* other = timesOf(b, pass.name);
        row(pass.name, pass.ms, other ? *other : none);
    }
    for (const FrameSeries::Pass& pass : b.passes)
        if (!timesOf(a, pass.name))
            row(pass.name, none, pass.ms);
    for (const WholeTime& whole : wholeTimes)
        if (hasTime(a.*whole.ms) || hasTime(b.*whole.ms))
            row(whole.name, a.*whole.ms, b.*whole.ms);
}

const char* verdict(const PairedRatio& ratio)
{
    return ratio.isFaster() ? "faster" : ratio.isSlower() ? "slower" : "cannot tell";
}

} // namespace

Table seriesTable(const FrameSeries& series)
{
    Table table({"GPU pass",
                 {"min", "ms"},
                 {"median", "ms"},
                 {"p95", "ms"},
                 {"p99", "ms"},
                 "variation",
                 "share"});
    const double gpu = medianOf(series.gpuMs);
    const auto add = [&](const std::string& name, const std::vector<double>& ms, bool ofGpu) {
        const Spread s = spreadOf(ms);
        table.add({name, threeDigits(s.min), threeDigits(s.median), threeDigits(s.p95),
                   threeDigits(s.p99), percent(s.cv),
                   ofGpu && gpu > 0 ? percent(s.median / gpu) : ""},
                  {.noisy = isNoisy(ms)});
    };
    for (const FrameSeries::Pass& pass : series.passes)
        add(pass.name, pass.ms, true);
    table.rule();
    for (const WholeTime& whole : wholeTimes)
        if (hasTime(series.*whole.ms))
            add(whole.name, series.*whole.ms, false);
    return table;
}

std::string overheadText(const FrameSeries& series, double stampMs)
{
    const ProfilingOverhead o = overheadOf(series, stampMs);
    if (!(o.passes > 0))
        return "The device has no timestamps.\n";
    return fmt::format("Passes add up to {} of the time from the frame's first stamp to its last.\n"
                       "Timing takes {} of it: {} stamps of {} ms a frame, left out above.\n",
                       percent(o.passes), percent(o.share), o.stamps, threeDigits(stampMs));
}

std::string comparisonTable(const FrameSeries& a, const FrameSeries& b)
{
    Table table({"GPU pass", "A median ms", "B median ms", "median of paired B / A", "95% interval",
                 "B is"});
    forBoth(a, b, [&](const std::string& name, const auto& aMs, const auto& bMs) {
        const PairedRatio r = pairedRatio(aMs, bMs);
        const double aMedian = medianOf(aMs), bMedian = medianOf(bMs);
        const bool both = aMedian > 0 && bMedian > 0;
        table.add({name, threeDigits(aMedian), threeDigits(bMedian),
                   both ? fmt::format("{:.3f}", r.median) : "-",
                   both ? fmt::format("{:.3f} .. {:.3f}", r.low, r.high) : "-",
                   both ? verdict(r) : "-"});
    });
    return table.text();
}

Json toJson(const FrameSeries& series)
{
    Json passes = Json::array();
    for (const FrameSeries::Pass& pass : series.passes) {
        Json one{{"name", pass.name}};
        one.update(spreadJson(spreadOf(pass.ms)));
        passes.push_back(one);
    }
    Json out{{"frames", series.gpuMs.size()}, {"passes", passes}};
    for (const WholeTime& whole : wholeTimes)
        out[whole.key] = spreadJson(spreadOf(series.*whole.ms));
    return out;
}

Json overheadJson(const FrameSeries& series, double stampMs)
{
    const ProfilingOverhead o = overheadOf(series, stampMs);
    return {{"stampMs", stampMs},
            {"stamps", o.stamps},
            {"shareOfGpuSpan", o.share},
            {"passesOverGpuSpan", o.passes},
            {"subtracted", true}};
}

Json ratioJson(const std::vector<double>& a, const std::vector<double>& b)
{
    const PairedRatio r = pairedRatio(a, b);
    return {{"aMedianMs", medianOf(a)}, {"bMedianMs", medianOf(b)},
            {"ratio", r.median},        {"low", r.low},
            {"high", r.high},           {"confidence", 0.95},
            {"verdict", verdict(r)}};
}

Json comparisonJson(const FrameSeries& a, const FrameSeries& b)
{
    Json out = Json::array();
    forBoth(a, b, [&](const std::string& name, const auto& aMs, const auto& bMs) {
        Json row{{"name", name}};
        row.update(ratioJson(aMs, bMs));
        out.push_back(row);
    });
    return out;
}

std::string toCsv(const std::vector<std::string>& names, const std::vector<FrameSeries>& series)
{
    std::vector<std::string> passes;
    for (const FrameSeries& s : series)
        for (const FrameSeries::Pass& pass : s.passes)
            if (std::ranges::find(passes, pass.name) == passes.end())
                passes.push_back(pass.name);
    std::string out = "variant,frame";
    for (const std::string& pass : passes)
        out += "," + pass;
    for (const WholeTime& whole : wholeTimes)
        out += fmt::format(",{}", whole.key);
    out += "\n";
    for (size_t v = 0; v < series.size(); ++v)
        for (size_t i = 0; i < series[v].gpuMs.size(); ++i) {
            out += fmt::format("{},{}", names[v], i);
            for (const std::string& pass : passes) {
                const std::vector<double>* ms = timesOf(series[v], pass);
                out += fmt::format(",{:.6f}", ms ? (*ms)[i] : 0.0);
            }
            for (const WholeTime& whole : wholeTimes)
                out += fmt::format(",{:.6f}", (series[v].*whole.ms)[i]);
            out += "\n";
        }
    return out;
}

} // namespace candelabra::app
