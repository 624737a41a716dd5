// SPDX-License-Identifier: Apache-2.0
#include "measure/profile/profile_trace.h"

#include <algorithm>

namespace candelabra::app
{
namespace
{

// The thread identifiers of the trace, each of which is a track in a viewer.
constexpr uint32_t cpuTrack = 1, gpuFrameTrack = 2, gpuPassTrack = 3;

} // namespace

double ProfileTrace::microseconds(CpuClock::time_point t) const
{
    return std::chrono::duration<double, std::micro>(t - begin_).count();
}

void ProfileTrace::slice(const char* category, uint32_t thread, const std::string& name,
                         double from, double to, const Json& arguments)
{
    events_.push_back({{"name", name},
                       {"cat", category},
                       {"ph", "X"},
                       {"pid", 1},
                       {"tid", thread},
                       {"ts", from},
                       {"dur", to - from},
                       {"args", arguments}});
}

void ProfileTrace::add(size_t variant, const CpuSpans& cpu, const FrameStats& stats,
                       const GpuClock& clock)
{
    if (!frames_)
        begin_ = cpu.start;
    const Json frame{{"frame", frames_}, {"variant", variants_[variant]}};
    const double start = microseconds(cpu.start), uploaded = microseconds(cpu.uploaded),
                 recorded = microseconds(cpu.recorded), submitted = microseconds(cpu.submitted),
                 done = microseconds(cpu.done);
    slice("cpu", cpuTrack, "frame", start, done, frame);
    if (uploaded > start)
        slice("cpu", cpuTrack, "upload", start, uploaded, frame);
    slice("cpu", cpuTrack, "record", uploaded, recorded, frame);
    slice("cpu", cpuTrack, "submit", recorded, submitted, frame);
    slice("cpu", cpuTrack, "wait", submitted, done, frame);

    const double first = microseconds(clock.cpuTime(stats.gpuStartMs));
    for (const PassTime& pass : stats.passes) {
        const double from = first + 1000 * pass.startMs;
        Json arguments = frame;
        arguments["runs"] = pass.runs;
        slice("gpu", gpuPassTrack, pass.name, from, from + 1000 * pass.ms, arguments);
    }
    if (stats.gpuMs > 0) {
        slice("gpu", gpuFrameTrack, "frame", first, first + 1000 * stats.gpuMs, frame);
        // An arrow from the submission to the frame on the GPU.
        Json flow{{"name", "submit"}, {"cat", "flow"},   {"ph", "s"},     {"id", frames_},
                  {"pid", 1},         {"tid", cpuTrack}, {"ts", recorded}};
        events_.push_back(flow);
        flow["ph"] = "f";
        flow["bp"] = "e";
        flow["tid"] = gpuFrameTrack;
        flow["ts"] = first;
        events_.push_back(flow);
    }
    uncertaintyMs_ = std::max(uncertaintyMs_, clock.uncertaintyMs());
    alignedBy_ = clock.method();
    ++frames_;
}

std::string ProfileTrace::text(const Json& provenance) const
{
    Json events = Json::array();
    const auto named = [&](const char* what, uint32_t thread, const char* name) {
        events.push_back(
            {{"name", what}, {"ph", "M"}, {"pid", 1}, {"tid", thread}, {"args", {{"name", name}}}});
    };
    named("process_name", 0, "candelabra profile");
    named("thread_name", cpuTrack, "CPU");
    named("thread_name", gpuFrameTrack, "GPU frames");
    named("thread_name", gpuPassTrack, "GPU passes");
    events.insert(events.end(), events_.begin(), events_.end());
    const Json out{{"traceEvents", events},
                   {"displayTimeUnit", "ms"},
                   {"otherData",
                    {{"schema", "candelabra trace 1"},
                     {"provenance", provenance},
                     {"clocksAlignedBy", alignedBy_},
                     {"uncertaintyMs", uncertaintyMs_}}}};
    return out.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace candelabra::app
