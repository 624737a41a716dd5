// SPDX-License-Identifier: Apache-2.0
// Tests what packing into the FULL layout costs: random materials are lit from it and from a host's
// layout of 32-bit floats, in which nothing is rounded.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "gpu/host_gbuffer_harness.h"

namespace candelabra::test
{
namespace
{

constexpr CndGBufferDesc floatLayout{.normalEncoding = CND_NORMAL_SNORM,
                                     .normalSpace = CND_NORMALS_VIEW,
                                     .roughness = CND_CHANNEL_NORMAL_A,
                                     .reflectance = CND_REFLECTANCE_SPECULAR,
                                     .f90 = CND_CHANNEL_SPECULAR_A,
                                     .normalRoughnessFormat = VK_FORMAT_R32G32B32A32_SFLOAT,
                                     .albedoFormat = VK_FORMAT_R32G32B32A32_SFLOAT,
                                     .specularFormat = VK_FORMAT_R32G32B32A32_SFLOAT,
                                     .depthFormat = VK_FORMAT_R32_SFLOAT};

// The same surfaces in both layouts.
struct Surfaces {
    CpuGBuffer full;
    HostPixels exact;

    Surfaces(uint32_t width, uint32_t height)
        : full{.width = width, .height = height},
          exact{.desc = floatLayout, .width = width, .height = height}
    {
    }
    // The next pixel. The normal is (0, 0, 1), which both layouts store exactly.
    void add(CpuSurface surface)
    {
        surface.depth = depthAt(full.camera, 5);
        addPixel(full, surface);
        appendTexel(exact.images[0], floatLayout.normalRoughnessFormat,
                    {surface.normal, surface.perceptualRoughness});
        appendTexel(exact.images[1], floatLayout.albedoFormat, {surface.albedo, 1});
        appendTexel(exact.images[2], floatLayout.specularFormat, surface.F0F90);
        appendDepth(exact.depth, floatLayout.depthFormat, double(surface.depth));
    }
};

} // namespace

class GBufferPrecision : public HostGBufferTest
{
protected:
    // Lights both layouts by the closed form.
    struct Lit {
        std::vector<glm::vec4> full, exact;
    };
    Lit light(const Surfaces& s, const std::vector<CndLight>& lights, CndLobeJoining lobes)
    {
        const HostImages images = uploadHost(s.exact);
        RunOptions options{.specular = CND_SPECULAR_CONIC, .lobes = lobes};
        Lit lit{.full = run(s.full, lights, options).radiance, .exact = {}};
        options.layout = CND_GBUFFER_HOST;
        options.gbuffer = floatLayout;
        options.withFrame = [&](CndLightingFrame& frame) { frame = withHost(frame, images); };
        lit.exact = run(s.full, lights, options).radiance;
        return lit;
    }
};

// A thousand materials whose albedo and F0 are 0.01 to 1; a third of them have the diffuse lobe
// only, a third the specular lobe only.
TEST_F(GBufferPrecision, ColoursCostThreeMillionths)
{
    Surfaces s(40, 25);
    setPerspective(s.full.camera, 0.6, 1.6, 0.1);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> exponent(std::log(0.01), 0), roughness(0.2, 1);
    const auto colour = [&] {
        const double r = std::exp(exponent(random)), g = std::exp(exponent(random));
        return glm::dvec3(r, g, std::exp(exponent(random)));
    };
    for (uint32_t i = 0; i < 1000; ++i) {
        // The nearest roughness that the layout stores, so that colours alone are rounded.
        CpuGBuffer stored;
        addPixel(stored, {.perceptualRoughness = roughness(random)});
        s.add({.perceptualRoughness = storedRoughness(stored, 0),
               .albedo = i % 3 == 1 ? glm::dvec3(0) : colour(),
               .F0F90 = i % 3 == 0 ? glm::dvec4(0) : glm::dvec4(colour(), 1)});
    }
    const std::vector<CndLight> lights{{.type = CND_LIGHT_SPHERE,
                                        .position = {1, 1.5f, -2},
                                        .radius = 0.4f,
                                        .emission = {100, 200, 300},
                                        .influenceRadius = 100}};
    const Lit sum = light(s, lights, CND_LOBES_SUM);
    const Lit conserving = light(s, lights, CND_LOBES_CONSERVING);
    double worstSum = 0, worstConserving = 0;
    for (size_t i = 0; i < sum.full.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double exact = sum.exact[i][c];
            ASSERT_GT(exact, 0) << i;
            worstSum = std::max(worstSum, std::abs(sum.full[i][c] - exact) / exact);
            // Joined lobes scale the diffuse one by what F0 leaves, which may be close to nothing,
            // so the error is put in relation to both lobes alone.
            const double error = double(conserving.full[i][c]) - double(conserving.exact[i][c]);
            worstConserving = std::max(worstConserving, std::abs(error) / exact);
        }
    std::printf("colours: largest relative error of radiance %.3g, with joined lobes %.3g\n",
                worstSum, worstConserving);
    EXPECT_LE(worstSum, 3e-6);
    EXPECT_LE(worstConserving, 3e-6);
    EXPECT_GT(worstSum, 1e-6); // the two frames do come from different layouts
}

// A thousand roughnesses, one per row, under a point light at the eye. The pixels of a row lead
// from the peak of the lobe to three times its width.
TEST_F(GBufferPrecision, RoughnessCostsLittleOfThePeak)
{
    constexpr uint32_t columns = 32, rows = 250;
    constexpr double lowest = 0.0447; // alpha 0.002
    const std::vector<CndLight> lights{{.type = CND_LIGHT_POINT,
                                        .position = {0, 0, 0},
                                        .emission = {100, 200, 300},
                                        .influenceRadius = 1000}};
    std::mt19937 random(6);
    double worst = 0;
    for (int range = 0; range < 4; ++range) {
        const double from = lowest * std::exp2(range * 1.12), to = from * std::exp2(1.12);
        std::uniform_real_distribution<double> roughness(from, std::min(to, 1.0));
        Surfaces s(columns, rows);
        // The tangent of the angle between the axis and the last column is 3 alpha of the roughest.
        const double width = 3 * to * to, height = 1e-3 * width;
        setPerspective(s.full.camera, 2 * std::atan(height), width / height, 0.1);
        s.full.camera.clipFromView[8] = 1; // the axis is at the left edge of the image
        for (uint32_t row = 0; row < rows; ++row) {
            const double r = range == 0 && row == 0 ? lowest : roughness(random);
            for (uint32_t column = 0; column < columns; ++column)
                s.add({.perceptualRoughness = r, .F0F90 = {1, 1, 1, 1}});
        }
        const Lit lit = light(s, lights, CND_LOBES_SUM);
        for (uint32_t row = 0; row < rows; ++row) {
            const auto begin = lit.exact.begin() + row * columns;
            const double peak =
                std::max_element(begin, begin + columns, [](const auto& a, const auto& b) {
                    return a.x < b.x;
                })->x;
            ASSERT_GT(peak, 0);
            // The row leads far down the lobe.
            ASSERT_LT(lit.exact[(row + 1) * columns - 1].x, 0.2 * peak) << range << ' ' << row;
            for (uint32_t i = row * columns; i < (row + 1) * columns; ++i)
                worst = std::max(worst,
                                 std::abs(double(lit.full[i].x) - double(lit.exact[i].x)) / peak);
        }
    }
    std::printf("roughness: largest error %.3g of the peak\n", worst);
    EXPECT_LE(worst, 2e-4);
    EXPECT_GT(worst, 1e-6);
}

} // namespace candelabra::test
