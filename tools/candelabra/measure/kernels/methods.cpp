// SPDX-License-Identifier: Apache-2.0
#include "measure/kernels/methods.h"

#include "render/setting_names.h"
#include "shading/light_family.h"

namespace candelabra::app
{

std::string methodName(const MeasuredMethod& method)
{
    switch (method.rival) {
    case Rival::Ltc:
        return "ltc";
    case Rival::LtcOneLobe:
        return "ltc-one-lobe";
    case Rival::None:
        break;
    }
    return specularName(method.specular);
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

std::vector<MeasuredMethod> comparedMethods(uint32_t lightType)
{
    std::vector<MeasuredMethod> out;
    for (const CndSpecularMethod method : methodsOf(lightType))
        out.push_back(method);
    if (lighting::isPunctual(lightType))
        return out;
    out.push_back(Rival::Ltc);
    if (!lighting::isSphere(lightType))
        out.push_back(Rival::LtcOneLobe);
    return out;
}

} // namespace candelabra::app
