# SPDX-License-Identifier: Apache-2.0
# Defines Vulkan::Headers, unless the host has it already. Candelabra needs Vulkan's headers only, so this
# does not look for Vulkan's library, as CMake's find_package(Vulkan) does, which fails without it.
if(NOT TARGET Vulkan::Headers)
    find_package(VulkanHeaders CONFIG QUIET) # the package of Vulkan-Headers itself
endif()
if(NOT TARGET Vulkan::Headers)
    find_path(Vulkan_INCLUDE_DIR vulkan/vulkan_core.h HINTS "$ENV{VULKAN_SDK}/include" "$ENV{VULKAN_SDK}/Include")
    if(Vulkan_INCLUDE_DIR)
        add_library(Vulkan::Headers INTERFACE IMPORTED)
        set_target_properties(Vulkan::Headers PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${Vulkan_INCLUDE_DIR}")
    endif()
endif()
