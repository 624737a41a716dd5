// SPDX-License-Identifier: Apache-2.0
#include "load/studio.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "load/brightness.h"
#include "scene/cofactors.h"

namespace candelabra::app
{
namespace
{

using std::numbers::pi;

// A round light with a soft edge, in the space of the environment, where the camera looks along -z.
struct SoftLight {
    double azimuth, elevation; // radians; azimuth to the right of the direction towards the camera
    double halfAngle;          // radians; from there on it gives nothing
    double luminance;          // of its middle, relative
};

constexpr SoftLight key = {-0.75, 0.6, 0.6, 9.0}; // left of the camera and above
constexpr SoftLight softLights[] = {
    key,
    {1.1, 0.3, 0.7, 0.7},  // fill: right of the camera
    {2.6, 0.7, 0.35, 6.0}, // from behind, for an edge of light
};

glm::dvec3 directionOf(const SoftLight& light)
{
    return {std::sin(light.azimuth) * std::cos(light.elevation), std::sin(light.elevation),
            std::cos(light.azimuth) * std::cos(light.elevation)};
}

double smoothStep(double from, double to, double x)
{
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

double skyLuminance(const glm::dvec3& direction)
{
    const double up = direction.y;
    // The floor is darkest straight below, and the ceiling a little brighter than the walls. All
    // are grey, so that both white and black objects stand out from them.
    double out = 0.13 + 0.14 * smoothStep(-0.7, 0.05, up) + 0.05 * smoothStep(0.0, 0.9, up);
    for (const SoftLight& light : softLights) {
        const double angle =
            std::acos(std::clamp(glm::dot(directionOf(light), direction), -1.0, 1.0));
        out += light.luminance * (1 - smoothStep(0.35 * light.halfAngle, light.halfAngle, angle));
    }
    return out;
}

// The areas of instances. Every mesh is looked at once, so that the time does not grow with the
// triangles of all instances, which may be very many in a small file.
class Areas
{
public:
    explicit Areas(const Scene& scene) : scene_(scene), meshes_(scene.meshes.size()) {}

    // Returns the area of an instance in m^2. It is exact if the mesh is flat or the transform
    // keeps shapes, and else may be too large: the root mean square over the mesh stands for the
    // mean factor by which the transform enlarges an area.
    double of(const Instance& instance);

private:
    struct MeshArea {
        double area = 0;
        glm::dmat3 normals{0}; // the sum over triangles of area * n * transpose(n), n the normal
    };
    static MeshArea measured(const Mesh& mesh);

    const Scene& scene_;
    std::vector<std::optional<MeshArea>> meshes_; // measured when first needed
};

Areas::MeshArea Areas::measured(const Mesh& mesh)
{
    MeshArea out;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto corner = [&](size_t k) {
            return glm::dvec3(mesh.vertices[mesh.indices[i + k]].position);
        };
        const glm::dvec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
        const double length = glm::length(normal);
        out.area += 0.5 * length;
        if (length > 0)
            out.normals += glm::outerProduct(0.5 * normal, normal / length);
    }
    return out;
}

double Areas::of(const Instance& instance)
{
    std::optional<MeshArea>& mesh = meshes_[instance.mesh];
    if (!mesh)
        mesh = measured(scene_.meshes[instance.mesh]);
    const glm::dmat3 c = cofactors(glm::dmat3(instance.worldFromObject));
    const glm::dmat3 squares = c * mesh->normals * glm::transpose(c);
    // Rounding may make the trace of a flat mesh that is seen edge-on negative.
    const double trace = std::max(0.0, squares[0][0] + squares[1][1] + squares[2][2]);
    return std::sqrt(mesh->area * trace);
}

// Finds how much surfaces glow. It reads every texture once.
class Glow
{
public:
    explicit Glow(const Scene& scene) : scene_(scene), means_(scene.textures.size()) {}

    // Returns the mean luminance of what a material emits, in cd/m^2 and at most 1: a brighter glow
    // is no easier to see. All parts of its texture count equally, whichever part surfaces show.
    double of(const Material& material);

private:
    const Scene& scene_;
    std::vector<std::optional<glm::vec3>> means_; // of textures, computed when first needed
};

double Glow::of(const Material& material)
{
    glm::vec3 emission = material.emission;
    if (const int32_t texture = material.emissiveTexture.texture; texture >= 0) {
        std::optional<glm::vec3>& mean = means_[size_t(texture)];
        if (!mean)
            mean = meanOfSrgb(scene_.textures[size_t(texture)]);
        emission *= *mean;
    }
    const float rgb[3] = {emission.r, emission.g, emission.b};
    return std::min(luminanceOf(rgb), 1.0);
}

} // namespace

bool isLit(const Scene& scene)
{
    const auto emits = [](const CndLight& light) {
        return std::ranges::any_of(light.emission, [](float e) { return e > 0; });
    };
    return scene.environment || std::ranges::any_of(scene.lights, emits);
}

float studioWhite(const Scene& scene)
{
    const auto materialOf = [&](const Instance& instance) -> const Material& {
        return scene.materials[instance.material];
    };
    if (std::ranges::none_of(scene.instances,
                             [&](const Instance& instance) { return materialOf(instance).unlit; }))
        return 1;
    Areas areas(scene);
    Glow glow(scene);
    double unlit = 0, glowing = 0; // m^2
    for (const Instance& instance : scene.instances) {
        const Material& material = materialOf(instance);
        if (material.unlit)
            unlit += areas.of(instance);
        else if (material.emission != glm::vec3(0))
            glowing += areas.of(instance) * glow.of(material);
    }
    return unlit >= glowing ? unlitLuminance : 1;
}

float studioEv100(float white)
{
    return std::log2(0.18f * white * 100 / 12.5f);
}

SceneEnvironment studioEnvironment(const Camera& defaultCamera, float white)
{
    SceneEnvironment out;
    out.file = "studio";
    Image& image = out.radiance;
    image = {.width = 512, .height = 256, .channels = 3, .pixels = {}};
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            const float luminance = float(skyLuminance(equirectangularDirection(image, x, y)));
            image.pixels.insert(image.pixels.end(), {luminance, luminance, luminance});
        }
    out.scale = pi * double{white} / planeIlluminance(out, directionOf(key));
    const glm::dvec3& forward = defaultCamera.forward;
    out.rotation = std::atan2(-forward.x, -forward.z);
    return out;
}

} // namespace candelabra::app
