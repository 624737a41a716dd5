// SPDX-License-Identifier: Apache-2.0
// Tests the directional albedo of the reference BRDF against a second integrator over light
// directions, and how much of uniform surroundings each way of joining the lobes reflects.
#include <cmath>
#include <iostream>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "harness/constants.h"
#include "reference/albedo.h"
#include "reference/brdf.h"
#include "test_reference_support.h"

namespace candelabra::test
{

using namespace candelabra::reference;

namespace
{

// Midpoint rule over light directions in polar coordinates around the mirror direction, where the
// lobe is. It shares nothing with the quadrature over microfacet normals.
DirectionalAlbedo overLightDirections(double NoV, double alpha)
{
    const double sinV = std::sqrt(1 - NoV * NoV);
    const glm::dvec3 n(0, 0, 1), v(sinV, 0, NoV), mirror(-sinV, 0, NoV);
    const glm::dvec3 side(0, 1, 0), up = glm::cross(mirror, side);
    DirectionalAlbedo sum;
    const int rings = 1500, spokes = 720;
    for (int ring = 0; ring < rings; ++ring) {
        const double u = (ring + 0.5) / rings;
        const double angle = pi * u * u; // concentrates rings near the mirror direction
        const double area = std::sin(angle) * 2 * pi * u / rings * (2 * pi / spokes);
        for (int spoke = 0; spoke < spokes; ++spoke) {
            const double phi = 2 * pi * (spoke + 0.5) / spokes;
            const glm::dvec3 l = std::cos(angle) * mirror +
                                 std::sin(angle) * (std::cos(phi) * side + std::sin(phi) * up);
            const SpecularBrdf brdf = ggxBrdf(n, v, glm::normalize(l), alpha);
            const double share = brdf.value * std::max(l.z, 0.0) * area;
            sum.a += share;
            sum.b += share * brdf.schlickWeight;
        }
    }
    return sum;
}

} // namespace

TEST(ReferenceAlbedo, agreesWithQuadratureOverLightDirections)
{
    WorstCase worst;
    for (const double alpha : {0.1, 0.3, 1.0})
        for (const double NoV : {0.05, 0.3, 0.9}) {
            const DirectionalAlbedo expected = overLightDirections(NoV, alpha);
            const DirectionalAlbedo albedo = specularAlbedo(NoV, alpha);
            worst.add(std::abs(albedo.a - expected.a), "a alpha", alpha, "NoV", NoV);
            worst.add(std::abs(albedo.b - expected.b), "b alpha", alpha, "NoV", NoV);
        }
    EXPECT_TRUE(worst.within(1e-4));
}

// For perpendicular view and alpha = 1: D = 1 / pi and Lambda(v) = 0, so a is the integral of 4
// cos(h) G2 d(cos h) over cos(h) > sqrt(1/2) with G2 = 2 NoL / (1 + NoL) and NoL = 2 cos^2(h) - 1,
// which is 1 - ln 2.
TEST(ReferenceAlbedo, perpendicularViewOfTheRoughestLobeHasAClosedForm)
{
    EXPECT_NEAR(specularAlbedo(1, 1).a, 1 - std::numbers::ln2, 1e-6);
}

TEST(ReferenceAlbedo, staysBetweenZeroAndOneAndNearsOneForSmoothSurfaces)
{
    for (const double alpha : {0.002, 0.02, 0.2, 1.0})
        for (const double NoV : {1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0}) {
            const DirectionalAlbedo albedo = specularAlbedo(NoV, alpha, 1e-5);
            EXPECT_GT(albedo.a, 0.3);
            EXPECT_LE(albedo.a, 1);
            EXPECT_GE(albedo.b, 0);
            EXPECT_LE(albedo.b, albedo.a);
        }
    EXPECT_NEAR(specularAlbedo(0.5, 0.002).a, 1, 1e-4);
}

// Shows why `conserving` scales the diffuse lobe by the albedo table. glTF 2.0 (appendix B) scales
// it for each light by 1 - F(VoH), and a white dielectric would then be brighter than its uniform
// surroundings.
TEST(ReferenceAlbedo, glTFMixReflectsMoreThanThereIs)
{
    const double F0 = 0.04;
    double most = 0, mostAt = 0, mostAlpha = 0;
    for (const double alpha : {0.002, 0.04, 0.2, 0.5, 1.0})
        for (const double NoV : {0.001, 0.01, 0.03, 0.1, 0.2, 0.5, 1.0}) {
            const DirectionalAlbedo s = specularAlbedo(NoV, alpha, 1e-5);
            const double diffuse = 1 - F0 - (1 - F0) * schlickShareOfDiffuse(NoV);
            const double total = diffuse + F0 * (s.a - s.b) + s.b;
            if (total > most) {
                most = total;
                mostAt = NoV;
                mostAlpha = alpha;
            }
        }
    std::cout << "glTF's mix of a white dielectric reflects up to " << most << " (alpha "
              << mostAlpha << ", NoV " << mostAt << ")\n";
    EXPECT_GT(most, 1.5);
}

TEST(ReferenceAlbedo, refusesWhatIsOutsideItsDomain)
{
    EXPECT_THROW(specularAlbedo(0, 0.5), std::domain_error);
    EXPECT_THROW(specularAlbedo(1.1, 0.5), std::domain_error);
    EXPECT_THROW(specularAlbedo(0.5, 0.001), std::domain_error);
    EXPECT_THROW(specularAlbedo(NAN, 0.5), std::domain_error);
    EXPECT_THROW(schlickShareOfDiffuse(0), std::domain_error);
}

} // namespace candelabra::test
