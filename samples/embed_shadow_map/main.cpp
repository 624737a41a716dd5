// SPDX-License-Identifier: Apache-2.0
// This sample is a host that draws a shadow map and gives the library its shadow term. The camera
// sees a wall with the shadow of a window frame, because a spot light shines through the frame.
// The lamp of a second light set has no shadow map, so it lights the whole wall. The shadow term
// is the host's own GLSL, and Candelabra's kernels run it. The sample writes embed_shadow_map.ppm
// (or the file named as argument). It compares each pixel of the wall with a closed form, and exits
// with 1 if one is wrong.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <candelabra/compiler.hpp>

#include "picture.h"
#include "shadow_map.h"

constexpr const char* shadowTerm = R"(
layout(set = 1, binding = 0) uniform sampler2DShadow shadowMap;
layout(set = 1, binding = 1, std140) uniform Shadow
{
    mat4 shadowFromView;
    uint shadowedLight;
};
float candelabraVisibility(CndShadowQuery q)
{
    if (q.light != shadowedLight)
        return 1.0; // a light of the set that has no map
    const vec4 clip = shadowFromView * vec4(q.position, 1.0);
    const float bias = 1e-4;
    return clip.w > 0.0 ? textureLod(shadowMap, vec3(0.5 + 0.5 * clip.xy / clip.w,
                                                     clip.z / clip.w - bias), 0.0)
                        : 1.0;
}
)";

constexpr CndLight spot{.type = CND_LIGHT_SPOT,
                        .position = {0.2f, 0.1f, 1},
                        .direction = {0, 0, -1},
                        .emission = {900, 800, 600}, // candela
                        .influenceRadius = 20,
                        .innerConeAngle = 0.75f, // wider than what the camera shows of the wall
                        .outerConeAngle = 0.78f};
// In the set of the spot, but without a map.
constexpr CndLight ember{.type = CND_LIGHT_SPHERE,
                         .position = {1.2f, -0.7f, -1.6f},
                         .radius = 0.05f,
                         .emission = {3000, 300, 0}, // cd/m^2
                         .influenceRadius = 20};
constexpr CndLight lamp{.type = CND_LIGHT_SPHERE, // of the second set
                        .position = {-0.8f, 0.5f, -0.5f},
                        .radius = 0.1f,
                        .emission = {500, 1000, 2500},
                        .influenceRadius = 20};

// Sets the projection of the shadow map: 90 degrees wide, along -z, planes at 0.1 and 10 m.
static void aim(ShadowParameters& parameters)
{
    constexpr float nearPlane = 0.1f, farPlane = 10;
    constexpr float scale = farPlane / (nearPlane - farPlane), shift = nearPlane * scale;
    const float* p = spot.position;
    const float clipFromView[16] = {
        1, 0, 0, 0, 0, -1, 0, 0, 0, 0, scale, -1, -p[0], p[1], shift - scale * p[2], p[2]};
    std::copy_n(clipFromView, 16, parameters.shadowFromView);
}

static void drawFrames(Host& host, const ShadowMap& map)
{
    const CndDeviceDesc device = deviceOf(host);
    const auto kernels = *candelabra::CompiledKernels::create(
        {.functions = CND_HOST_VISIBILITY_BIT,
         .source = shadowTerm,
         .sourceName = "shadow term",
         .lightTypes = 1u << CND_LIGHT_SPOT | 1u << CND_LIGHT_SPHERE});
    // One module per light set. The second one has the built-in kernels, without a shadow term.
    auto shadowed = *candelabra::Lighting::create(
        device, {.framesInFlight = 1, .hostKernels = kernels.hostKernels(map.setLayout)});
    auto open = *candelabra::Lighting::create(device, {.framesInFlight = 1});
    auto shadowedView = *shadowed.createView({.maxWidth = host.width, .maxHeight = host.height});
    auto openView = *open.createView({.maxWidth = host.width, .maxHeight = host.height});
    shadowed.addLight(ember).value();
    map.parameters->light = uint32_t(shadowed.addLight(spot).value());
    open.addLight(lamp).value();
    aim(*map.parameters);

    for (int frame = 0; frame < 2; ++frame) {
        const VkCommandBuffer cmd = beginFrame(&host);
        drawShadowMap(host, map);
        drawWall(&host);
        CndLightingFrame lit = wallFrame(host);
        // Both add to the same image. The second recording begins with a barrier for it.
        openView.record(cmd, lit).value();
        lit.hostSet = map.set;
        shadowedView.record(cmd, lit).value();
        endFrame(&host);
    }
}

// Luminance of the wall at (x, y) in one channel: albedo times the illuminance, divided by pi.
static double wallLuminance(const CndLight& light, double x, double y, int channel)
{
    const double to[3] = {light.position[0] - x, light.position[1] - y,
                          light.position[2] + WALL_DISTANCE};
    const double squared = to[0] * to[0] + to[1] * to[1] + to[2] * to[2], d = std::sqrt(squared);
    const double window = 1 - std::pow(d / light.influenceRadius, 4);
    const double pi = 3.14159265358979323846;
    const double intensity = // of a spot, or of a sphere in a direction
        light.type == CND_LIGHT_SPOT ? light.emission[channel]
                                     : light.emission[channel] * pi * light.radius * light.radius;
    return WALL_ALBEDO / pi * intensity / squared * to[2] / d * window * window;
}

enum class Shadow { None, Full, Edge };

// Returns the share of the spot's light that the window frame takes at a point of the wall. Edges
// are as wide as two texels of the shadow map.
static Shadow shadowAt(double x, double y)
{
    const double share = (spot.position[2] - double(frameZ)) / (spot.position[2] + WALL_DISTANCE);
    const double at[2] = {spot.position[0] + share * (x - spot.position[0]),
                          spot.position[1] + share * (y - spot.position[1])};
    const double edge = 2 * 2 * (spot.position[2] - double(frameZ)) / shadowMapSize;
    bool isNear = false;
    for (const Bar& bar : bars) {
        bool inside = true, around = true;
        for (int i = 0; i < 2; ++i) {
            inside = inside && at[i] > bar.low[i] + edge && at[i] < bar.high[i] - edge;
            around = around && at[i] > bar.low[i] - edge && at[i] < bar.high[i] + edge;
        }
        if (inside)
            return Shadow::Full;
        isNear = isNear || around;
    }
    return isNear ? Shadow::Edge : Shadow::None;
}

static bool isRight(const Host& host, const std::vector<float>& radiance)
{
    int compared[2] = {0, 0}; // in light and in shadow
    double largest = 0;
    for (uint32_t row = 0; row < host.height; ++row)
        for (uint32_t column = 0; column < host.width; ++column) {
            const double x = WALL_DISTANCE * ((2 * column + 1.0) / host.width - 1) /
                             double(host.camera.clipFromView[0]);
            const double y = WALL_DISTANCE * ((2 * row + 1.0) / host.height - 1) /
                             double(host.camera.clipFromView[5]);
            const Shadow shadow = shadowAt(x, y);
            if (shadow == Shadow::Edge)
                continue;
            ++compared[shadow == Shadow::Full];
            for (int c = 0; c < 3; ++c) {
                const double expected = wallLuminance(ember, x, y, c) +
                                        wallLuminance(lamp, x, y, c) +
                                        (shadow == Shadow::None ? wallLuminance(spot, x, y, c) : 0);
                const double found =
                    double(radiance[4 * (size_t(row) * host.width + column) + size_t(c)]);
                largest = std::max(largest, std::abs(found - expected) / expected);
            }
        }
    std::printf("%d pixels in the light of the spot and %d in its shadow differ from the closed "
                "form by up to %.1e of it\n",
                compared[0], compared[1], largest);
    return compared[0] > 30000 && compared[1] > 5000 && largest < 5e-5;
}

int main(int argc, char** argv)
{
    Host host = createHost(320, 200);
    const ShadowMap map = createShadowMap(host);
    drawFrames(host, map);
    std::vector<float> radiance(size_t(host.width) * host.height * 4);
    readPixels(&host, &host.radiance, storageWrite, radiance.data(),
               radiance.size() * sizeof(float));
    writePicture(argc > 1 ? argv[1] : "embed_shadow_map.ppm", &host, radiance.data(), 25);
    const bool right = isRight(host, radiance);
    destroyShadowMap(host, map);
    destroyHost(&host);
    std::puts(right ? "right" : "WRONG");
    return right ? 0 : 1;
}
