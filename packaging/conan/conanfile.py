# SPDX-License-Identifier: BSD-3-Clause
"""conan create packaging/conan --build=missing (Conan 2)."""

import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load

LEFT_OUT = ("CAD", "FCL", "OMPL", "CLI", "PYTHON", "TESTS")
FOLDERS = ("base", "packaging", "geometry", "io", "spheretree", "simplifier", "collide", "robot", "docs", "examples")


class Spherule(ConanFile):
    name = "spherule"
    description = "Proved sphere covers of CAD meshes and robots, sphere trees, and collision checking on them"
    license = "BSD-3-Clause"
    settings = "os", "arch", "compiler", "build_type"
    package_type = "library"
    options = {"shared": [True, False]}
    default_options = {"shared": False}
    requires = (
        "eigen/3.4.0",
        "nlohmann_json/3.11.3",
        "onetbb/2021.12.0",
        "tinyxml2/10.0.0",
        "yaml-cpp/0.8.0",
        "zlib/[>=1.2.11 <2]",
    )

    @property
    def root(self):
        return os.path.join(self.recipe_folder, os.pardir, os.pardir)

    def set_version(self):
        text = load(self, os.path.join(self.root, "CMakeLists.txt"))
        self.version = re.search(r"project\(spherule VERSION ([0-9.]+)", text).group(1)

    def export_sources(self):
        for folder in FOLDERS:
            copy(self, f"{folder}/*", self.root, self.export_sources_folder)
        for file in ("CMakeLists.txt", "LICENSE", "README.md", "CHANGELOG.md", "collide.h", "robot.h", "simplifier.h"):
            copy(self, file, self.root, self.export_sources_folder)

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for part in LEFT_OUT:
            toolchain.cache_variables[f"SPHERULE_{part}"] = False
        toolchain.cache_variables["SPHERULE_INSTALL"] = True
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        # The package's own configuration has the targets.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs.append(os.path.join("lib", "cmake", "spherule"))
