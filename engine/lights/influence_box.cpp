// SPDX-License-Identifier: Apache-2.0
#include "lights/influence_box.h"

#include <cstring>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "lights/light_types.h"

namespace candelabra::lighting
{
namespace
{

constexpr double unbounded = std::numeric_limits<double>::infinity();

// Tests of clip coordinates are wider by this share of the magnitude of their terms, which is more
// than the rounding error of the kernels' float32.
constexpr double margin = 1e-4;

} // namespace

static_assert(gpu::ALL_LAYERS == (1u << CND_LAYER_COUNT) - 1);

InfluenceBox endlessBox(uint32_t layers)
{
    return {glm::dvec3(-unbounded), glm::dvec3(unbounded), layers};
}

InfluenceBoxes influenceBoxesOf(std::span<const CndLight> lights)
{
    InfluenceBoxes out;
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type)
        out[type] = isDistant(type) ? endlessBox(0)
                                    : InfluenceBox{glm::dvec3(unbounded), glm::dvec3(-unbounded)};
    widenBoxes(out, lights);
    return out;
}

void widenBoxes(InfluenceBoxes& boxes, std::span<const CndLight> lights)
{
    for (size_t i = 0; i < lights.size();) {
        const uint32_t type = lights[i].type;
        InfluenceBox box = boxes[type]; // a copy stays in registers while the type is the same
        for (; i < lights.size() && lights[i].type == type; ++i) {
            const CndLight& light = lights[i];
            box.layers |= layersOf(light.layers);
            if (isDistant(type))
                continue;
            const glm::dvec3 centre(light.position[0], light.position[1], light.position[2]);
            box.low = glm::min(box.low, centre - double(light.influenceRadius));
            box.high = glm::max(box.high, centre + double(light.influenceRadius));
        }
        boxes[type] = box;
    }
}

void widenBoxes(InfluenceBoxes& boxes, const InfluenceBoxes& more)
{
    for (uint32_t type = 0; type < CND_LIGHT_TYPE_COUNT; ++type) {
        boxes[type].low = glm::min(boxes[type].low, more[type].low);
        boxes[type].high = glm::max(boxes[type].high, more[type].high);
        boxes[type].layers |= more[type].layers;
    }
}

bool reachesView(const InfluenceBox& box, const double origin[3], const CndCamera& camera)
{
    for (int axis = 0; axis < 3; ++axis) {
        if (box.low[axis] > box.high[axis])
            return false;
        if (box.low[axis] == -unbounded || box.high[axis] == unbounded)
            return true;
    }
    glm::dmat4 viewFromWorld;
    std::memcpy(&viewFromWorld, camera.viewFromWorld, sizeof viewFromWorld);
    const float* m = camera.clipFromView;
    // In clip coordinates the view lies between the planes x = -w, x = w, y = -w and y = w. The box
    // is outside the view if all its corners are beyond the same plane.
    bool behind[4] = {true, true, true, true};
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec4 p(0, 0, 0, 1);
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = origin[axis] + (corner >> axis & 1 ? box.high : box.low)[axis];
        const glm::dvec4 v = viewFromWorld * p;
        const double w = m[11] * v.z + m[15];
        for (int side = 0; side < 4; ++side) {
            const int axis = side / 2;
            const double sign = side % 2 ? -1 : 1;
            const double along = m[5 * axis] * v[axis], shift = m[8 + axis] * v.z + m[12 + axis];
            const double slack =
                margin * (glm::abs(along) + glm::abs(shift) + glm::abs(w) +
                          glm::length(glm::dvec3(v)) * glm::abs(double(m[5 * axis])));
            behind[side] = behind[side] && w + sign * (along + shift) < -slack;
        }
    }
    return !(behind[0] || behind[1] || behind[2] || behind[3]);
}

} // namespace candelabra::lighting
