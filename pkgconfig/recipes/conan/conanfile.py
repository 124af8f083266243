"""Template, untested."""
from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, get


class MassspringConan(ConanFile):
    name = "massspring"
    version = "0.1.0"
    license = "MIT"
    description = "Simulation of two-dimensional mass-spring-damper networks"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False]}
    default_options = {"shared": False}

    def configure(self):
        self.settings.rm_safe("compiler.libcxx")
        self.settings.rm_safe("compiler.cppstd")

    def layout(self):
        cmake_layout(self)

    def source(self):
        get(self, url="REPOSITORY", sha256="", strip_root=True)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for part in "TESTS", "EXAMPLES", "BENCH":
            toolchain.cache_variables["MASSSPRING_" + part] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, self.package_folder + "/licenses")

    def package_info(self):
        windows = self.settings.os == "Windows"
        self.cpp_info.libs = ["massspring_static" if windows and not self.options.shared else "massspring"]
        if self.options.shared and windows:
            self.cpp_info.defines = ["MSPRING_SHARED"]
        if not windows:
            self.cpp_info.system_libs = ["m", "pthread"]
