// SPDX-License-Identifier: Apache-2.0
#include "lights/pack_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "gpu/failure.h"
#include "lights/light_types.h"
#include "lights/polygon.h"
#include "shared/lengths.h"

namespace candelabra::lighting
{
namespace
{

constexpr float infinity = std::numeric_limits<float>::infinity();

glm::vec3 vec(const float (&v)[3])
{
    return {v[0], v[1], v[2]};
}

// Returns the squared distance between the ends of two unit vectors that enclose this angle. It is
// 2 - 2 cos(angle), but float keeps its digits for small angles, whose cosines are too close to 1.
double squaredChord(double angle)
{
    const double half = 2 * std::sin(angle / 2);
    return half * half;
}

const float maxCoordinate = gpu::MAX_LIGHT_COORDINATE;
const float minLength = gpu::MIN_LIGHT_LENGTH;

bool isNear(const float (&v)[3])
{
    return std::abs(v[0]) <= maxCoordinate && std::abs(v[1]) <= maxCoordinate &&
           std::abs(v[2]) <= maxCoordinate; // false for NaN
}

const char* whyAxesInvalid(const CndLight& light)
{
    if (!hasField(light.type, gpu::LIGHT_HAS_AXIS_U))
        return nullptr;
    const glm::vec3 u = vec(light.axisU), v = vec(light.axisV);
    const float lengthU = std::hypot(u.x, u.y, u.z), lengthV = std::hypot(v.x, v.y, v.z);
    if (!(isNear(light.axisU) && lengthU >= minLength))
        return "axisU must be finite and not zero";
    if (!hasField(light.type, gpu::LIGHT_HAS_AXIS_V))
        return nullptr;
    if (!(isNear(light.axisV) && lengthV >= minLength))
        return "axisV must be finite and not zero";
    if (!(std::abs(glm::dot(u / lengthU, v / lengthV)) <= 1e-3f))
        return "axisU and axisV must be perpendicular";
    return nullptr;
}

const char* whyConeInvalid(const CndLight& light)
{
    if (!hasField(light.type, gpu::LIGHT_HAS_CONE))
        return nullptr;
    // float(pi / 2) may exceed the double by an ulp.
    constexpr float quarterTurn = float(std::numbers::pi / 2) * (1 + 1e-6f);
    if (!(light.innerConeAngle >= 0 && light.innerConeAngle < light.outerConeAngle &&
          light.outerConeAngle <= quarterTurn))
        return "cone angles must satisfy 0 <= inner < outer <= pi/2";
    if (light.outerConeAngle - light.innerConeAngle < CND_MIN_CONE_EDGE)
        return "cone angles must differ by at least 1e-5 (CND_MIN_CONE_EDGE)";
    return nullptr;
}

const char* whyRadiusInvalid(const CndLight& light)
{
    if (!hasField(light.type, gpu::LIGHT_HAS_RADIUS))
        return nullptr;
    if (!(light.radius >= minLength && light.radius <= maxCoordinate))
        return "radius must be within 1e-15..1e15";
    if (isDistant(light.type) && light.radius > 1)
        return "radius of a distant sphere is a sine and must be <= 1";
    return nullptr;
}

const char* whyInfluenceInvalid(const CndLight& light)
{
    if (isDistant(light.type))
        return nullptr;
    if (!(light.influenceRadius > 0))
        return "influenceRadius must be > 0 (INFINITY for uncut)";
    if (light.influenceRadius > boundingRadiusOf(light))
        return nullptr;
    return hasField(light.type, gpu::LIGHT_HAS_AXIS_U)
               ? "influenceRadius must be greater than the distance from the light's centre to the "
                 "farthest point of its emitter"
               : "influenceRadius must be greater than radius";
}

// Returns why a light cannot be used, or null. It allocates nothing, because it may run for a
// million lights in one frame.
const char* whyInvalid(const CndLight& light)
{
    if (light.type >= CND_LIGHT_TYPE_COUNT)
        return "type is not a CndLightType";
    for (const float e : light.emission)
        if (!(e >= 0 && e < infinity))
            return "emission must be finite and >= 0";
    if (!isDistant(light.type) && !isNear(light.position))
        return "position must be finite and within 1e15 m of the origin";
    if (hasField(light.type, gpu::LIGHT_HAS_DIRECTION)) {
        const float length = std::hypot(light.direction[0], light.direction[1], light.direction[2]);
        if (!(std::abs(length - 1) <= 1e-3f))
            return "direction must be a unit vector";
    }
    if (!areLayers(light.layers))
        return "layers has bits beyond CND_LAYER_COUNT";
    if (light.unshadowedBy >> CND_OCCLUDER_LAYER_COUNT)
        return "unshadowedBy has bits beyond CND_OCCLUDER_LAYER_COUNT";
    if (const char* why = whyRadiusInvalid(light))
        return why;
    if (const char* why = whyAxesInvalid(light))
        return why;
    if (hasField(light.type, gpu::LIGHT_HAS_CORNERS))
        if (const char* why = whyPolygonInvalid(light.polygon))
            return why;
    if (const char* why = whyInfluenceInvalid(light))
        return why;
    return whyConeInvalid(light);
}

[[noreturn]] void failLight(const char* call, size_t index, std::span<const CndLightId> ids,
                            const char* why)
{
    std::string light = "lights[" + std::to_string(index) + "]";
    if (!ids.empty())
        light += " (id " + std::to_string(ids[index]) + ")";
    gpu::failArgument(std::string(call) + ": " + light + ": " + why);
}

glm::vec3 unit(const float (&v)[3])
{
    const glm::vec3 d = vec(v);
    return d / std::hypot(d.x, d.y, d.z);
}

void pack(const CndLight& light, uint32_t id, gpu::LightRecord& r)
{
    const uint32_t fields = fieldsOf(light.type);
    const bool distant = isDistant(light.type);
    r.position = distant ? -unit(light.direction) : vec(light.position);
    r.boundingRadius = boundingRadiusOf(light);
    r.emission = vec(light.emission);
    r.influenceRadius = distant ? gpu::UNBOUNDED : std::min(light.influenceRadius, gpu::UNBOUNDED);
    glm::vec3 axisU(0), axisV(0);
    if (fields & gpu::LIGHT_HAS_AXIS_U)
        axisU = vec(light.axisU);
    else if (fields & gpu::LIGHT_HAS_DIRECTION && !distant)
        axisU = unit(light.direction);
    if (fields & gpu::LIGHT_HAS_CONE) {
        // As in KHR_lights_punctual, the attenuation is the square of a linear function of the
        // cosine between the cones, and so of the squared chord. axisV holds where the function is
        // 0, and its slope.
        const double outer = squaredChord(double(light.outerConeAngle));
        axisV = {float(outer), float(1 / (outer - squaredChord(double(light.innerConeAngle)))), 0};
    } else if (fields & gpu::LIGHT_HAS_AXIS_V) {
        axisV = vec(light.axisV);
    } else if (fields & gpu::LIGHT_HAS_AXIS_U && fields & gpu::LIGHT_HAS_RADIUS) {
        axisV.x = light.radius; // read by shapeOf
    }
    if (fields & gpu::LIGHT_HAS_CORNERS) {
        const OutlinePolygon polygon = outlinePolygon(light);
        axisU = polygon.axisU;
        axisV = polygon.axisV;
    }
    r.axisU = axisU;
    r.id = id;
    r.axisV = axisV;
    const bool twoSided = light.twoSided && fields & gpu::LIGHT_HAS_SIDES;
    r.flags = light.type | layersOf(light.layers) << gpu::LIGHT_LAYERS_SHIFT |
              flagsOfShadows(light.unshadowed, light.unshadowedBy) |
              (twoSided ? gpu::LIGHT_TWO_SIDED : 0);
}

} // namespace

// The lights are taken in blocks that stay in the processor's nearest cache.
LightSummary validateLights(const char* call, std::span<const CndLight> lights,
                            std::span<const CndLightId> ids)
{
    constexpr size_t lightsPerBlock = 64;
    LightSummary out;
    for (size_t first = 0; first < lights.size(); first += lightsPerBlock) {
        const auto block = lights.subspan(first, std::min(lightsPerBlock, lights.size() - first));
        for (size_t i = 0; i < block.size(); ++i) {
            if (const char* why = whyInvalid(block[i]))
                failLight(call, first + i, ids, why);
            ++out.types[block[i].type];
        }
        widenBoxes(out.boxes, block);
    }
    return out;
}

gpu::PolygonRecord packPolygon(const CndLight& light, uint32_t id) noexcept
{
    const OutlinePolygon polygon = outlinePolygon(light);
    gpu::PolygonRecord record{.count = polygon.count, .id = id};
    for (uint32_t i = 0; i < gpu::MAX_RECORD_CORNERS; ++i)
        record.corners[i] = polygon.corners[std::min(i, polygon.count - 1)];
    return record;
}

gpu::LightShape shapeOf(const gpu::LightRecord& record)
{
    const uint32_t fields = fieldsOf(record.flags & gpu::LIGHT_TYPE_MASK);
    const bool inAxisV = fields & gpu::LIGHT_HAS_RADIUS && fields & gpu::LIGHT_HAS_AXIS_U &&
                         !(fields & gpu::LIGHT_HAS_AXIS_V);
    return {.axisU = record.axisU,
            .radius = inAxisV ? record.axisV.x : record.boundingRadius,
            .axisV = record.axisV,
            .flags = record.flags};
}

void packLights(std::span<const CndLight> lights, std::span<gpu::LightRecord> records,
                uint32_t firstId) noexcept
{
    for (size_t i = 0; i < lights.size(); ++i)
        pack(lights[i], firstId + uint32_t(i), records[i]);
}

} // namespace candelabra::lighting
