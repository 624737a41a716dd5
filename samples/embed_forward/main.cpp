// SPDX-License-Identifier: Apache-2.0
// Transparent objects lit through Candelabra's GLSL: three balls in front of a wall. The module
// lights the wall itself, with the same lights. Writes embed_forward.ppm (or the file named as
// argument), compares the wall and the middle ball with their closed form, pixel by pixel, and
// exits with 1 if they are wrong.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "ball.h"
#include "picture.h"

// The camera is at the origin and looks down -z, so view space is the lights' space.
constexpr CndLight lamp(float x, float y, float z, float red, float green, float blue)
{
    return {.type = CND_LIGHT_SPHERE,
            .position = {x, y, z},
            .radius = 0.05f,
            .emission = {red, green, blue},
            .influenceRadius = 4};
}
constexpr CndLight lamps[] = {
    lamp(-0.7f, 0.6f, -1.0f, 9000, 3000, 2000), lamp(0.1f, 0.7f, -0.8f, 5000, 5000, 5000),
    lamp(0.8f, 0.4f, -1.1f, 1500, 3000, 9000), lamp(0.0f, -0.6f, -1.6f, 1000, 5000, 1000)};

// Left and right ball: a glossy coat. Middle ball: a matt coat, for which there is a closed form.
constexpr Ball balls[] = {
    {{-0.55f, -0.05f, -1.5f}, 0.25f, {0.6f, 0.1f, 0.05f}, 0.7f, 0.04f, 1, 0.25f},
    {{0.0f, 0.0f, -1.3f}, 0.25f, {0.7f, 0.7f, 0.6f}, 0.6f, 0, 0, 1},
    {{0.55f, -0.05f, -1.5f}, 0.25f, {0.05f, 0.05f, 0.1f}, 0.5f, 0.6f, 1, 0.4f}};
constexpr const Ball& mattBall = balls[1];

// Draws the balls from far to near, after the lighting of the opaque surfaces.
void drawBalls(Host& host, const Raster& pass, VkDescriptorSet lights)
{
    const VkCommandBuffer cmd = host.cmd;
    constexpr ImageUse depthRead{VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL,
                                 VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
                                     VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                                 VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT};
    imageBarrier(cmd, &host.radiance, storageWrite, colourAttachment);
    imageBarrier(cmd, &host.depth, sampledRead, depthRead);
    const VkRenderingAttachmentInfo colour =
        attachment(host.radiance, colourAttachment.layout, VK_ATTACHMENT_LOAD_OP_LOAD,
                   VK_ATTACHMENT_STORE_OP_STORE);
    beginRaster(cmd, pass, {host.width, host.height}, {&colour, 1},
                attachment(host.depth, depthRead.layout, VK_ATTACHMENT_LOAD_OP_LOAD,
                           VK_ATTACHMENT_STORE_OP_NONE));
    const float invImageSize[] = {1 / float(host.width), 1 / float(host.height)};
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pass.layout, 0, 1, &lights, 0,
                            nullptr);
    vkCmdPushConstants(cmd, pass.layout, VK_SHADER_STAGE_FRAGMENT_BIT, sizeof(Ball),
                       sizeof invImageSize, invImageSize);
    for (const Ball& ball : balls) {
        vkCmdPushConstants(cmd, pass.layout, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof ball, &ball);
        vkCmdDraw(cmd, 3, 1, 0, 0);
    }
    vkCmdEndRendering(cmd);
}

void drawFrame(Host& host)
{
    const CndDeviceDesc device = deviceOf(host);
    auto lighting = *candelabra::Lighting::create(
        device, {.framesInFlight = 1, .forwardStages = VK_SHADER_STAGE_FRAGMENT_BIT});
    auto view = *lighting.createView({.maxWidth = host.width, .maxHeight = host.height});
    for (const CndLight& light : lamps)
        lighting.addLight(light).value(); // returns an id, to change or remove the light later
    const Raster pass = createBallPass(host.device, lighting.forwardSetLayout().value());

    const VkCommandBuffer cmd = beginFrame(&host);
    drawWall(&host);
    view.record(cmd, wallFrame(host)).value();
    drawBalls(host, pass, view.forwardSet(0).value());
    endFrame(&host);
    destroyRaster(host.device, pass);
}

struct Vec {
    double x, y, z;
};
static Vec operator-(Vec a, Vec b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
static double dot(Vec a, Vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Luminance of a Lambertian surface in one channel: albedo * luminance * (radius / d)^2 * cosine *
// window, summed over the lamps. Returns false if a lamp crosses the horizon, where this formula
// does not hold.
static bool lambert(Vec position, Vec normal, double albedo, int channel, double& luminance)
{
    luminance = 0;
    for (const CndLight& light : lamps) {
        const Vec to = Vec{light.position[0], light.position[1], light.position[2]} - position;
        const double d = std::sqrt(dot(to, to)), height = dot(to, normal);
        if (std::abs(height) < light.radius)
            return false;
        const double s = light.radius / d, window = 1 - std::pow(d / light.influenceRadius, 4);
        luminance += height > 0
                         ? albedo * light.emission[channel] * s * s * height / d * window * window
                         : 0;
    }
    return true;
}

// Returns a ray through the centre of a pixel, with z = -1.
static Vec pixelRay(const Host& host, uint32_t x, uint32_t y)
{
    return {((2 * x + 1.0) / host.width - 1) / host.camera.clipFromView[0],
            ((2 * y + 1.0) / host.height - 1) / host.camera.clipFromView[5], -1};
}

// Returns the distance along a ray of length 1 to a ball, or 0 if the ray misses it.
static double hit(const Ball& ball, Vec unit)
{
    const Vec centre{ball.centre[0], ball.centre[1], ball.centre[2]};
    const double along = dot(unit, centre);
    const double inside = double(ball.radius) * ball.radius - dot(centre, centre) + along * along;
    return inside > 0 ? along - std::sqrt(inside) : 0;
}

// Compares the matt ball in front of the wall, and the wall between the balls, and counts the
// values compared.
static bool isRight(const Host& host, const std::vector<float>& radiance)
{
    int compared[2] = {0, 0};
    double largest = 0;
    for (uint32_t y = 0; y < host.height; ++y)
        for (uint32_t x = 0; x < host.width; ++x) {
            const Vec ray = pixelRay(host, x, y);
            const double length = std::sqrt(dot(ray, ray));
            const Vec unit{ray.x / length, ray.y / length, ray.z / length};
            if (hit(balls[0], unit) != 0 || hit(balls[2], unit) != 0)
                continue;
            const Vec wall{WALL_DISTANCE * ray.x, WALL_DISTANCE * ray.y, -WALL_DISTANCE};
            const double t = hit(mattBall, unit);
            const Vec front{t * unit.x, t * unit.y, t * unit.z};
            const Vec out = front - Vec{mattBall.centre[0], mattBall.centre[1], mattBall.centre[2]};
            const double r = mattBall.radius;
            for (int c = 0; c < 3; ++c) {
                double expected = 0, coat = 0;
                if (!lambert(wall, {0, 0, 1}, WALL_ALBEDO, c, expected))
                    continue;
                if (t != 0) {
                    // Near the ball's outline, rounding of the ray moves the point that it hits.
                    if (out.z < 0.2 * r || !lambert(front, {out.x / r, out.y / r, out.z / r},
                                                    mattBall.albedo[c], c, coat))
                        continue;
                    expected = (1 - mattBall.opacity) * expected + mattBall.opacity * coat;
                }
                const double found = radiance[4 * (size_t(y) * host.width + x) + size_t(c)];
                largest = std::max(largest, std::abs(found - expected) / expected);
                ++compared[t != 0];
            }
        }
    std::printf("%d values of the wall and %d of the ball differ from the closed form by up to "
                "%.1e of it\n",
                compared[0], compared[1], largest);
    return compared[0] > 10000 && compared[1] > 3000 && largest < 5e-5;
}

int main(int argc, char** argv)
{
    Host host = createHost(320, 200);
    drawFrame(host);
    std::vector<float> radiance(size_t(host.width) * host.height * 4);
    readPixels(&host, &host.radiance, colourAttachment, radiance.data(),
               radiance.size() * sizeof(float));
    writePicture(argc > 1 ? argv[1] : "embed_forward.ppm", &host, radiance.data(), 25);
    const bool right = isRight(host, radiance);
    destroyHost(&host);
    std::puts(right ? "right" : "WRONG");
    return right ? 0 : 1;
}
