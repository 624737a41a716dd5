// SPDX-License-Identifier: Apache-2.0
// A scene in memory: what loaders and generators produce and the renderer draws. No Vulkan here.
// Metres, radians, photometric units; world space is right-handed with y up.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "candelabra/candelabra.h"
#include "io/image.h"

namespace candelabra::app
{

struct Vertex {
    glm::vec3 position{0};
    glm::vec3 normal{0, 1, 0};
    glm::vec4 tangent{1, 0, 0, 1}; // w: handedness of the bitangent
    glm::vec2 uv[2]{};
    glm::vec4 color{1}; // multiplies the base colour; linear
};

struct Mesh {
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices; // triangles, counter-clockwise seen from outside
};

struct Texture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgba; // width * height * 4, rows from the top
    bool srgb = false;         // decode RGB from sRGB when sampling
    bool repeatU = true, repeatV = true, mirrorU = false, mirrorV = false, nearest = false;
};

struct TextureRef {
    int32_t texture = -1; // index into Scene::textures, -1: none (reads as 1, normals as +z)
    uint32_t uvSet = 0;   // 0 or 1
    // Rows of the affine map applied to uv (KHR_texture_transform): u' = dot(u_, vec3(uv, 1)).
    glm::vec3 uRow{1, 0, 0}, vRow{0, 1, 0};
};

enum class AlphaMode { Opaque, Mask };

// Metallic-roughness material: diffuse albedo = baseColor * (1 - metalness) * diffuseWeight,
// F0 = mix(dielectricF0, baseColor, metalness), alpha = perceptualRoughness^2.
struct Material {
    std::string name;
    glm::vec3 baseColor{1};
    float alpha = 1; // coverage, with AlphaMode::Mask
    float metalness = 0;
    float perceptualRoughness = 1;
    glm::vec3 dielectricF0{0.04f};
    float diffuseWeight = 1;
    float specularWeight = 1; // Schlick F90; 0 removes the specular lobe
    glm::vec3 emission{0};    // cd/m^2
    float normalScale = 1;
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f;
    bool doubleSided = false;
    TextureRef baseColorTexture;         // sRGB rgb, a: coverage
    TextureRef metallicRoughnessTexture; // g: roughness, b: metalness
    TextureRef normalTexture;            // tangent space, xyz * 2 - 1
    TextureRef emissiveTexture;          // sRGB
};

struct Instance {
    uint32_t mesh = 0;
    uint32_t material = 0;
    glm::dmat4 worldFromObject{1};
};

// Exact plane or ball, ray-cast per pixel. Only the plane's upper side is seen.
struct AnalyticObject {
    enum class Type { Plane, Ball } type = Type::Plane;
    glm::dvec3 point{0};        // plane: a point on it; ball: centre
    glm::dvec3 normal{0, 1, 0}; // plane: unit
    double radius = 1;          // ball
    uint32_t material = 0;
};

struct Camera {
    std::string name;
    glm::dvec3 position{0};
    glm::dvec3 forward{0, 0, -1}; // unit
    glm::dvec3 up{0, 1, 0};       // unit, not parallel to forward
    bool orthographic = false;
    double verticalFov = 0.9;      // radians, perspective
    double orthographicHeight = 1; // full height in metres, orthographic
    std::optional<double> aspect;  // width / height; empty: that of the image
    double nearPlane = 0.05;       // metres
    double farPlane = 0;           // metres; 0: infinite (perspective only)
    uint32_t layers = 0;           // as CndLightingFrame::layers

    bool operator==(const Camera&) const = default;
};

// How a light moves, as a function of time alone: position + offset on a circle.
struct LightMotion {
    glm::vec3 axisU{0},
        axisV{0};           // metres; offset = axisU cos(phase + w t) + axisV sin(phase + w t)
    float angularSpeed = 0; // w, rad/s
    float phase = 0;
};

// An equirectangular image around the scene: up at the top row, -z in the middle, +x to the right.
struct SceneEnvironment {
    std::string file;    // where it is from
    Image radiance;      // cd/m^2
    double rotation = 0; // radians about y, counter-clockwise seen from above
    double scale = 1;    // factor on the radiance
};

struct Scene {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Instance> instances;
    std::vector<AnalyticObject> analyticObjects;
    glm::dvec3 lightOrigin{0}; // light positions are relative to it
    std::vector<CndLight> lights;
    std::vector<LightMotion> lightMotions; // empty or one per light
    std::vector<Camera> cameras;           // at least one after loading; [0] is the default
    glm::vec3 background{0};               // luminance of pixels without a surface, cd/m^2
    std::optional<SceneEnvironment> environment;
    CndLobeJoining lobes = CND_LOBES_CONSERVING;
    bool energyCompensation = false;      // give back light that bounces between microfacets
    std::optional<glm::uvec2> resolution; // default image size
    bool lightsVisible = true;            // draw area lights as emitters
    std::vector<std::string> warnings;    // what was understood but not used, one sentence each
};

// Axis-aligned bounds of all instances (analytic objects excluded); empty scenes give {0,0}.
struct Bounds {
    glm::dvec3 min{0}, max{0};
};
Bounds sceneBounds(const Scene& scene);

// Mask of CndMaterialClass: lobes that some surface may be without.
uint32_t materialClasses(const Scene& scene);

// Positions of the moving lights at `time` seconds; lights without motion keep theirs.
void lightsAtTime(const Scene& scene, double time, std::vector<CndLight>& out);

} // namespace candelabra::app
