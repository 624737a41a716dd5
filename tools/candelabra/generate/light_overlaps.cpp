// SPDX-License-Identifier: Apache-2.0
#include "generate/light_overlaps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "generate/light_grid.h"
#include "generate/random.h"
#include "generate/ray_caster.h"

namespace candelabra::app
{
namespace
{

// 5184 samples: about 1.4% standard error of a mean whose spread is its own size. 16:9.
constexpr uint32_t sampleColumns = 96, sampleRows = 54;
// Fewer hits than this and the camera does not speak for the scene.
constexpr size_t fewHits = 256;
constexpr uint32_t spreadSampleCount = 4096;
// Bounds time and memory when many lights overlap.
constexpr double maxPairs = 2e7;
constexpr size_t minSamples = 64;

struct WorldTriangle {
    glm::dvec3 corner[3];
};

// Points evenly spread over the area of all instances.
std::vector<SurfaceSample> spreadSamples(const Scene& scene)
{
    std::vector<WorldTriangle> triangles;
    std::vector<double> areaUpTo;
    double area = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            WorldTriangle triangle;
            for (size_t k = 0; k < 3; ++k) {
                const glm::vec3& p = mesh.vertices[mesh.indices[i + k]].position;
                triangle.corner[k] = glm::dvec3(instance.worldFromObject * glm::dvec4(p, 1));
            }
            area += 0.5 * glm::length(glm::cross(triangle.corner[1] - triangle.corner[0],
                                                 triangle.corner[2] - triangle.corner[0]));
            triangles.push_back(triangle);
            areaUpTo.push_back(area);
        }
    }
    std::vector<SurfaceSample> samples;
    if (!std::isfinite(area) || area <= 0)
        return samples;
    Random random(0);
    for (uint32_t i = 0; i < spreadSampleCount; ++i) {
        const double at = area * (i + 0.5) / spreadSampleCount;
        const size_t t = size_t(std::ranges::lower_bound(areaUpTo, at) - areaUpTo.begin());
        const WorldTriangle& triangle = triangles[std::min(t, triangles.size() - 1)];
        glm::dvec2 uv(random.uniform2());
        uv = uv.x + uv.y > 1 ? 1.0 - uv : uv;
        const glm::dvec3 edge1 = triangle.corner[1] - triangle.corner[0];
        const glm::dvec3 edge2 = triangle.corner[2] - triangle.corner[0];
        samples.push_back({triangle.corner[0] + uv.x * edge1 + uv.y * edge2,
                           glm::normalize(glm::cross(edge1, edge2))});
    }
    return samples;
}

// The scale from which on a light contributes to a sample.
double criticalScale(const SurfaceSample& sample, const LightReach& light)
{
    const glm::dvec3 toLight = light.position - sample.position;
    const double height = glm::dot(sample.normal, toLight);
    double needed = glm::length(toLight);
    if (height < 0) {
        // The centre is below the horizon: the radius must reach above it.
        if (light.radius <= -height)
            return std::numeric_limits<double>::infinity();
        needed = std::max(needed, -height / light.radiusShare);
    }
    return needed / light.reach;
}

// Lights of similar reach together, so that a search need not look as far as the longest of all.
class GridsByReach
{
public:
    explicit GridsByReach(const std::vector<LightReach>& lights) : lights_(lights)
    {
        std::map<int, std::vector<uint32_t>> byExponent;
        for (uint32_t i = 0; i < lights.size(); ++i)
            byExponent[std::ilogb(lights[i].reach)].push_back(i);
        for (auto& [exponent, members] : byExponent) {
            std::vector<glm::dvec3> positions;
            for (const uint32_t light : members)
                positions.push_back(lights[light].position);
            grids_.push_back({std::ldexp(1.0, exponent + 1), LightGrid(positions), members});
        }
    }

    // Critical scales below `scale` of all pairs of samples and lights; stops beyond `limit`.
    void collect(const std::vector<SurfaceSample>& samples, double scale, size_t limit,
                 std::vector<double>& criticals) const
    {
        criticals.clear();
        for (const ReachGrid& reachGrid : grids_) {
            for (const SurfaceSample& sample : samples) {
                reachGrid.grid.visit(
                    sample.position, scale * reachGrid.maxReach, [&](uint32_t member) {
                        const double critical =
                            criticalScale(sample, lights_[reachGrid.members[member]]);
                        if (critical < scale)
                            criticals.push_back(critical);
                    });
                if (criticals.size() > limit)
                    return;
            }
        }
    }

private:
    struct ReachGrid {
        double maxReach;
        LightGrid grid;
        std::vector<uint32_t> members;
    };

    const std::vector<LightReach>& lights_;
    std::vector<ReachGrid> grids_;
};

// A scale at which every light covers every sample.
double unlimitedScale(const std::vector<SurfaceSample>& samples,
                      const std::vector<LightReach>& lights)
{
    glm::dvec3 low = samples.front().position, high = low;
    double minReach = lights.front().reach, minShare = maxRadiusShare;
    for (const SurfaceSample& sample : samples) {
        low = glm::min(low, sample.position);
        high = glm::max(high, sample.position);
    }
    for (const LightReach& light : lights) {
        low = glm::min(low, light.position);
        high = glm::max(high, light.position);
        minReach = std::min(minReach, light.reach);
        minShare = std::min(minShare, light.radiusShare);
    }
    // Below the horizon a light needs distance / radiusShare; 1% on top makes it strict.
    return 1.01 * std::max(glm::length(high - low), 1e-3) / (minShare * minReach);
}

std::vector<SurfaceSample> thinned(const std::vector<SurfaceSample>& samples, double overlaps)
{
    const double affordable = maxPairs / overlaps;
    if (affordable >= double(samples.size()) || samples.size() <= minSamples)
        return samples;
    const size_t wanted = std::max(minSamples, size_t(affordable));
    std::vector<SurfaceSample> some;
    for (size_t i = 0; i < wanted; ++i)
        some.push_back(samples[i * samples.size() / wanted]);
    return some;
}

} // namespace

std::vector<SurfaceSample> visibleSamples(const Scene& scene)
{
    std::vector<SurfaceSample> samples;
    if (!scene.cameras.empty()) {
        RayCaster caster(scene);
        const Camera& camera = scene.cameras[scene.defaultCamera];
        for (uint32_t y = 0; y < sampleRows; ++y) {
            for (uint32_t x = 0; x < sampleColumns; ++x) {
                const auto hit = caster.cast(cameraRay(camera, x, y, sampleColumns, sampleRows));
                if (hit)
                    samples.push_back({hit->position, hit->normal});
            }
        }
    }
    if (samples.size() < fewHits) {
        std::vector<SurfaceSample> spread = spreadSamples(scene);
        if (!spread.empty())
            return spread;
    }
    return samples;
}

OverlapScale scaleForOverlaps(const std::vector<SurfaceSample>& samples,
                              const std::vector<LightReach>& lights, double overlaps)
{
    if (samples.empty() || lights.empty())
        return {};
    const std::vector<SurfaceSample> used = thinned(samples, overlaps);
    const GridsByReach grids(lights);
    const size_t wanted = std::max<size_t>(1, size_t(std::llround(overlaps * double(used.size()))));
    // From below: 30% steps of the scale at most double the pairs, so the last step dominates.
    const double unlimited = unlimitedScale(used, lights);
    double scale = unlimited / 1024;
    std::vector<double> criticals;
    const auto collect = [&](size_t limit) { grids.collect(used, scale, limit, criticals); };
    // Well too many pairs: stop early and look closer.
    for (collect(4 * wanted); criticals.size() > 4 * wanted; collect(4 * wanted))
        scale *= 0.5;
    while (criticals.size() <= wanted && scale < unlimited) {
        scale = std::min(1.3 * scale, unlimited);
        collect(std::numeric_limits<size_t>::max());
    }
    if (criticals.size() < wanted)
        return {0, double(criticals.size()) / double(used.size())};
    if (criticals.size() == wanted)
        return {unlimited, overlaps};
    const auto middle = criticals.begin() + std::ptrdiff_t(wanted);
    std::nth_element(criticals.begin(), middle, criticals.end());
    return {*middle, overlaps};
}

} // namespace candelabra::app
