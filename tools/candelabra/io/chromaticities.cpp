// SPDX-License-Identifier: Apache-2.0
#include "io/chromaticities.h"

#include <algorithm>
#include <cmath>

namespace candelabra::app
{
namespace
{

bool isNear(const Chromaticities& a, const Chromaticities& b)
{
    constexpr double tolerance = 1e-3; // headers have three or four digits
    const auto near = [](const glm::dvec2& p, const glm::dvec2& q) {
        return std::max(std::abs(p.x - q.x), std::abs(p.y - q.y)) < tolerance;
    };
    return near(a.red, b.red) && near(a.green, b.green) && near(a.blue, b.blue) &&
           near(a.white, b.white);
}

// XYZ of a chromaticity, times its y.
glm::dvec3 xyzOf(const glm::dvec2& c)
{
    return {c.x, c.y, 1 - c.x - c.y};
}

glm::dvec3 whiteOf(const Chromaticities& c)
{
    return xyzOf(c.white) / c.white.y;
}

// The matrix is singular, or has infinite elements, if the chromaticities span no colours.
glm::dmat3 xyzFromRgb(const Chromaticities& c)
{
    const glm::dmat3 primaries(xyzOf(c.red), xyzOf(c.green), xyzOf(c.blue));
    const glm::dvec3 scale = glm::inverse(primaries) * whiteOf(c);
    return {primaries[0] * scale.x, primaries[1] * scale.y, primaries[2] * scale.z};
}

// Bradford's chromatic adaptation of XYZ from one white to another (Lam 1985).
glm::dmat3 adaptation(const glm::dvec3& from, const glm::dvec3& to)
{
    const glm::dmat3 cones = glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614, // row by row
                                                       -0.7502, 1.7135, 0.0367, //
                                                       0.0389, -0.0685, 1.0296));
    const glm::dvec3 scale = (cones * to) / (cones * from);
    return glm::inverse(cones) * glm::dmat3(scale.x, 0, 0, 0, scale.y, 0, 0, 0, scale.z) * cones;
}

} // namespace

bool convertToRec709(Image& image, const Chromaticities& from)
{
    const Chromaticities rec709;
    const Chromaticities xyz{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};
    if (image.channels != 3 || isNear(from, rec709))
        return true;
    const glm::dmat3 adapted =
        isNear(from, xyz) ? glm::dmat3(1) : adaptation(whiteOf(from), whiteOf(rec709));
    const glm::dmat3 matrix = glm::inverse(xyzFromRgb(rec709)) * adapted * xyzFromRgb(from);
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            if (!(std::abs(matrix[c][r]) < 1e3)) // also true for NaN
                return false;
    if (std::abs(glm::determinant(matrix)) < 1e-6)
        return false;
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
        float* pixel = &image.pixels[i];
        const glm::dvec3 rgb = matrix * glm::dvec3(pixel[0], pixel[1], pixel[2]);
        // A value that is negative by rounding alone becomes 0.
        const double rounding = 1e-5 * std::max({rgb.r, rgb.g, rgb.b});
        for (int c = 0; c < 3; ++c)
            pixel[c] = std::abs(rgb[c]) <= rounding ? 0 : float(rgb[c]);
    }
    return true;
}

} // namespace candelabra::app
