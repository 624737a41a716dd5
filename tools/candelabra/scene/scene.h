// SPDX-License-Identifier: Apache-2.0
// A scene in memory, which loaders and generators produce and the renderer draws. It has nothing of
// Vulkan. Units are metres, radians and photometric units; world space is right-handed with y up.
#pragma once

#include <cstdint>
#include <memory>
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

// Returns the mean of the colours of a texture in linear values. Its bytes are those of sRGB,
// whatever Texture::srgb says.
glm::vec3 meanOfSrgb(const Texture& texture);

struct TextureRef {
    // Index into Scene::textures. -1 is no texture, which reads as 1, as a normal map as +z.
    int32_t texture = -1;
    uint32_t uvSet = 0; // 0 or 1
    // Rows of the affine map applied to uv (KHR_texture_transform):
    // u' = dot(uRow, vec3(uv, 1)), v' = dot(vRow, vec3(uv, 1)).
    glm::vec3 uRow{1, 0, 0}, vRow{0, 1, 0};
};

// The luminance of white in unlit materials, cd/m^2. Their colours are meant for a screen, and this
// is how bright screens are.
constexpr float unlitLuminance = 100;

// A surface is everywhere, where its coverage is at least a cutoff, or, like a fine screen, on a
// share of its area that equals its coverage.
enum class AlphaMode { Opaque, Mask, Blend };

// Metallic-roughness material: diffuse albedo = baseColor * (1 - metalness) * diffuseWeight,
// F0 = mix(dielectricF0, baseColor, metalness), alpha = perceptualRoughness^2.
struct Material {
    std::string name;
    glm::vec3 baseColor{1};
    float alpha = 1; // coverage, used unless AlphaMode is Opaque
    float metalness = 0;
    float perceptualRoughness = 1;
    glm::vec3 dielectricF0{0.04f};
    float diffuseWeight = 1;
    float specularWeight = 1; // Schlick F90; with an F0 of 0 too, 0 removes the specular lobe
    glm::vec3 emission{0};    // cd/m^2
    float normalScale = 1;
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f;
    bool doubleSided = false;
    // Lights add nothing, and the emission is multiplied by baseColorTexture and vertex colours.
    bool unlit = false;
    TextureRef baseColorTexture;         // sRGB rgb, a: coverage
    TextureRef metallicRoughnessTexture; // g: roughness, b: metalness
    TextureRef normalTexture;            // tangent space, xyz * 2 - 1
    TextureRef emissiveTexture;          // sRGB
};

struct Instance {
    uint32_t mesh = 0;
    uint32_t material = 0;
    glm::dmat4 worldFromObject{1};
    uint32_t occluderLayer = 0; // as CndOccluderInstance::occluderLayer
};

// A run of Scene::instances.
struct InstanceRange {
    size_t first = 0, count = 0;

    bool operator==(const InstanceRange&) const = default;
};

// A node of a glTF file.
struct SceneNode {
    std::string name;        // may be empty
    uint32_t fileIndex = 0;  // its number in the file
    InstanceRange instances; // its own and those of the nodes below it
};

// A plane or a ball, exact and ray-cast per pixel. A plane is visible only from the side to which
// its normal points.
struct AnalyticObject {
    enum class Type { Plane, Ball } type = Type::Plane;
    glm::dvec3 point{0};        // plane: a point on it; ball: centre
    glm::dvec3 normal{0, 1, 0}; // plane: unit vector; not used for a ball
    double radius = 1;          // ball: metres; not used for a plane
    uint32_t material = 0;
    uint32_t occluderLayer = 0; // as CndOccluderInstance::occluderLayer
};

struct Camera {
    std::string name;
    glm::dvec3 position{0};
    glm::dvec3 forward{0, 0, -1}; // unit vector
    glm::dvec3 up{0, 1, 0};       // unit vector, not parallel to forward
    bool orthographic = false;
    double verticalFov = 0.9;      // radians, for perspective cameras
    double orthographicHeight = 1; // full height in metres, for orthographic cameras
    std::optional<double> aspect;  // width / height; empty: the image's aspect is used
    double nearPlane = 0.05;       // metres
    double farPlane = 0;           // metres; 0: infinite (perspective cameras only)
    uint32_t layers = 0;           // as CndLightingFrame::layers

    bool operator==(const Camera&) const = default;
};

// The motion of a light, which depends on the time t alone. At t the light is at its position plus
// axisU cos(phase + angularSpeed t) + axisV sin(phase + angularSpeed t), which is a circle if both
// axes are perpendicular and equally long.
struct LightMotion {
    glm::vec3 axisU{0}, axisV{0}; // metres
    float angularSpeed = 0;       // rad/s
    float phase = 0;              // radians
};

// An equirectangular image around the scene: its top row is straight up, its middle is the
// direction -z, and +x is to the right of that.
struct SceneEnvironment {
    std::string file;    // the file that it was loaded from; "studio" if none, see load/studio.h
    Image radiance;      // cd/m^2
    double rotation = 0; // radians about the y axis, counter-clockwise seen from above
    double scale = 1;    // factor that multiplies the radiance
};

struct Scene {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Instance> instances;
    std::vector<SceneNode> nodes; // of glTF files: those with a mesh, or with one below them
    std::vector<AnalyticObject> analyticObjects;
    glm::dvec3 lightOrigin{0}; // light positions are relative to this point
    std::vector<CndLight> lights;
    // Corners to which CndLight::polygon points. Copies of the scene share them: they never change.
    std::vector<std::shared_ptr<const CndPolygon>> polygons;
    std::vector<LightMotion> lightMotions; // empty, or one per light
    std::vector<Camera> cameras;           // at least one after loading
    size_t defaultCamera = 0;              // index of the camera that is used without a choice
    bool interior = false;                 // it is known to be a room
    glm::vec3 background{0};               // luminance of pixels without a surface, cd/m^2
    std::optional<SceneEnvironment> environment;
    // With automatic exposure: the EV100 to use instead, because the light of the scene is known.
    std::optional<float> knownEv100;
    // EV, added to the compensation of every frame. Scenes at night have a negative one, as in
    // photography: metered to middle grey, a night would look like a day.
    float exposureCompensation = 0;
    CndLobeJoining lobes = CND_LOBES_CONSERVING;
    bool energyCompensation = false;      // add the light that bounces between microfacets
    std::optional<glm::uvec2> resolution; // default image size
    bool lightsVisible = true;            // draw area lights as emitters
    // One sentence for each thing in the file that the program does not use or that looks wrong.
    std::vector<std::string> warnings;
    std::vector<std::string> notes; // what the program has chosen or found, one sentence each
};

struct Bounds {
    glm::dvec3 min{0}, max{0};
};
// Axis-aligned bounds of all instances, without analytic objects. {0,0} if there are no instances.
Bounds sceneBounds(const Scene& scene);

// Tells whether some surface has no specular lobe. `materials`: those of the scene, or as many
// others in their place.
bool hasDiffuseOnlySurfaces(const Scene& scene, const std::vector<Material>& materials);

// True if the light has a layer in common with the camera. A mask of 0 stands for all layers.
bool isShown(const CndLight& light, const Camera& camera);

// The lights that have a layer in common with the camera, in the same order.
std::vector<CndLight> lightsShown(const std::vector<CndLight>& lights, const Camera& camera);

// Returns a light of the scene at the place where it is at `time` seconds.
CndLight lightAtTime(const Scene& scene, size_t light, double time);

// Sets `out` to the scene's lights, the moving ones at the places where they are at `time` seconds.
void lightsAtTime(const Scene& scene, double time, std::vector<CndLight>& out);

// Positions of lights in files are in double precision, while CndLight has floats relative to
// Scene::lightOrigin. Chooses that origin and sets the positions of scene.lights to
// `worldPositions`, which has one position per light in metres. The origin is 0 if no coordinate of
// a light exceeds 1024 m, where floats are 0.06 mm apart, else the centre of the positions' bounds.
// Lights that are infinitely far away have no position and are left alone.
void placeLights(Scene& scene, const std::vector<glm::dvec3>& worldPositions);

} // namespace candelabra::app
