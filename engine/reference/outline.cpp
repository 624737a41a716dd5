// SPDX-License-Identifier: Apache-2.0
#include "reference/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace candelabra::reference
{

namespace
{

using std::numbers::pi;

double wrappedAngle(double angle)
{
    return std::remainder(angle, 2 * pi);
}

double angleOf(const Frame& pole, const glm::dvec3& direction)
{
    return std::atan2(glm::dot(direction, pole.y), glm::dot(direction, pole.x));
}

// Appends the directions t of a plane with A cos^2 t + 2 B cos t sin t + C sin^2 t = 0: up to four.
void addRoots(double A, double B, double C, std::vector<double>& out)
{
    const double root = B * B - A * C;
    if (!(root >= 0))
        return;
    const double q = -(B + std::copysign(std::sqrt(root), B));
    for (const double angle : {std::atan2(A, q), std::atan2(q, C)}) {
        out.push_back(angle);
        out.push_back(angle + pi);
    }
}

class CapOutline final : public Outline
{
public:
    explicit CapOutline(const SphereCap& cap) : cap_(cap), cosine_(cap.cosine()) {}

    // The circle's plane is at distance e from the axis: sin^2 of the arc's half width is (s^2 -
    // e^2) / (1 - e^2).
    std::optional<Arc> arc(const glm::dvec3& p, const glm::dvec3& q) const override
    {
        const double e = glm::dot(cap_.axis, glm::cross(p, q));
        if (!(e * e < cap_.sin2))
            return std::nullopt;
        return Arc{std::atan2(glm::dot(cap_.axis, q), glm::dot(cap_.axis, p)),
                   std::atan2(std::sqrt(cap_.sin2 - e * e), cosine_)};
    }

    std::vector<double> angles(const Frame& pole) const override
    {
        const double across = std::hypot(glm::dot(cap_.axis, pole.x), glm::dot(cap_.axis, pole.y));
        if (across <= std::sqrt(cap_.sin2)) // the pole or its opposite is inside
            return {};
        const double centre = angleOf(pole, cap_.axis);
        const double half =
            std::atan2(std::sqrt(cap_.sin2), std::sqrt(across * across - cap_.sin2));
        return {centre - half, centre + half};
    }

    glm::dvec3 centre() const override { return cap_.axis; }

private:
    SphereCap cap_;
    double cosine_;
};

class PolygonOutline final : public Outline
{
public:
    explicit PolygonOutline(std::span<const glm::dvec3> corners)
    {
        glm::dvec3 sum(0);
        for (size_t i = 0; i < corners.size(); ++i) {
            corners_.push_back(glm::normalize(corners[i]));
            sum += corners[i];
            const glm::dvec3& next = corners[(i + 1) % corners.size()];
            inward_.push_back(glm::cross(corners[i], next - corners[i]));
        }
        centre_ = glm::normalize(sum);
        for (glm::dvec3& inward : inward_)
            if (glm::dot(inward, centre_) < 0)
                inward = -inward;
    }

    std::optional<Arc> arc(const glm::dvec3& p, const glm::dvec3& q) const override
    {
        std::optional<Arc> out;
        for (const glm::dvec3& inward : inward_) {
            const Arc half{std::atan2(glm::dot(inward, q), glm::dot(inward, p)), pi / 2};
            out = out ? intersect(*out, half) : half;
            if (!out)
                return std::nullopt;
        }
        return out;
    }

    std::vector<double> angles(const Frame& pole) const override
    {
        std::vector<double> out;
        for (const glm::dvec3& corner : corners_)
            out.push_back(angleOf(pole, corner));
        return out;
    }

    glm::dvec3 centre() const override { return centre_; }

private:
    std::vector<glm::dvec3> corners_, inward_;
    glm::dvec3 centre_;
};

// Directions w with |h w - C (w . N)|^2 <= R^2 (w . N)^2 on the side of the disc; h = C . N is the
// distance of its plane.
class DiscOutline final : public Outline
{
public:
    DiscOutline(const glm::dvec3& center, const glm::dvec3& normal, double radius)
        : center_(center), normal_(normal), radius_(radius)
    {
        height_ = glm::dot(center, normal);
        if (height_ < 0) {
            normal_ = -normal_;
            height_ = -height_;
        }
    }

    std::optional<Arc> arc(const glm::dvec3& p, const glm::dvec3& q) const override
    {
        const Form f = form(p, q);
        // A cos^2 + 2 B cos sin + C sin^2 <= 0 holds on an arc and on its opposite.
        const double half = (f.A - f.C) / 2, mean = (f.A + f.C) / 2;
        const double root = f.B * f.B - f.A * f.C; // equals half^2 + B^2 - mean^2
        if (!(root > 0))
            return std::nullopt;
        const double middle = std::atan2(f.B, half) / 2 + pi / 2;
        // cos(2 width) = mean / hypot(half, B), sin(2 width) = sqrt(root) / hypot(half, B).
        const double width = std::atan2(std::sqrt(root), mean) / 2;
        const bool front =
            glm::dot(normal_, p) * std::cos(middle) + glm::dot(normal_, q) * std::sin(middle) > 0;
        return Arc{front ? middle : middle + pi, width};
    }

    // The arc vanishes where B^2 = A C, which is also a quadratic form in the direction.
    std::vector<double> angles(const Frame& pole) const override
    {
        const Form x = form(pole.z, pole.x), y = form(pole.z, pole.y);
        const double xy = form(pole.x, pole.y).B;
        std::vector<double> out;
        addRoots(x.B * x.B - x.A * x.C, x.B * y.B - x.A * xy, y.B * y.B - x.A * y.C, out);
        return out;
    }

    glm::dvec3 centre() const override { return glm::normalize(center_); }

private:
    struct Form {
        double A, B, C;
    };
    Form form(const glm::dvec3& p, const glm::dvec3& q) const
    {
        const double pn = glm::dot(p, normal_), qn = glm::dot(q, normal_);
        const glm::dvec3 pv = height_ * p - center_ * pn, qv = height_ * q - center_ * qn;
        const double r2 = radius_ * radius_;
        return {glm::dot(pv, pv) - r2 * pn * pn, glm::dot(pv, qv) - r2 * pn * qn,
                glm::dot(qv, qv) - r2 * qn * qn};
    }

    glm::dvec3 center_, normal_;
    double radius_, height_;
};

SphereCap capOf(const glm::dvec3& center, double radius)
{
    const double distance = glm::length(center);
    const double s = std::min(radius / distance, 1.0);
    return {center / distance, s * s};
}

// The outline of a capsule: two caps and, unless one contains the other, the polygon between the
// four points at which the two common tangent planes touch the spheres.
class CapsuleOutline final : public Outline
{
public:
    CapsuleOutline(const glm::dvec3& end0, const glm::dvec3& end1, double radius)
        : caps_{CapOutline(capOf(end0, radius)), CapOutline(capOf(end1, radius))}
    {
        const bool nearest0 = glm::length(end0) <= glm::length(end1);
        centre_ = caps_[nearest0 ? 0 : 1].centre();
        const double length = glm::length(end1 - end0);
        if (!(length > 0))
            return;
        const glm::dvec3 axis = (end1 - end0) / length;
        const glm::dvec3 across = end0 - glm::dot(end0, axis) * axis;
        const double distance = glm::length(across);
        if (!(distance > radius))
            return;
        const glm::dvec3 outward = across / distance, side = glm::cross(axis, outward);
        const double sine = radius / distance, cosine = std::sqrt((1 - sine) * (1 + sine));
        const glm::dvec3 plus = sine * outward + cosine * side;  // normals of the tangent planes,
        const glm::dvec3 minus = sine * outward - cosine * side; // pointing to the capsule
        const std::array<glm::dvec3, 4> corners = {end0 - radius * plus, end1 - radius * plus,
                                                   end1 - radius * minus, end0 - radius * minus};
        between_.emplace(std::span<const glm::dvec3>(corners));
        centre_ = between_->centre();
    }

    std::optional<Arc> arc(const glm::dvec3& p, const glm::dvec3& q) const override
    {
        std::optional<Arc> out;
        const auto add = [&](const std::optional<Arc>& part) {
            if (!part)
                return;
            if (!out) {
                out = part;
                return;
            }
            // The arcs overlap: take their union.
            const double shift = wrappedAngle(part->centre - out->centre);
            const double low = std::min(-out->halfWidth, shift - part->halfWidth);
            const double high = std::max(out->halfWidth, shift + part->halfWidth);
            out = Arc{out->centre + (low + high) / 2, (high - low) / 2};
        };
        if (between_)
            add(between_->arc(p, q));
        add(caps_[0].arc(p, q));
        add(caps_[1].arc(p, q));
        return out;
    }

    std::vector<double> angles(const Frame& pole) const override
    {
        std::vector<double> out = caps_[0].angles(pole);
        for (const double angle : caps_[1].angles(pole))
            out.push_back(angle);
        if (between_)
            for (const double angle : between_->angles(pole))
                out.push_back(angle);
        return out;
    }

    glm::dvec3 centre() const override { return centre_; }

private:
    std::array<CapOutline, 2> caps_;
    std::optional<PolygonOutline> between_;
    glm::dvec3 centre_;
};

} // namespace

std::optional<Arc> intersect(const Arc& a, const Arc& b)
{
    const double shift = wrappedAngle(b.centre - a.centre);
    const double low = std::max(-a.halfWidth, shift - b.halfWidth);
    const double high = std::min(a.halfWidth, shift + b.halfWidth);
    if (!(low < high))
        return std::nullopt;
    return Arc{a.centre + (low + high) / 2, (high - low) / 2};
}

std::unique_ptr<Outline> capOutline(const SphereCap& cap)
{
    return std::make_unique<CapOutline>(cap);
}

std::unique_ptr<Outline> polygonOutline(std::span<const glm::dvec3> corners)
{
    return std::make_unique<PolygonOutline>(corners);
}

std::unique_ptr<Outline> discOutline(const glm::dvec3& center, const glm::dvec3& normal,
                                     double radius)
{
    return std::make_unique<DiscOutline>(center, normal, radius);
}

std::unique_ptr<Outline> capsuleOutline(const glm::dvec3& end0, const glm::dvec3& end1,
                                        double radius)
{
    return std::make_unique<CapsuleOutline>(end0, end1, radius);
}

} // namespace candelabra::reference
