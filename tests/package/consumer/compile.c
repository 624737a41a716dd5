// SPDX-License-Identifier: Apache-2.0
// Compiles a shadow term of the host with an installed package that has no shader files.
#include <candelabra/compiler.h>
#include <stdio.h>

int main(void)
{
    const CndCompileDesc desc = {.structSize = sizeof desc,
                                 .functions = CND_HOST_VISIBILITY_BIT,
                                 .source = "float candelabraVisibility(CndShadowQuery q)\n"
                                           "{\n"
                                           "    return q.light == 0u ? 0.5 : 1.0;\n"
                                           "}\n",
                                 .lightTypes = 1u << CND_LIGHT_SPHERE};
    CndCompiledKernels kernels = NULL;
    CndError error;
    uint32_t count = 0;
    if (cndCompileKernels(&desc, &kernels, &error) != CND_SUCCESS) {
        puts(error.message);
        return 1;
    }
    cndGetKernelCode(kernels, &count);
    cndDestroyCompiledKernels(kernels);
    return count == 3 ? 0 : 1;
}
