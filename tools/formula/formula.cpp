// SPDX-License-Identifier: Apache-2.0
#include "formula/formula.h"

#include <stdexcept>

#include "formula/families.h"
#include "shading/light_family.h"

namespace candelabra::formula
{

Response respond(const Settings& settings, const Receiver& receiver, const Light& light)
{
    switch (lighting::familyOf(light.type, settings.method)) {
#define X(family, NAME, iterations)                                                                \
    case family:                                                                                   \
        return respondInFamily<family>(settings, receiver, light);
        CND_LIGHT_FAMILIES(X)
#undef X
    }
    throw std::logic_error("no family of lights");
}

} // namespace candelabra::formula
