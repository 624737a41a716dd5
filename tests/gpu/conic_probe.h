// SPDX-License-Identifier: Apache-2.0
// Evaluates sphere lights by any of their specular methods (shaders/probes/conic.comp).
#pragma once

#include "candelabra_probes.h"
#include "gpu/probe.h"
#include "shading/light_family.h"
#include "shared/lighting_data.h"

namespace candelabra::test
{

class ConicProbeTest : public ProbeTest
{
protected:
    std::vector<gpu::ConicProbeOutput> evaluate(const std::vector<gpu::ConicProbeInput>& inputs,
                                                CndSpecularMethod method = CND_SPECULAR_CONIC)
    {
        return runProbe<gpu::ConicProbeOutput>(
            lighting::isClosedForm(method) ? spirv::conic_comp_conic : spirv::conic_comp_sphere,
            inputs, {{gpu::SPEC_SPECULAR_METHOD, method}});
    }
};

} // namespace candelabra::test
