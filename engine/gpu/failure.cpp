// SPDX-License-Identifier: Apache-2.0
#include "gpu/failure.h"

#include <cstdio>

namespace candelabra::gpu
{

void check(VkResult result, const std::string& what)
{
    if (result >= 0)
        return;
    const bool memory = result == VK_ERROR_OUT_OF_HOST_MEMORY ||
                        result == VK_ERROR_OUT_OF_DEVICE_MEMORY ||
                        result == VK_ERROR_OUT_OF_POOL_MEMORY;
    throw Failure{memory ? CND_ERROR_OUT_OF_MEMORY : CND_ERROR_DEVICE, result,
                  what + " failed (VkResult " + std::to_string(int(result)) + ")"};
}

void failArgument(std::string message)
{
    throw Failure{CND_ERROR_INVALID_ARGUMENT, VK_SUCCESS, std::move(message)};
}

void requireNotNull(const char* function, std::initializer_list<const void*> pointers)
{
    for (const void* pointer : pointers)
        if (!pointer)
            failArgument(std::string(function) + ": an argument is null");
}

void failUnsupported(std::string message)
{
    throw Failure{CND_ERROR_UNSUPPORTED, VK_SUCCESS, std::move(message)};
}

CndResult report(CndError* error, CndResult code, VkResult vkResult, const char* message) noexcept
{
    if (error) {
        error->code = code;
        error->vkResult = vkResult;
        std::snprintf(error->message, sizeof error->message, "%s", message);
    }
    return code;
}

} // namespace candelabra::gpu
