// SPDX-License-Identifier: Apache-2.0
// Soft shadows of a host's own meshes: 20 boxes move over a floor under 200 lights, and a stalk
// bends. The box and the stalk that the host draws from its vertex and index buffers are also the
// meshes that cast shadows. The vertices of the stalk are only on the device. Writes
// embed_shadows.ppm (or the file named as argument), compares it with a frame without shadows, and
// exits with 1 if a shadow is missing or brightens something.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include <candelabra/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "box_frag.h"
#include "box_vert.h"
#include "host.hpp"
#include "picture.h"
#include "stalk.h"

constexpr int boxCount = 20, lightCount = 200;
constexpr float golden = 2.39996f; // an angle: so many places around a centre are evenly spread

// What the host has in any case: meshes, objects that use them, a camera.
struct Object {
    glm::mat4 worldFromMesh;
    glm::vec3 albedo;
};
struct Push {
    glm::mat4 clipFromWorld;
    glm::mat3x4 worldFromMesh;
    glm::vec4 albedo;
};

// A box from -1 to 1.
static Mesh boxMesh()
{
    Mesh mesh;
    for (int face = 0; face < 6; ++face) {
        const uint32_t first = uint32_t(mesh.vertices.size());
        for (int corner = 0; corner < 4; ++corner) {
            Vertex v{glm::vec3(corner & 1 ? 1 : -1), glm::vec3(0)};
            v.position[(face + 1) % 3] = corner & 2 ? 1 : -1;
            v.position[face % 3] = v.normal[face % 3] = face < 3 ? 1 : -1;
            mesh.vertices.push_back(v);
        }
        for (const uint32_t i : {0u, 1u, 2u, 2u, 1u, 3u})
            mesh.indices.push_back(first + i);
    }
    return mesh;
}

// The floor, then the boxes, which circle and turn, and the stalk, whose vertices move instead.
static std::vector<Object> objectsAt(float time)
{
    const glm::mat4 one(1);
    std::vector<Object> out{
        {glm::scale(glm::translate(one, {0, -0.1f, 0}), {6, 0.1f, 6}), glm::vec3(0.5f)}};
    for (int i = 0; i < boxCount; ++i) {
        const float angle = golden * float(i) + 0.3f * time, far = std::sqrt(float(i) + 0.5f);
        const glm::vec3 half(0.25f, 0.15f + 0.1f * float(i % 7), 0.25f);
        const glm::vec3 centre(far * std::cos(angle), half.y, far * std::sin(angle));
        const glm::mat4 turned =
            glm::rotate(glm::translate(one, centre), time + float(i), {0, 1, 0});
        out.push_back({glm::scale(turned, half), {0.7f, 0.3f + 0.1f * float(i % 5), 0.3f}});
    }
    out.push_back({glm::translate(one, {0.2f, 0, 2.8f}), {0.3f, 0.6f, 0.2f}});
    return out;
}

// Lamps at the floor, and every twentieth of them hangs higher and is brighter.
static std::vector<CndLight> lamps()
{
    constexpr glm::vec3 colours[] = {{1, 0.5f, 0.2f}, {0.8f, 0.9f, 1}, {0.3f, 0.5f, 1}};
    std::vector<CndLight> out(lightCount, {.type = CND_LIGHT_SPHERE, .radius = 0.06f});
    for (int i = 0; i < lightCount; ++i) {
        const bool high = i % 20 == 19;
        const float angle = golden * float(i), far = 0.37f * std::sqrt(float(i) + 0.5f);
        const float y = high ? 1.9f : 0.15f, luminance = high ? 8000.0f : 150.0f; // m, cd/m^2
        candelabra::assign(out[i].position,
                           glm::vec3(far * std::cos(angle), y, far * std::sin(angle)));
        candelabra::assign(out[i].emission, luminance * colours[i / 20 % 3]);
        out[i].influenceRadius = high ? 8.0f : 2.0f;
    }
    return out;
}

static CndCamera cameraOf(const Host& host)
{
    const glm::dmat4 view =
        glm::rotate(glm::translate(glm::dmat4(1), {0, 0, -8.5}), glm::radians(40.0), {1, 0, 0});
    glm::mat4 clip(0);
    clip[0][0] = 2 * float(host.height) / float(host.width);
    clip[1][1] = -2; // Vulkan's y points down
    clip[2][3] = -1;
    clip[3][2] = 0.1f; // reversed depth, infinite far plane
    return candelabra::camera(view, clip);
}

// The host's own renderer: a G-buffer with a normal and a colour.
constexpr CndGBufferDesc description{.normalEncoding = CND_NORMAL_SNORM,
                                     .normalSpace = CND_NORMALS_WORLD,
                                     .constantRoughness = 0.5f,
                                     .normalRoughnessFormat = VK_FORMAT_R16G16B16A16_SFLOAT,
                                     .albedoFormat = VK_FORMAT_R8G8B8A8_UNORM,
                                     .depthFormat = VK_FORMAT_D32_SFLOAT};
constexpr VkFormat formats[] = {description.normalRoughnessFormat, description.albedoFormat,
                                VK_FORMAT_R32G32B32A32_SFLOAT};
constexpr VkShaderStageFlags stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
constexpr VkVertexInputAttributeDescription attributes[] = {
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
    {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)}};
constexpr ImageUse storage{VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                           VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                               VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};

// A mesh on the device.
class DrawnMesh
{
public:
    DrawnMesh(const Host& host, const Mesh& mesh)
        : host_(host),
          vertices_(createHostBuffer(&host, mesh.vertices.size() * sizeof(Vertex),
                                     VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)),
          indices_(createHostBuffer(&host, mesh.indices.size() * sizeof(uint32_t),
                                    VK_BUFFER_USAGE_INDEX_BUFFER_BIT)),
          indexCount_(uint32_t(mesh.indices.size()))
    {
        std::ranges::copy(mesh.vertices, static_cast<Vertex*>(vertices_.mapped));
        std::ranges::copy(mesh.indices, static_cast<uint32_t*>(indices_.mapped));
    }
    ~DrawnMesh()
    {
        destroyHostBuffer(&host_, vertices_);
        destroyHostBuffer(&host_, indices_);
    }
    DrawnMesh(const DrawnMesh&) = delete;
    DrawnMesh& operator=(const DrawnMesh&) = delete;

    VkBuffer vertices() const { return vertices_.buffer; }
    void bind(VkCommandBuffer cmd) const
    {
        const VkDeviceSize start = 0;
        vkCmdBindVertexBuffers(cmd, 0, 1, &vertices_.buffer, &start);
        vkCmdBindIndexBuffer(cmd, indices_.buffer, 0, VK_INDEX_TYPE_UINT32);
    }
    void draw(VkCommandBuffer cmd) const { vkCmdDrawIndexed(cmd, indexCount_, 1, 0, 0, 0); }

private:
    const Host& host_;
    HostBuffer vertices_, indices_;
    uint32_t indexCount_;
};

class Renderer
{
public:
    explicit Renderer(const Host& host)
        : host_(host),
          raster_(createRaster(host.device, {.vertex = box_vert,
                                             .fragment = box_frag,
                                             .constants = {stages, 0, sizeof(Push)},
                                             .attributes = attributes,
                                             .vertexBytes = sizeof(Vertex),
                                             .depthTest = VK_COMPARE_OP_GREATER,
                                             .colours = formats}))
    {
        for (int i = 0; i < 3; ++i)
            images_[i] = createHostImage(
                &host, formats[i], host.width, host.height,
                VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                    (i < 2 ? VK_IMAGE_USAGE_SAMPLED_BIT : VK_IMAGE_USAGE_STORAGE_BIT));
        images_[3] = createHostImage(&host, description.depthFormat, host.width, host.height,
                                     VK_IMAGE_USAGE_SAMPLED_BIT |
                                         VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    }
    ~Renderer()
    {
        for (const HostImage& image : images_)
            destroyHostImage(&host_, image);
        destroyRaster(host_.device, raster_);
    }
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    const HostImage& radiance() const { return images_[2]; }
    CndLightingFrame frame() const
    {
        return {.width = host_.width,
                .height = host_.height,
                .camera = cameraOf(host_),
                .clearDepth = 0,
                .normalRoughness = images_[0].view,
                .albedo = images_[1].view,
                .depth = images_[3].view,
                .radiance = images_[2].view};
    }
    // Draws boxes, and the last object as the stalk. Leaves the images in the state that
    // CndLightingFrame requires.
    void draw(VkCommandBuffer cmd, const std::vector<Object>& objects, const DrawnMesh& box,
              const DrawnMesh& stalk) const
    {
        VkRenderingAttachmentInfo colours[3];
        for (int i = 0; i < 3; ++i) {
            imageBarrier(cmd, &images_[i], overwritten, colourAttachment);
            colours[i] = attachment(images_[i], colourAttachment.layout,
                                    VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE);
        }
        imageBarrier(cmd, &images_[3], overwritten, depthAttachment);
        beginRaster(cmd, raster_, {host_.width, host_.height}, colours,
                    attachment(images_[3], depthAttachment.layout, VK_ATTACHMENT_LOAD_OP_CLEAR,
                               VK_ATTACHMENT_STORE_OP_STORE));
        const CndCamera camera = cameraOf(host_);
        const glm::mat4 clipFromWorld =
            glm::make_mat4(camera.clipFromView) * glm::mat4(glm::make_mat4(camera.viewFromWorld));
        for (const Object& o : objects) {
            const DrawnMesh& mesh = &o == &objects.back() ? stalk : box;
            mesh.bind(cmd);
            const Push push{clipFromWorld, glm::mat3x4(glm::transpose(o.worldFromMesh)),
                            glm::vec4(o.albedo, 1)};
            vkCmdPushConstants(cmd, raster_.layout, stages, 0, sizeof push, &push);
            mesh.draw(cmd);
        }
        vkCmdEndRendering(cmd);
        for (int i = 0; i < 2; ++i)
            imageBarrier(cmd, &images_[i], colourAttachment, sampledRead);
        imageBarrier(cmd, &images_[2], colourAttachment, storage);
        imageBarrier(cmd, &images_[3], depthAttachment, sampledRead);
    }

private:
    const Host& host_;
    Raster raster_;
    std::array<HostImage, 4> images_; // normal, albedo, radiance, depth
};

// The shadows begin here: each object that the host draws is an instance of an occluder mesh.
static std::vector<CndOccluderInstance> occludersOf(const std::vector<Object>& objects,
                                                    CndOccluderMeshId box, CndOccluderMeshId stalk)
{
    std::vector<CndOccluderInstance> out(objects.size(), {.mesh = box});
    out.back().mesh = stalk;
    for (size_t i = 0; i < objects.size(); ++i)
        candelabra::assign(out[i].worldFromMesh, objects[i].worldFromMesh);
    return out;
}

// Draws some frames with shadows and the last one once more without, and returns the radiance of
// both.
static std::array<std::vector<float>, 2> drawFrames(Host& host)
{
    const Mesh boxes = boxMesh(), straight = straightStalk();
    const DrawnMesh drawnBox(host, boxes), drawnStalk(host, straight);
    const StalkBender bender(host, drawnStalk.vertices());
    const Renderer renderer(host);
    auto lighting =
        *candelabra::Lighting::create(deviceOf(host), {.framesInFlight = 1,
                                                       .gbufferLayout = CND_GBUFFER_HOST,
                                                       .gbuffer = description,
                                                       .shadows = {.points = 64}});
    auto view = *lighting.createView({.maxWidth = host.width, .maxHeight = host.height});
    lighting.setLights(lamps(), {0, 0, 0}).value();
    const auto addMesh = [&](const Mesh& mesh) {
        return lighting
            .addOccluderMesh({.positions = &mesh.vertices[0].position.x,
                              .stride = sizeof(Vertex),
                              .vertexCount = uint32_t(mesh.vertices.size()),
                              .indices = mesh.indices.data(),
                              .triangleCount = uint32_t(mesh.indices.size() / 3)})
            .value();
    };
    const CndOccluderMeshId box = addMesh(boxes), stalk = addMesh(straight);
    std::vector<CndOccluderId> ids(objectsAt(0).size());
    lighting.addOccluders(occludersOf(objectsAt(0), box, stalk), ids).value();
    const CndDevicePositions bent{
        .mesh = stalk, .buffer = drawnStalk.vertices(), .stride = sizeof(Vertex)};

    std::array<std::vector<float>, 2> radiance;
    constexpr int frames = 3;
    for (int i = 0; i <= frames; ++i) {
        const bool shadows = i < frames;
        const float time = float(std::min(i, frames - 1));
        const std::vector<Object> objects = objectsAt(time);
        lighting.updateOccluders(ids, occludersOf(objects, box, stalk)).value();
        const VkCommandBuffer cmd = beginFrame(&host);
        bender.record(cmd, 1.1f * time - 0.8f);
        lighting.replaceOccluderPositionsOnDevice({&bent, 1}).value();
        renderer.draw(cmd, objects, drawnBox, drawnStalk);
        CndLightingFrame frame = renderer.frame();
        frame.shadowsOff = !shadows;
        frame.countPairs = VK_TRUE; // for the statistics
        view.record(cmd, frame).value();
        endFrame(&host);
        std::vector<float>& pixels = radiance[shadows ? 0 : 1];
        pixels.resize(size_t(host.width) * host.height * 4);
        readPixels(&host, &renderer.radiance(), storageWrite, pixels.data(),
                   pixels.size() * sizeof(float));
        const CndLightingStats stats = view.stats(0).value().value();
        std::printf("of %llu pairs of a pixel and a light in reach, %llu are in penumbra and "
                    "%llu in full shadow\n",
                    (unsigned long long)stats.contributingPairs,
                    (unsigned long long)stats.partlyLitPairs, (unsigned long long)stats.darkPairs);
    }
    return radiance;
}

int main(int argc, char** argv)
{
    Host host{.width = 320, .height = 200};
    createHostDevice(&host, 0, nullptr, 0, nullptr);
    const auto [shadowed, open] = drawFrames(host);
    writePicture(argc > 1 ? argv[1] : "embed_shadows.ppm", &host, shadowed.data(), 20);
    destroyHostDevice(&host);

    size_t brighter = 0, darker = 0, surfaces = 0;
    for (size_t i = 0; i < shadowed.size(); i += 4) {
        surfaces += open[i] > 0;
        brighter += shadowed[i] > 1.0001f * open[i];
        darker += shadowed[i] < 0.8f * open[i];
    }
    std::printf("of %zu pixels, %zu lose more than a fifth of their light, %zu gain some\n",
                surfaces, darker, brighter);
    const bool right = !brighter && darker > surfaces / 10;
    std::puts(right ? "right" : "WRONG");
    return right ? 0 : 1;
}
