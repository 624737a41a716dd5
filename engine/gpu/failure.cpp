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

std::string resultName(VkResult result)
{
    switch (result) {
#define CND_CASE(name)                                                                             \
    case name:                                                                                     \
        return #name;
        CND_CASE(VK_ERROR_OUT_OF_HOST_MEMORY)
        CND_CASE(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        CND_CASE(VK_ERROR_INITIALIZATION_FAILED)
        CND_CASE(VK_ERROR_DEVICE_LOST)
        CND_CASE(VK_ERROR_MEMORY_MAP_FAILED)
        CND_CASE(VK_ERROR_LAYER_NOT_PRESENT)
        CND_CASE(VK_ERROR_EXTENSION_NOT_PRESENT)
        CND_CASE(VK_ERROR_FEATURE_NOT_PRESENT)
        CND_CASE(VK_ERROR_INCOMPATIBLE_DRIVER)
        CND_CASE(VK_ERROR_TOO_MANY_OBJECTS)
        CND_CASE(VK_ERROR_FORMAT_NOT_SUPPORTED)
        CND_CASE(VK_ERROR_FRAGMENTED_POOL)
        CND_CASE(VK_ERROR_UNKNOWN)
        CND_CASE(VK_ERROR_OUT_OF_POOL_MEMORY)
        CND_CASE(VK_ERROR_INVALID_EXTERNAL_HANDLE)
#undef CND_CASE
    default:
        return "VkResult " + std::to_string(int(result));
    }
}

void check(VkResult result, std::string_view action, std::string_view name)
{
    if (result < 0)
        throw Failure{resultOf(result), result,
                      std::string(action).append(name) + " failed (" + resultName(result) + ")"};
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

void requireRect(const char* what, uint32_t x, uint32_t y, uint32_t width, uint32_t height,
                 VkExtent2D largest)
{
    const auto sides = [](uint32_t w, uint32_t h) {
        return std::to_string(w) + "x" + std::to_string(h);
    };
    if (!width || !height || width > largest.width || height > largest.height)
        failArgument(std::string(what) + ": size " + sides(width, height) + " is outside 1x1.." +
                     sides(largest.width, largest.height));
    if (x > largestSide - width || y > largestSide - height)
        failArgument(std::string(what) + ": the rectangle of " + sides(width, height) +
                     " pixels at (" + std::to_string(x) + ", " + std::to_string(y) +
                     ") ends outside " + sides(largestSide, largestSide));
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
