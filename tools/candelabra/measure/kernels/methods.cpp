// SPDX-License-Identifier: Apache-2.0
#include "measure/kernels/methods.h"

#include "render/setting_names.h"
#include "shading/light_family.h"

namespace candelabra::app
{

std::string methodName(const MeasuredMethod& method)
{
    return method.rival == Rival::Ltc ? "ltc" : specularName(method.specular);
}

std::vector<CndSpecularMethod> methodsOf(uint32_t lightType)
{
    std::vector<CndSpecularMethod> out;
    for (const Choice<CndSpecularMethod>& choice : specularChoices)
        if (choice.value != CND_SPECULAR_NONE &&
            lighting::canonicalMethod(lightType, choice.value) == choice.value)
            out.push_back(choice.value);
    return out;
}

bool rivalKnows(uint32_t lightType)
{
    return lighting::isSphere(lightType) || lightType == CND_LIGHT_RECTANGLE ||
           lightType == CND_LIGHT_POLYGON;
}

std::vector<MeasuredMethod> comparedMethods(uint32_t lightType)
{
    std::vector<MeasuredMethod> out;
    for (const CndSpecularMethod method : methodsOf(lightType))
        out.push_back(method);
    if (rivalKnows(lightType))
        out.push_back(Rival::Ltc);
    return out;
}

} // namespace candelabra::app
