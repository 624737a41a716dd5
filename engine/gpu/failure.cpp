// SPDX-License-Identifier: Apache-2.0
#include "gpu/failure.h"

#include <cstdio>

namespace candelabra::gpu
{

CndResult resultOf(VkResult result) noexcept
{
    switch (result) {
    case VK_NOT_READY:
        return CND_NOT_READY;
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
        return CND_ERROR_OUT_OF_MEMORY;
    default:
        return result < 0 ? CND_ERROR_DEVICE : CND_SUCCESS;
    }
}

void check(VkResult result, std::string_view action, std::string_view name)
{
    if (result < 0)
        throw Failure{resultOf(result), result,
                      std::string(action).append(name) + " failed (VkResult " +
                          std::to_string(int(result)) + ")"};
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
