import os

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, get, rmdir
from conan.tools.microsoft import is_msvc

required_conan_version = ">=2.1"


class PtriangleConan(ConanFile):
    name = "ptriangle"
    description = "Two-dimensional quality mesh generator and Delaunay triangulator"
    license = "MIT"
    url = "https://github.com/conan-io/conan-center-index"
    homepage = "https://ptriangle.invalid"
    topics = ("mesh", "delaunay", "triangulation", "finite-elements", "geometry")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "openmp": [True, False]}
    default_options = {"shared": False, "openmp": False}

    def validate(self):
        if is_msvc(self):
            raise ConanInvalidConfiguration("ptriangle needs GCC or Clang; on Windows mingw-w64")

    def layout(self):
        cmake_layout(self, src_folder="src")

    def build_requirements(self):
        self.tool_requires("cmake/[>=3.22]")

    def source(self):
        get(self, **self.conan_data["sources"][self.version], strip_root=True)

    def generate(self):
        tc = CMakeToolchain(self)
        tc.cache_variables["PTRIANGLE_PROGRAMS"] = False
        tc.cache_variables["PTRIANGLE_MPI"] = False
        tc.cache_variables["PTRIANGLE_OPENMP"] = bool(self.options.openmp)
        tc.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        cmake = CMake(self)
        cmake.install()
        rmdir(self, os.path.join(self.package_folder, "share"))

    def package_info(self):
        # The package brings ptriangleConfig.cmake, which names its libraries and what they need.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "ptriangle")]
        self.cpp_info.libs = ["ptriangle"] if self.options.shared else ["ptriangle", "triangle"]
        if self.settings.os in ("Linux", "FreeBSD"):
            self.cpp_info.system_libs = ["m", "pthread"]
