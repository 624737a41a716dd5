// SPDX-License-Identifier: Apache-2.0
#include "measure/accuracy/flip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace candelabra::app
{
namespace
{

using std::numbers::pi;
using Plane = std::vector<glm::vec3>;

struct Size {
    int width, height;
};

// --- Colour spaces, all relative to the white of the Rec.709 primaries

// Returns the XYZ of a linear RGB colour (IEC 61966-2-1).
glm::dvec3 xyzFromLinear(const glm::dvec3& c)
{
    return {0.4123865632529917 * c.x + 0.3575914909206253 * c.y + 0.1804504912035637 * c.z,
            0.2126368216773238 * c.x + 0.7151829818412507 * c.y + 0.0721801964814255 * c.z,
            0.0193306201524840 * c.x + 0.1191971636402085 * c.y + 0.9503725870054355 * c.z};
}

const glm::dvec3 white = xyzFromLinear(glm::dvec3(1));

glm::dvec3 linearFromXyz(const glm::dvec3& c)
{
    static const glm::dmat3 inverse = glm::inverse(
        glm::dmat3(xyzFromLinear({1, 0, 0}), xyzFromLinear({0, 1, 0}), xyzFromLinear({0, 0, 1})));
    return inverse * c;
}

double linearFromSrgb(double x)
{
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

// The opponent space in which contrast sensitivity is given: achromatic, red-green, blue-yellow.
glm::dvec3 opponentFromLinear(const glm::dvec3& c)
{
    const glm::dvec3 r = xyzFromLinear(c) / white;
    return {116 * r.y - 16, 500 * (r.x - r.y), 200 * (r.y - r.z)};
}

glm::dvec3 linearFromOpponent(const glm::dvec3& c)
{
    const double y = (c.x + 16) / 116;
    return linearFromXyz(glm::dvec3(y + c.y / 500, y, y - c.z / 200) * white);
}

// CIELAB with a and b scaled by lightness (the Hunt effect).
glm::dvec3 huntFromLinear(const glm::dvec3& c)
{
    const auto f = [](double t) {
        constexpr double delta = 6.0 / 29;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
    };
    const glm::dvec3 r = xyzFromLinear(c) / white;
    const double lightness = 116 * f(r.y) - 16;
    return {lightness, 0.01 * lightness * 500 * (f(r.x) - f(r.y)),
            0.01 * lightness * 200 * (f(r.y) - f(r.z))};
}

double hyab(const glm::dvec3& a, const glm::dvec3& b)
{
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// --- Filters

// Filters with (2 radius + 1)^2 weights per channel. Samples outside the image repeat its edge.
struct Filter {
    int radius;
    std::vector<glm::vec3> weights;
};

Plane convolve(const Plane& in, Size size, const Filter& filter)
{
    Plane out(in.size());
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            glm::vec3 sum(0);
            size_t k = 0;
            for (int dy = -filter.radius; dy <= filter.radius; ++dy) {
                const int row = std::clamp(y + dy, 0, size.height - 1) * size.width;
                for (int dx = -filter.radius; dx <= filter.radius; ++dx)
                    sum += filter.weights[k++] *
                           in[size_t(row + std::clamp(x + dx, 0, size.width - 1))];
            }
            out[size_t(y * size.width + x)] = sum;
        }
    return out;
}

// The contrast sensitivity of the three opponent channels as sums of two Gaussians (table 1 of the
// paper).
Filter contrastSensitivity(double pixelsPerDegree)
{
    struct Gaussians {
        double a1, b1, a2, b2;
    };
    constexpr Gaussians channels[3] = {
        {1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
    Filter out{int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * pixelsPerDegree)), {}};
    glm::dvec3 sum(0);
    for (int y = -out.radius; y <= out.radius; ++y)
        for (int x = -out.radius; x <= out.radius; ++x) {
            const double d2 = (double(x) * x + double(y) * y) / (pixelsPerDegree * pixelsPerDegree);
            glm::dvec3 w;
            for (int c = 0; c < 3; ++c) {
                const Gaussians& g = channels[c];
                w[c] = g.a1 * std::sqrt(pi / g.b1) * std::exp(-pi * pi * d2 / g.b1) +
                       g.a2 * std::sqrt(pi / g.b2) * std::exp(-pi * pi * d2 / g.b2);
            }
            sum += w;
            out.weights.push_back(w);
        }
    for (glm::vec3& w : out.weights)
        w /= glm::vec3(sum);
    return out;
}

// The first and second derivative of a Gaussian, in the components x and y of the weights. They are
// taken along the image's x axis or, if `alongX` is false, along its y axis. Positive weights add
// up to 1, negative ones to -1.
Filter features(double pixelsPerDegree, bool alongX)
{
    const double sd = 0.5 * 0.082 * pixelsPerDegree;
    Filter out{int(std::ceil(3 * sd)), {}};
    glm::dvec2 positive(0), negative(0);
    for (int y = -out.radius; y <= out.radius; ++y)
        for (int x = -out.radius; x <= out.radius; ++x) {
            const double g = std::exp(-(double(x) * x + double(y) * y) / (2 * sd * sd));
            const double t = alongX ? x : y;
            const glm::dvec2 w(-t * g, (t * t / (sd * sd) - 1) * g);
            for (int i = 0; i < 2; ++i)
                (w[i] > 0 ? positive : negative)[i] += std::abs(w[i]);
            out.weights.emplace_back(w.x, w.y, 0);
        }
    for (glm::vec3& w : out.weights)
        for (int i = 0; i < 2; ++i)
            w[i] = float(w[i] / (w[i] > 0 ? positive : negative)[i]);
    return out;
}

// --- The two halves of the measure

Plane filteredLab(const Plane& opponent, Size size, const Filter& sensitivity)
{
    Plane out = convolve(opponent, size, sensitivity);
    for (glm::vec3& p : out)
        p = huntFromLinear(glm::clamp(linearFromOpponent(p), 0.0, 1.0));
    return out;
}

// The colour difference of section 4.1.3 of the paper: HyAB, compressed so that large distances
// share the last 5% of the range.
double colourDifference(const glm::dvec3& a, const glm::dvec3& b)
{
    constexpr double exponent = 0.7, knee = 0.4, kneeValue = 0.95;
    static const double largest =
        std::pow(hyab(huntFromLinear({0, 1, 0}), huntFromLinear({0, 0, 1})), exponent);
    const double d = std::pow(hyab(a, b), exponent);
    return d < knee * largest
               ? d * kneeValue / (knee * largest)
               : kneeValue + (d - knee * largest) / (largest - knee * largest) * (1 - kneeValue);
}

struct Features {
    Plane x, y; // the components hold edges and points
};

Features featuresOf(const Plane& opponent, Size size, double pixelsPerDegree)
{
    Plane achromatic = opponent;
    for (glm::vec3& p : achromatic)
        p = glm::vec3((p.x + 16) / 116);
    return {convolve(achromatic, size, features(pixelsPerDegree, true)),
            convolve(achromatic, size, features(pixelsPerDegree, false))};
}

double featureDifference(const Features& a, const Features& b, size_t i)
{
    double largest = 0;
    for (int c = 0; c < 2; ++c)
        largest = std::max(largest, std::abs(std::hypot(double(a.x[i][c]), double(a.y[i][c])) -
                                             std::hypot(double(b.x[i][c]), double(b.y[i][c]))));
    return std::sqrt(largest / std::numbers::sqrt2);
}

Plane opponentOf(const DisplayImage& image)
{
    Plane out;
    for (const glm::vec3& p : image.pixels)
        out.push_back(opponentFromLinear({linearFromSrgb(double(p.x)), linearFromSrgb(double(p.y)),
                                          linearFromSrgb(double(p.z))}));
    return out;
}

} // namespace

std::vector<float> flipMap(const DisplayImage& reference, const DisplayImage& test,
                           double pixelsPerDegree)
{
    const Size size{int(reference.width), int(reference.height)};
    const Filter sensitivity = contrastSensitivity(pixelsPerDegree);
    const Plane a = opponentOf(reference), b = opponentOf(test);
    const Plane labA = filteredLab(a, size, sensitivity), labB = filteredLab(b, size, sensitivity);
    const Features featA = featuresOf(a, size, pixelsPerDegree);
    const Features featB = featuresOf(b, size, pixelsPerDegree);
    std::vector<float> out;
    for (size_t i = 0; i < a.size(); ++i)
        out.push_back(float(
            std::pow(colourDifference(labA[i], labB[i]), 1 - featureDifference(featA, featB, i))));
    return out;
}

double meanOf(const std::vector<float>& map)
{
    double sum = 0;
    for (const float x : map)
        sum += double(x);
    return map.empty() ? 0 : sum / double(map.size());
}

} // namespace candelabra::app
