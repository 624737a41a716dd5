// SPDX-License-Identifier: Apache-2.0
// Reports errors inside the engine: it throws one exception type, which guard() catches at the
// C ABI, so that nothing is thrown across it.
#pragma once

#include <exception>
#include <initializer_list>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "candelabra/candelabra.h"

namespace candelabra::gpu
{

struct Failure {
    CndResult code;
    VkResult vkResult;
    std::string message; // one sentence without its full stop
};

// Returns CND_SUCCESS for all Vulkan success codes except VK_NOT_READY, which becomes
// CND_NOT_READY.
CndResult resultOf(VkResult result) noexcept;

// Returns "VK_ERROR_DEVICE_LOST" and the like, for messages; for results that are no errors of
// Vulkan 1.1 "VkResult" and the number.
std::string resultName(VkResult result);

// Throws a Failure if `result` is an error. The sentence begins with `action` and `name`, such as
// "creating image " and the image's name. They are concatenated only then. An argument that
// had to be allocated could throw after the Vulkan call, while nothing owns the new object yet,
// because the order in which arguments are evaluated is not specified.
void check(VkResult result, std::string_view action, std::string_view name = {});

// The fail functions throw a Failure with the result code of their name.
[[noreturn]] void failArgument(std::string message);
// Throws a Failure if one of the pointers that an ABI function was given is null.
void requireNotNull(const char* function, std::initializer_list<const void*> pointers);
[[noreturn]] void failUnsupported(std::string message);

// The largest images that the modules take, in pixels along each side.
constexpr uint32_t largestSide = 16384;

// Throws a Failure if a rectangle of images has no pixel, is larger than `largest`, or ends beyond
// the largest images. `what`: the type that describes it.
void requireRect(const char* what, uint32_t x, uint32_t y, uint32_t width, uint32_t height,
                 VkExtent2D largest = {largestSide, largestSide});

// Fills in `error`, if it is not null, and returns `code`.
CndResult report(CndError* error, CndResult code, VkResult vkResult, const char* message) noexcept;

// Runs `body` and turns anything that it throws into a result code and a sentence.
template <typename Body>
CndResult guard(CndError* error, Body&& body) noexcept
{
    try {
        std::forward<Body>(body)();
        return report(error, CND_SUCCESS, VK_SUCCESS, "");
    } catch (const Failure& f) {
        return report(error, f.code, f.vkResult, f.message.c_str());
    } catch (const std::bad_alloc&) {
        return report(error, CND_ERROR_OUT_OF_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY,
                      "out of host memory");
    } catch (const std::exception& e) {
        return report(error, CND_ERROR_INVALID_ARGUMENT, VK_SUCCESS, e.what());
    }
}

} // namespace candelabra::gpu
