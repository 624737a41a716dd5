// SPDX-License-Identifier: Apache-2.0
// Tests every light type with every specular method: clustered against brute force, and against the
// truth integrated in double precision.
#include "gpu/lighting_harness.h"

#include <cmath>

#include "harness/full_tests.h"
#include "reference/light.h"
#include "reference/truth.h"
#include "render/setting_names.h"
#include "scene/light_types.h"
#include "shading/light_family.h"

namespace candelabra::test
{

using app::lightTypeName;

namespace
{

std::vector<CndLightType> allTypes()
{
    std::vector<CndLightType> types;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        types.push_back(CndLightType(type));
    return types;
}

CndCamera camera()
{
    CndCamera out;
    setPerspective(out, 1.0, 1.5, 0.1);
    return out;
}

// TypeErrors relative to reflected luminance: mean and largest |image - truth|, divided by the mean
// and the largest truth.
struct TypeErrors {
    double mean = 0, max = 0;
};

} // namespace

class LightTypes : public LightingTest
{
protected:
    // Returns false for surfaces at a grazing angle or seen from behind: below a NoV of 0.02 the
    // closed form tilts the view.
    static bool isSeen(const CpuGBuffer& g, size_t pixel)
    {
        const glm::dvec3 position =
            viewPosition(g, uint32_t(pixel % g.width), uint32_t(pixel / g.width));
        return glm::dot(storedNormal(g, pixel), glm::normalize(-position)) > 0.05;
    }
    glm::dvec3 truthAt(const CpuGBuffer& g, size_t pixel, const std::vector<CndLight>& lights,
                       CndSpecularMethod method)
    {
        const glm::dvec3 position =
            viewPosition(g, uint32_t(pixel % g.width), uint32_t(pixel / g.width));
        const glm::dvec4 specular = storedSpecular(g, pixel);
        const double roughness = storedRoughness(g, pixel);
        const bool hasSpecular = method != CND_SPECULAR_NONE;
        const reference::Material material{.diffuseAlbedo = storedAlbedo(g, pixel),
                                           .f0 = hasSpecular ? glm::dvec3(specular) : glm::dvec3(0),
                                           .specularWeight = hasSpecular ? specular.w : 0,
                                           .alpha = roughness * roughness};
        const reference::SurfacePoint surface{position, storedNormal(g, pixel),
                                              glm::normalize(-position)};
        glm::dvec3 sum(0);
        for (const CndLight& light : lights) {
            sum += cndIsPunctual(light.type)
                       ? reference::outgoingLuminance(surface, material, light, glm::dvec3(0),
                                                      CND_SPECULAR_KARIS)
                       : reference::truthLuminance(surface, material, light, glm::dvec3(0), 1e-4)
                             .luminance;
        }
        return sum;
    }

    TypeErrors errorsOf(const CpuGBuffer& g, const std::vector<CndLight>& lights,
                        const RunOptions& options)
    {
        const LightingResult image = run(g, lights, options);
        double sum = 0, sumTruth = 0, peak = 0, worst = 0;
        for (size_t i = 0; i < g.depth.size(); ++i) {
            if (g.depth[i] == g.clearDepth || !isSeen(g, i))
                continue;
            const glm::dvec3 truth = truthAt(g, i, lights, options.specular);
            for (int c = 0; c < 3; ++c) {
                const double error = std::abs(image.radiance[i][c] - truth[c]);
                EXPECT_TRUE(std::isfinite(image.radiance[i][c]) && image.radiance[i][c] >= 0);
                sum += error;
                sumTruth += truth[c];
                worst = std::max(worst, error);
                peak = std::max(peak, truth[c]);
            }
        }
        EXPECT_GT(sumTruth, 0);
        return {sum / sumTruth, worst / peak};
    }
};

TEST_F(LightTypes, ClusteredEqualsBruteForceForEveryMethod)
{
    const CpuGBuffer g = randomGBuffer(72, 48, camera(), 0, 5);
    for (const CndLightType type : allTypes()) {
        const auto lights = lightsOf(type, g, 40, 9);
        const bool sphere = lighting::isSphere(type);
        for (const app::Choice<CndSpecularMethod>& choice : app::specularChoices) {
            const CndSpecularMethod method = choice.value;
            // The other types have fewer methods, some of which stand for several names.
            const bool stands = lighting::canonicalMethod(type, method) != method;
            // Kernels take long to create: for the other types only two methods are tested, all
            // with --full.
            const bool later = method == CND_SPECULAR_NONE || method == CND_SPECULAR_SAMPLED;
            if (!sphere && (stands || (later && !fullTests())))
                continue;
            RunOptions options{.specular = method, .sampleCount = 4};
            const LightingResult clustered = run(g, lights, options);
            options.culling = CND_CULLING_BRUTE;
            const LightingResult brute = run(g, lights, options);
            EXPECT_TRUE(agree(clustered.radiance, brute.radiance))
                << lightTypeName(type) << ", " << choice.name;
        }
    }
}

// All types in one set, in an order that sorting must change.
TEST_F(LightTypes, TypesMixInOneSet)
{
    const CpuGBuffer g = randomGBuffer(72, 48, camera(), 0, 6);
    RunOptions options{.specular = CND_SPECULAR_CONIC};
    std::vector<CndLight> mixed;
    std::vector<glm::vec4> sum(g.depth.size(), glm::vec4(0));
    for (const CndLightType type : allTypes()) {
        const auto lights = lightsOf(type, g, 20, 4 + type);
        const auto image = run(g, lights, options).radiance;
        for (size_t i = 0; i < sum.size(); ++i)
            sum[i] += image[i];
        mixed.insert(mixed.end(), lights.begin(), lights.end());
    }
    std::vector<CndLight> interleaved;
    for (uint32_t i = 0; i < 20; ++i)
        for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
            interleaved.push_back(mixed[type * 20 + i]);
    const auto image = run(g, interleaved, options).radiance;
    EXPECT_LE(maxRelativeDifference(image, sum), 1e-6);
}

// The diffuse term alone is a closed form for every type; the arcs of tubes have six edges.
TEST_F(LightTypes, DiffuseEqualsTruth)
{
    const CpuGBuffer g = randomGBuffer(48, 32, camera(), 0, 7);
    RunOptions options{.specular = CND_SPECULAR_NONE};
    for (const CndLightType type : allTypes()) {
        const TypeErrors e = errorsOf(g, lightsOf(type, g, 8, 2), options);
        std::cout << lightTypeName(type) << ": diffuse error mean " << e.mean
                  << ", largest over peak " << e.max << "\n";
        EXPECT_LE(e.mean, type == CND_LIGHT_TUBE ? 1e-3 : 3e-5) << lightTypeName(type);
        EXPECT_LE(e.max, type == CND_LIGHT_TUBE ? 3e-3 : 1e-4) << lightTypeName(type);
    }
}

// TypeErrors of the whole image: roughness 0.1 to 1, grazing normals, lights that cross the
// horizon.
TEST_F(LightTypes, DefaultMethodIsCloseToTruth)
{
    const CpuGBuffer g = randomGBuffer(36, 24, camera(), 0, 8);
    RunOptions closedForm{.specular = CND_SPECULAR_CONIC};
    RunOptions samples{.specular = CND_SPECULAR_SAMPLED, .sampleCount = 1024};
    for (const CndLightType type : allTypes()) {
        const auto lights = lightsOf(type, g, 6, 3);
        const TypeErrors conic = errorsOf(g, lights, closedForm);
        const TypeErrors sampled = errorsOf(g, lights, samples);
        std::cout << lightTypeName(type) << ": default method, error mean " << conic.mean
                  << ", largest over peak " << conic.max << "; 1024 samples " << sampled.mean
                  << ", " << sampled.max << "\n";
        const bool area = !cndIsPunctual(type) && !lighting::isSphere(type);
        // Relative to the luminance, not to the peak; with few lights single ones show.
        EXPECT_LE(conic.mean, area ? 0.1 : 8e-3) << lightTypeName(type);
        // Half of a tube's samples are on its far side, the others are concentrated at its near
        // end.
        EXPECT_LE(sampled.mean, type == CND_LIGHT_TUBE ? 0.15 : 0.02) << lightTypeName(type);
    }
}

} // namespace candelabra::test
