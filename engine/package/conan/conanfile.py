# SPDX-License-Identifier: Apache-2.0
"""Conan 2 recipe of the library: conan create engine/package/conan --build=missing. Hosts write
self.requires("candelabra/VERSION") and find_package(candelabra)."""
import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class Candelabra(ConanFile):
    name = "candelabra"
    description = "Thousands of physically sized lights for Vulkan"
    license = "Apache-2.0"
    topics = ("vulkan", "lighting", "rendering")
    package_type = "library"
    settings = "os", "compiler", "build_type", "arch"
    options = {"shared": [True, False], "fPIC": [True, False]}
    default_options = {"shared": False, "fPIC": True}
    implements = ["auto_shared_fpic"]

    @property
    def _repository(self):
        return os.path.join(self.recipe_folder, "..", "..", "..")

    def set_version(self):
        lists = load(self, os.path.join(self._repository, "CMakeLists.txt"))
        self.version = re.search(r"project\(candelabra VERSION ([\d.]+)", lists)[1]

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "engine/*", "samples/*", "shaders/*"):
            copy(self, pattern, self._repository, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def validate(self):
        check_min_cppstd(self, 20)

    def requirements(self):
        self.requires("vulkan-headers/[>=1.3.236]", transitive_headers=True)
        self.requires("glm/[>=0.9.9.8 <2]", visible=False)

    def build_requirements(self):
        self.tool_requires("cmake/[>=3.25]")
        self.tool_requires("glslang/[>=1.3.236 <2]")
        self.tool_requires("spirv-tools/[>=1.3.236 <2]")

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)  # sets BUILD_SHARED_LIBS
        toolchain.cache_variables["CANDELABRA_BUILD_TOOLS"] = "OFF"
        toolchain.cache_variables["CANDELABRA_BUILD_COMPILER"] = "OFF"
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        CMake(self).install()

    def package_info(self):
        # Hosts find the package of the library itself, so CMakeDeps writes none.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "candelabra")]
        self.cpp_info.resdirs = ["share"]
        self.cpp_info.libs = ["candelabra_static" if self._named_static else "candelabra"]
        if self.options.shared:
            self.cpp_info.defines = ["CND_SHARED"]
        elif self.settings.os in ("Linux", "FreeBSD"):
            self.cpp_info.system_libs = ["m"]

    @property
    def _named_static(self):
        return not self.options.shared and self.settings.compiler == "msvc"
