// SPDX-License-Identifier: Apache-2.0
// The functions from which respond() chooses, one per family of lights (family.h).
#pragma once

#include "formula/formula.h"
#include "shared/light_type_list.h"

namespace candelabra::formula
{

template <uint32_t family>
Response respondInFamily(const Settings& settings, const Receiver& receiver, const Light& light);

#define X(index, NAME, iterations)                                                                 \
    template <>                                                                                    \
    Response respondInFamily<gpu::FAMILY_##NAME>(const Settings&, const Receiver&, const Light&);
CND_LIGHT_FAMILIES(X)
#undef X

} // namespace candelabra::formula
