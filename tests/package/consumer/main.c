// SPDX-License-Identifier: Apache-2.0
// Calls into every module without a device: the whole library must link, and be of one version.
#include <candelabra/candelabra.h>

int main(void)
{
    return cndGetVersion() == CND_VERSION &&
                   cndCreateLighting(NULL, NULL, NULL, NULL) == CND_ERROR_INVALID_ARGUMENT &&
                   cndCreateEnvironment(NULL, NULL, NULL, NULL) == CND_ERROR_INVALID_ARGUMENT &&
                   cndCreateExposure(NULL, NULL, NULL, NULL) == CND_ERROR_INVALID_ARGUMENT
               ? 0
               : 1;
}
