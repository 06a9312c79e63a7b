"""Recipe for Spack. Copy it into a repository of packages as packages/ptriangle/package.py. Then run, in the root of
the tree: spack dev-build ptriangle@0.1.0
"""

from spack.package import *


class Ptriangle(CMakePackage):
    """Triangle meshes of plane figures with a guarantee on every angle, on all cores."""

    license("MIT")

    version("0.1.0")

    variant("shared", default=True, description="Shared libraries instead of static ones")
    variant("openmp", default=True, description="The parallel library and program")
    variant("pictures", default=False, description="meshplot, which draws meshes")
    variant("hdf5", default=True, description="HDF5 files, for meshes of any size")
    variant("prefix", default=False, description="pt- before the names that Triangle has as well")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.22:", type="build")
    depends_on("jansson")
    depends_on("hdf5@1.10.5:~mpi", when="+hdf5")
    depends_on("zlib-api", when="+hdf5")
    depends_on("cairo+svg+png", when="+pictures")
    conflicts("%gcc@:10", msg="std::from_chars for double came with GCC 11")

    def cmake_args(self):
        return [
            self.define_from_variant("BUILD_SHARED_LIBS", "shared"),
            self.define_from_variant("PTRIANGLE_OPENMP", "openmp"),
            self.define("PTRIANGLE_PREFIX", "pt-" if self.spec.satisfies("+prefix") else ""),
        ]
