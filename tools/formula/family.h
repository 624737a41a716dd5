// SPDX-License-Identifier: Apache-2.0
// The shaders' evaluation of the lights of one family. Each family has a source file, which
// tools/CMakeLists.txt makes: it defines FAMILY and LIGHT_FAMILY_<name> and includes this file.
#pragma once

#include <stdexcept>

#include "formula/families.h"
#include "formula/formula.h"
#include "formula/glsl.h"
#include "shading/light_family.h"

#include "formula/shared_in_double.h"

namespace candelabra::formula
{
namespace
{

// `Constants` has the values of specialisation constants.
template <typename Constants>
struct Shading {
    const formula::Light& given;

#include "double_shaders.h"

    // The values that shaders read from buffers.
    struct Shapes {
        const formula::Light& given;

        auto operator[](uint i) const
        {
            const gpu::LightShape& s =
                i == given.index ? given.shape
                                 : given.corners[i - (given.shape.flags & ~gpu::LIGHT_TWO_SIDED)];
            return LightShape{vec3(s.axisU), s.radius, vec3(s.axisV), s.flags};
        }
    } lightShapes{given};
    vec4 lightCentre(uint) const
    {
        return vec4(given.centre, given.boundingRadius);
    }
    vec4 lightEmission(uint) const
    {
        return vec4(vec3(1.0), UNBOUNDED * UNBOUNDED);
    }
    uint lightAt(uint k) const
    {
        return k;
    }
};

template <uint32_t type, uint32_t method>
struct Constants {
    static constexpr uint32_t specialised(uint32_t id, uint32_t otherwise)
    {
        return id == gpu::SPEC_LIGHT_TYPE        ? type
               : id == gpu::SPEC_SPECULAR_METHOD ? method
                                                 : otherwise;
    }
};

template <uint32_t type, uint32_t method>
Response respondBy(const Settings& settings, const formula::Receiver& receiver,
                   const formula::Light& light)
{
    Shading<Constants<type, method>> shading{light};
#define X(name, value, meaning) shading.name = settings.constants.name;
    CND_CONIC_FITTED(X)
#undef X
    auto point = shading.makeShadingPoint(
        {receiver.n, vec3(0.0), vec3(0.0), 1.0, receiver.perceptualRoughness}, receiver.position,
        receiver.v);
    shading.separateLobes(point);
    const auto prepared = shading.makeReceiver(point, settings.sampleCount, 0u);
    const vec3 response = shading.evaluateClassified(prepared, light.index);
    return {response.x, response.y, response.z, shading.wayOf(prepared, light.index)};
}

constexpr bool isInFamily(uint32_t type, uint32_t method)
{
    const auto m = CndSpecularMethod(method);
    return lighting::familyOf(type, m) == FAMILY && lighting::canonicalMethod(type, m) == m;
}

template <uint32_t type>
Response respondTo(const Settings& settings, const formula::Receiver& receiver,
                   const formula::Light& light)
{
#define X(id, NAME, name)                                                                          \
    if constexpr (isInFamily(type, id))                                                            \
        if (settings.method == id)                                                                 \
            return respondBy<type, id>(settings, receiver, light);
    CND_SPECULAR_METHODS(X)
#undef X
    throw std::logic_error("not a method of the type of light");
}

} // namespace

template <>
Response respondInFamily<FAMILY>(const Settings& settings, const formula::Receiver& receiver,
                                 const formula::Light& light)
{
    switch (light.type) {
#define X(id, NAME, family, fields)                                                                \
    case id:                                                                                       \
        return respondTo<id>(settings, receiver, light);
        CND_LIGHT_TYPES(X)
#undef X
    }
    throw std::logic_error("not a type of light");
}

} // namespace candelabra::formula
