# SPDX-License-Identifier: Apache-2.0
# vcpkg port of the library, made of the repository that it is in:
#   vcpkg install candelabra --overlay-ports=REPOSITORY/engine/package/vcpkg
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
vcpkg_add_to_path("${CURRENT_HOST_INSTALLED_DIR}/tools/glslang")
vcpkg_add_to_path("${CURRENT_HOST_INSTALLED_DIR}/tools/spirv-tools")
vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS -DCANDELABRA_BUILD_TOOLS=OFF -DCANDELABRA_BUILD_COMPILER=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/candelabra)
vcpkg_fixup_pkgconfig()
vcpkg_copy_pdbs()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
