// SPDX-License-Identifier: Apache-2.0
#include "generate/examples.h"

#include <cmath>
#include <numbers>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "generate/shapes.h"

namespace candelabra::app
{

namespace
{

using nlohmann::json;

// Constants of glTF 2.0.
constexpr int floatComponents = 5126, unsignedComponents = 5125;
constexpr int vertexTarget = 34962, indexTarget = 34963;

void append(std::vector<uint8_t>& bytes, const void* data, size_t size)
{
    const auto* from = static_cast<const uint8_t*>(data);
    bytes.insert(bytes.end(), from, from + size);
}

void append32(std::vector<uint8_t>& bytes, uint32_t value)
{
    for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(uint8_t(value >> shift));
}

json vectorJson(const glm::vec3& v)
{
    return {v.x, v.y, v.z};
}

// Collects the JSON and the binary chunk of a file.
class GltfWriter
{
public:
    GltfWriter()
    {
        json_["asset"] = {{"version", "2.0"}, {"generator", "candelabra examples"}};
        json_["scene"] = 0;
    }
    // Adds a mesh, a material of its own, and a node that draws it.
    void addObject(const std::string& name, const Mesh& mesh, const glm::vec3& at,
                   const glm::vec3& scale, const glm::vec3& colour, float metalness,
                   float roughness)
    {
        json_["materials"].push_back({{"name", name},
                                      {"pbrMetallicRoughness",
                                       {{"baseColorFactor", {colour.x, colour.y, colour.z, 1}},
                                        {"metallicFactor", metalness},
                                        {"roughnessFactor", roughness}}}});
        std::vector<glm::vec3> positions, normals;
        for (const Vertex& vertex : mesh.vertices) {
            positions.push_back(vertex.position);
            normals.push_back(vertex.normal);
        }
        const json primitive{
            {"attributes", {{"POSITION", addVectors(positions)}, {"NORMAL", addVectors(normals)}}},
            {"indices", addIndices(mesh.indices)},
            {"material", json_["materials"].size() - 1}};
        json_["meshes"].push_back({{"name", name}, {"primitives", json::array({primitive})}});
        addNode({{"name", name},
                 {"mesh", json_["meshes"].size() - 1},
                 {"translation", vectorJson(at)},
                 {"scale", vectorJson(scale)}});
    }
    void addNode(const json& node)
    {
        json_["nodes"].push_back(node);
        json_["scenes"][0]["nodes"].push_back(json_["nodes"].size() - 1);
    }
    void addCamera(const json& camera, const json& node)
    {
        json_["cameras"].push_back(camera);
        addNode(node);
    }
    void addLight(const json& light, json node)
    {
        json& lights = json_["extensions"]["KHR_lights_punctual"]["lights"];
        lights.push_back(light);
        node["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
        json_["extensionsUsed"] = {"KHR_lights_punctual"};
        addNode(node);
    }
    // The file: a header and two chunks, whose sizes are multiples of 4 (glTF 2.0, section 4.4).
    std::vector<uint8_t> bytes()
    {
        json_["buffers"] = json::array({{{"byteLength", binary_.size()}}});
        std::string text = json_.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::vector<uint8_t> out;
        constexpr uint32_t magic = 0x46546C67, jsonChunk = 0x4E4F534A, binaryChunk = 0x004E4942;
        append32(out, magic);
        append32(out, 2);
        append32(out, uint32_t(12 + 8 + text.size() + 8 + binary_.size()));
        append32(out, uint32_t(text.size()));
        append32(out, jsonChunk);
        append(out, text.data(), text.size());
        append32(out, uint32_t(binary_.size()));
        append32(out, binaryChunk);
        append(out, binary_.data(), binary_.size());
        return out;
    }

private:
    size_t addView(const void* data, size_t size, int target)
    {
        json_["bufferViews"].push_back({{"buffer", 0},
                                        {"byteOffset", binary_.size()},
                                        {"byteLength", size},
                                        {"target", target}});
        append(binary_, data, size);
        return json_["bufferViews"].size() - 1;
    }
    size_t addAccessor(const json& accessor)
    {
        json_["accessors"].push_back(accessor);
        return json_["accessors"].size() - 1;
    }
    size_t addVectors(const std::vector<glm::vec3>& vectors)
    {
        glm::vec3 low = vectors.at(0), high = low;
        for (const glm::vec3& v : vectors) {
            low = glm::min(low, v);
            high = glm::max(high, v);
        }
        return addAccessor(
            {{"bufferView",
              addView(vectors.data(), vectors.size() * sizeof vectors[0], vertexTarget)},
             {"componentType", floatComponents},
             {"count", vectors.size()},
             {"type", "VEC3"},
             {"min", vectorJson(low)},
             {"max", vectorJson(high)}});
    }
    size_t addIndices(const std::vector<uint32_t>& indices)
    {
        return addAccessor({{"bufferView", addView(indices.data(),
                                                   indices.size() * sizeof(uint32_t), indexTarget)},
                            {"componentType", unsignedComponents},
                            {"count", indices.size()},
                            {"type", "SCALAR"}});
    }

    json json_;
    std::vector<uint8_t> binary_;
};

// The luminance of the sky at dusk in a direction, in cd/m^2: it is bright where the sun has set,
// warm along the horizon and blue above, over dim ground.
glm::vec3 skyLuminance(const glm::vec3& direction)
{
    const glm::vec3 sunset = glm::normalize(glm::vec3(-0.5f, 0, -0.6f));
    if (direction.y < 0)
        return glm::vec3(0.5f, 0.5f, 0.6f);
    const float haze = std::pow(1 - direction.y, 6.0f);
    const float toSunset = 0.5f + 0.5f * glm::dot(direction, sunset);
    const float glow = haze * std::pow(toSunset, 3.0f);
    return glm::mix(glm::vec3(1.2f, 2.2f, 5), glm::vec3(4, 4, 5), haze) +
           glow * glm::vec3(24, 11, 4);
}

} // namespace

std::vector<uint8_t> exampleGltf()
{
    GltfWriter out;
    out.addObject("floor", makeGround(1), {0, 0, 0}, {12, 1, 12}, {0.42f, 0.4f, 0.37f}, 0, 0.45f);
    out.addObject("ball", makeSphere(64, 32), {-0.95f, 0.4f, 0.15f}, glm::vec3(0.4f),
                  {0.95f, 0.78f, 0.45f}, 1, 0.22f);
    out.addObject("ring", makeTorus(0.42f, 0.15f, 96, 32), {0.95f, 0.15f, 0.3f}, glm::vec3(1),
                  {0.1f, 0.22f, 0.5f}, 0, 0.3f);
    out.addObject("knot", makeKnot(0.1f, 240, 24), {0, 0.62f, -0.35f}, glm::vec3(1.1f),
                  {0.62f, 0.1f, 0.07f}, 0, 0.38f);
    out.addLight({{"name", "lamp"},
                  {"type", "point"},
                  {"intensity", 60}, // cd
                  {"color", {1, 0.82f, 0.6f}},
                  {"extras", {{"radius", 0.12}}}}, // metres
                 {{"name", "lamp"}, {"translation", {0.15, 1.6, 0.45}}});
    // Spots shine along -z of their node, which this quaternion turns straight down.
    const double half = std::numbers::sqrt2 / 2;
    out.addLight(
        {{"name", "spot"},
         {"type", "spot"},
         {"intensity", 90},
         {"color", {0.6f, 0.75f, 1}},
         {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.55}}}},
        {{"name", "spot"}, {"translation", {-1.1, 2.6, 0.2}}, {"rotation", {-half, 0, 0, half}}});
    // The camera looks down by 12 degrees.
    const double down = 0.5 * 12 * std::numbers::pi / 180;
    out.addCamera({{"type", "perspective"}, {"perspective", {{"yfov", 0.62}, {"znear", 0.05}}}},
                  {{"name", "front"},
                   {"camera", 0},
                   {"translation", {0, 1.45, 4.2}},
                   {"rotation", {-std::sin(down), 0, 0, std::cos(down)}}});
    return out.bytes();
}

std::string exampleSceneJson()
{
    return R"({
    "name": "example",
    "about": "three balls on a floor under a sphere, a tube and a rectangle",
    "camera": {"position": [0, 1.6, 5], "look_at": [0, 0.6, 0], "up": [0, 1, 0],
               "vertical_fov_degrees": 36},
    "objects": [
        {"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0],
         "material": {"albedo": [0.4, 0.4, 0.4], "reflectance": 0.5, "perceptual_roughness": 0.35}},
        {"type": "sphere", "center": [-1.2, 0.5, 0], "radius": 0.5,
         "material": {"albedo": [0, 0, 0], "diffuse": false, "F0": [0.95, 0.78, 0.45],
                      "perceptual_roughness": 0.2}},
        {"type": "sphere", "center": [0, 0.5, -0.3], "radius": 0.5,
         "material": {"albedo": [0.5, 0.08, 0.05], "reflectance": 0.5,
                      "perceptual_roughness": 0.4}},
        {"type": "sphere", "center": [1.2, 0.5, 0], "radius": 0.5,
         "material": {"albedo": [0.08, 0.2, 0.45], "reflectance": 0.5,
                      "perceptual_roughness": 0.6}}],
    "lights": [
        {"type": "sphere", "position": [-1.4, 2, 1], "radius": 0.2,
         "luminous_power": [900, 750, 520]},
        {"type": "tube", "start": [-0.6, 1.7, -0.9], "end": [0.6, 1.7, -0.9], "radius": 0.04,
         "luminous_power": [300, 420, 600]},
        {"type": "rectangle", "position": [1.6, 1.9, 0.4], "axis_u": [0.3, 0, -0.3],
         "axis_v": [-0.15, 0.25, -0.15], "two_sided": true, "luminous_power": [700, 700, 700]}],
    "lights_visible_to_camera": true,
    "resolution": [480, 270]
}
)";
}

Image exampleSky()
{
    constexpr uint32_t width = 512, height = 256;
    Image out{.width = width, .height = height, .channels = 3};
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            // The middle of the image is -z, and +x is to the right of it (SceneEnvironment).
            const float elevation = std::numbers::pi_v<float> * (0.5f - (float(y) + 0.5f) / height);
            const float azimuth =
                2 * std::numbers::pi_v<float> * ((float(x) + 0.5f) / width - 0.5f);
            const glm::vec3 luminance =
                skyLuminance({std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                              -std::cos(elevation) * std::cos(azimuth)});
            for (int channel = 0; channel < 3; ++channel)
                out.pixels.push_back(luminance[channel]);
        }
    return out;
}

} // namespace candelabra::app
