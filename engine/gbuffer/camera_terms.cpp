// SPDX-License-Identifier: Apache-2.0
#include "gbuffer/camera_terms.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

namespace candelabra::gbuffer
{

CameraTerms::CameraTerms(const CndCamera& camera, float clearDepth)
    : clipFromView(glm::make_mat4(camera.clipFromView)),
      viewFromWorld(glm::dmat3(glm::make_mat4(camera.viewFromWorld))),
      position(glm::transpose(viewFromWorld) * -glm::dvec3(camera.viewFromWorld[12],
                                                           camera.viewFromWorld[13],
                                                           camera.viewFromWorld[14])),
      reversedDepth(clearDepth == 0)
{
    const glm::dmat4 clip(clipFromView);
    const glm::dvec4 x = glm::row(clip, 0), y = glm::row(clip, 1);
    const glm::dvec4 z = glm::row(clip, 2), w = glm::row(clip, 3);
    perspective = glm::dvec3(w) != glm::dvec3(0);
    forward = glm::normalize(perspective ? glm::dvec3(w) : glm::dvec3(reversedDepth ? -z : z));

    // Perspective: the points p of the ray satisfy x.p = ndc.x w.p and y.p = ndc.y w.p, so p - eye
    // is a multiple of m^-1 (ndc, 1). Orthographic: w is constant, and the rays are parallel.
    const glm::dvec3 third = perspective ? glm::dvec3(w) : forward;
    const glm::dmat3 m = glm::transpose(glm::dmat3(glm::dvec3(x), glm::dvec3(y), third));
    const glm::dmat3 inverse = glm::inverse(m);
    if (perspective) {
        rayOrigin = {-(inverse * glm::dvec3(x.w, y.w, w.w)), glm::dvec3(0), glm::dvec3(0)};
        rayDirection = {inverse[2], inverse[0], inverse[1]};
    } else {
        rayOrigin = {-(inverse * glm::dvec3(x.w, y.w, 0)), inverse[0] * w.w, inverse[1] * w.w};
        rayDirection = {forward, glm::dvec3(0), glm::dvec3(0)};
    }
    // A right-handed view space with x right and y up looks along -z; y of Vulkan's clip space
    // points down.
    mirrored = glm::determinant(m) < 0;

    const std::array<glm::dvec4, 6> clipPlanes{w + x, w - x, w + y, w - y, z, w - z};
    for (size_t i = 0; i < planes.size(); ++i) {
        const double length = glm::length(glm::dvec3(clipPlanes[i]));
        // An infinite far plane has no direction (but for the rounding of the float matrix).
        constexpr double noDirection = 1e-12;
        if (length <= noDirection * glm::length(clipPlanes[i]))
            planes[i] = {0, 0, 0, clipPlanes[i].w < 0 ? -1 : 1};
        else
            planes[i] = glm::dvec4(glm::transpose(viewFromWorld) * glm::dvec3(clipPlanes[i]),
                                   clipPlanes[i].w) /
                        length;
    }
}

double CameraTerms::pixelScale(uint32_t width, uint32_t height) const
{
    const glm::dmat4 clip(clipFromView);
    const glm::dvec4 w = glm::row(clip, 3);
    const double depth = perspective ? glm::length(glm::dvec3(w)) : w.w;
    // Returns how far a point moves in the image with its place across the viewing direction,
    // pixels per m.
    const auto across = [&](int row, uint32_t pixels) {
        const glm::dvec3 terms(glm::row(clip, row));
        return (terms - glm::dot(terms, forward) * forward) * (0.5 * pixels / depth);
    };
    const glm::dvec3 x = across(0, width), y = across(1, height);
    // The larger eigenvalue of the products of x and y.
    const double xx = glm::dot(x, x), yy = glm::dot(y, y), xy = glm::dot(x, y);
    return std::sqrt(0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy));
}

VkRect2D CameraTerms::pixelsOfBall(const glm::dvec3& center, double radius, uint32_t width,
                                   uint32_t height) const
{
    const glm::dmat4 clip(clipFromView);
    const glm::dvec4 w = glm::row(clip, 3), c(center, 1);
    const double r2 = radius * radius;
    // product(a, a) is 0 if the plane a touches the ball: it is d^2 - radius^2, where d is how far
    // the plane is from the ball's centre, times the squared length of the plane's normal.
    const auto product = [&](const glm::dvec4& a, const glm::dvec4& b) {
        return glm::dot(a, c) * glm::dot(b, c) - r2 * glm::dot(glm::dvec3(a), glm::dvec3(b));
    };
    const double ww = product(w, w), ahead = glm::dot(w, c);
    // If ww < 0, the plane through the eye (w = 0) cuts the ball, which may then be seen anywhere.
    // The same is assumed of a ball that nearly touches that plane: ww is a difference of numbers
    // as large as ahead^2, so a ww below 1e-9 ahead^2 keeps less than seven of the sixteen digits
    // of a double, and so would the quotients by ww below.
    if (ww <= 1e-9 * ahead * ahead)
        return {{0, 0}, {width, height}};
    // The clip coordinate w is negative at all points of this ball or positive at all of them. If
    // it is negative, the ball is behind the camera, and no pixel shows it.
    if (ahead < 0)
        return {};
    // The points at ndc.x are a plane, row 0 - ndc.x w. At either end of the ball's image it
    // touches the ball: product(row 0 - ndc.x w, row 0 - ndc.x w) = 0. The same holds for ndc.y.
    const auto range = [&](int row, uint32_t pixels) -> std::array<uint32_t, 2> {
        const glm::dvec4 r = glm::row(clip, row);
        const double rw = product(r, w);
        const double root = std::sqrt(std::max(rw * rw - ww * product(r, r), 0.0));
        // The pixel at an end, and one more, because shaders round.
        const auto pixelAt = [&](double ndc, double margin) {
            const double pixel = std::floor((0.5 + 0.5 * ndc) * pixels) + margin;
            return uint32_t(std::clamp(pixel, 0.0, double(pixels)));
        };
        return {pixelAt((rw - root) / ww, -1), pixelAt((rw + root) / ww, 2)};
    };
    const auto x = range(0, width), y = range(1, height);
    return {{int32_t(x[0]), int32_t(y[0])}, {x[1] - x[0], y[1] - y[0]}};
}

} // namespace candelabra::gbuffer
