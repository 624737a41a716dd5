// SPDX-License-Identifier: Apache-2.0
#include "measure/host/host.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <functional>
#include <numeric>
#include <random>

#include <fmt/format.h>

#include "io/statistics.h"
#include "io/table.h"
#include "load/load.h"
#include "render/camera.h"
#include "render/check.h"
#include "render/renderer.h"
#include "shared/lighting_data.h"

namespace candelabra::app
{
namespace
{

using Clock = std::chrono::steady_clock;

// A memcpy of n bytes reads n and writes n. A call reads a CndLight and writes a LightRecord.
constexpr size_t copiedPerLight = (sizeof(CndLight) + sizeof(gpu::LightRecord)) / 2;
constexpr double framesPerSecond = 60; // of the lights' motion

double millisecondsSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// A separate lighting module for the lights of a scene. Its frames light few surfaces, because the
// GPU's time does not matter.
class HostStage
{
public:
    HostStage(const VulkanContext& context, const Scene& scene, uint32_t seed)
        : context_(context),
          scene_(scene),
          options_{.camera = selectCamera(scene, ""), .lightsVisible = false},
          renderer_(context, scene, {.size = {32, 18}, .lightTypes = 1u << CND_LIGHT_SPHERE}),
          lighting_(valueOrThrow(
              Lighting::create(context.desc(), {.framesInFlight = 1,
                                                .shading = CND_SHADING_CLUSTERED_BIT,
                                                .lightCapacity = uint32_t(scene.lights.size())}))),
          view_(valueOrThrow(lighting_.createView({.maxWidth = 32, .maxHeight = 18}))),
          ids_(scene.lights.size()),
          copy_(scene.lights.size() * copiedPerLight)
    {
        std::iota(ids_.begin(), ids_.end(), CndLightId(0));
        half_ = ids_;
        std::shuffle(half_.begin(), half_.end(), std::mt19937(seed));
        half_.resize((half_.size() + 1) / 2);
        halfLights_.resize(half_.size());
    }
    // Makes every call once and adds its times to `calls`.
    void round(std::vector<HostCall>& calls)
    {
        time_ += 1 / framesPerSecond;
        const uint32_t all = uint32_t(scene_.lights.size()), some = uint32_t(half_.size());
        HostCall* next = calls.data();
        measure(*next++, "move", all, [&] { lightsAtTime(scene_, time_, lights_); });
        const glm::dvec3& o = scene_.lightOrigin;
        measure(*next++, "set all", all, [&] {
            valueOrThrow(lighting_.setLights(lights_, {o.x, o.y, o.z}));
        }).recordingMs.push_back(record());
        measure(*next++, "update all", all, [&] {
            valueOrThrow(lighting_.updateLights(ids_, lights_));
        }).recordingMs.push_back(record());
        for (size_t i = 0; i < half_.size(); ++i)
            halfLights_[i] = lights_[half_[i]];
        measure(*next++, "update half", some, [&] {
            valueOrThrow(lighting_.updateLights(half_, halfLights_));
        }).recordingMs.push_back(record());
    }
    static constexpr size_t callCount = 4;

private:
    HostCall& measure(HostCall& call, const char* name, uint32_t written,
                      const std::function<void()>& run)
    {
        call.name = name;
        call.written = written;
        Clock::time_point start = Clock::now();
        std::memcpy(copy_.data(), scene_.lights.data(), written * copiedPerLight);
        call.memcpyMs.push_back(millisecondsSince(start));
        const std::clock_t cpu = std::clock();
        start = Clock::now();
        run();
        call.ms.push_back(millisecondsSince(start));
        call.cpuMs.push_back(1e3 * double(std::clock() - cpu) / CLOCKS_PER_SEC);
        return call;
    }
    // Returns the milliseconds that recording a frame takes.
    double record()
    {
        double ms = 0;
        context_.submitAndWait([&](VkCommandBuffer cmd) {
            renderer_.recordUnlit(cmd, options_);
            const CndLightingFrame frame = renderer_.lightingFrame(0, options_);
            const Clock::time_point start = Clock::now();
            valueOrThrow(view_.record(cmd, frame));
            ms = millisecondsSince(start);
            renderer_.recordBruteEnd(cmd);
        });
        return ms;
    }

    const VulkanContext& context_;
    const Scene& scene_;
    FrameOptions options_;
    Renderer renderer_;
    Lighting lighting_; // must outlive its view
    LightingView view_;
    double time_ = 0;
    std::vector<CndLight> lights_, halfLights_;
    std::vector<CndLightId> ids_, half_; // half_: in random order
    std::vector<std::byte> copy_;
};

HostPoint measurePoint(const VulkanContext& context, const HostSettings& settings, uint32_t lights,
                       Progress& progress)
{
    const Scene scene =
        loadScene("hall", {.lights = lights, .seed = settings.seed, .moving = true});
    HostStage stage(context, scene, settings.seed);
    std::vector<HostCall> warmUp(HostStage::callCount);
    stage.round(warmUp);
    HostPoint point{.lights = lights, .calls = std::vector<HostCall>(HostStage::callCount)};
    for (uint32_t i = 0; i < settings.rounds; ++i) {
        stage.round(point.calls);
        progress.advance(1);
    }
    return point;
}

} // namespace

std::vector<HostPoint> measureHost(const VulkanContext& context, const HostSettings& settings,
                                   Progress& progress)
{
    std::vector<HostPoint> points;
    for (const uint32_t lights : settings.lights) {
        progress.doing(counted(lights, "light"));
        points.push_back(measurePoint(context, settings, lights, progress));
    }
    return points;
}

std::string hostTable(const std::vector<HostPoint>& points)
{
    Table table({"lights, call",
                 {"call", "ms"},
                 {"CPU time", "ms"},
                 {"per light", "ns"},
                 {"memcpy", "ms"},
                 "call / memcpy",
                 {"recording", "ms"}});
    for (const HostPoint& point : points)
        for (const HostCall& call : point.calls) {
            const double ms = medianOf(call.ms), copy = medianOf(call.memcpyMs);
            table.add({fmt::format("{}, {}", grouped(point.lights), call.name), threeDigits(ms),
                       threeDigits(medianOf(call.cpuMs)), threeDigits(1e6 * ms / call.written),
                       threeDigits(copy), threeDigits(ms / copy),
                       call.recordingMs.empty() ? "" : threeDigits(medianOf(call.recordingMs))});
        }
    return table.text();
}

Json hostJson(const HostSettings& settings, const std::vector<HostPoint>& points)
{
    Json out{{"scene", "hall"},
             {"seed", settings.seed},
             {"rounds", settings.rounds},
             {"points", Json::array()}};
    for (const HostPoint& point : points) {
        Json calls = Json::array();
        for (const HostCall& call : point.calls) {
            calls.push_back({{"name", call.name},
                             {"written", call.written},
                             {"ms", medianOf(call.ms)},
                             {"cpuMs", medianOf(call.cpuMs)},
                             {"memcpyMs", medianOf(call.memcpyMs)}});
            if (!call.recordingMs.empty())
                calls.back()["recordingMs"] = medianOf(call.recordingMs);
        }
        out["points"].push_back({{"lights", point.lights}, {"calls", calls}});
    }
    return out;
}

} // namespace candelabra::app
