from spack.package import *


class Ptriangle(CMakePackage):
    """Two-dimensional quality mesh generator and Delaunay triangulator: on one core, on all cores, and on the ranks of
    an MPI."""

    homepage = "https://ptriangle.invalid"
    url = "https://ptriangle.invalid/releases/ptriangle-0.2.0.tar.gz"

    license("MIT", checked_by="ptriangle")

    # The checksum of the release archive: none exists yet. Until then: spack dev-build ptriangle@0.2.0
    version("0.2.0", sha256="0000000000000000000000000000000000000000000000000000000000000000")

    variant("shared", default=True, description="Shared libraries instead of static ones")
    variant("openmp", default=True, description="Threads of OpenMP instead of those of the system")
    variant("mpi", default=True, description="The library and program for the ranks of an MPI")
    variant("pictures", default=False, description="meshplot, which draws meshes")
    variant("hdf5", default=True, description="HDF5 files, for meshes of any size")
    variant("prefix", default=False, description="pt- before the names that Triangle has as well")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.22:", type="build")
    depends_on("jansson")
    depends_on("mpi", when="+mpi")
    depends_on("hdf5@1.10.5:~mpi", when="+hdf5")
    depends_on("zlib-api", when="+hdf5")
    depends_on("cairo+svg+png", when="+pictures")
    conflicts("%gcc@:10", msg="std::from_chars for double came with GCC 11")

    def cmake_args(self):
        return [
            self.define_from_variant("BUILD_SHARED_LIBS", "shared"),
            self.define_from_variant("PTRIANGLE_OPENMP", "openmp"),
            self.define_from_variant("PTRIANGLE_MPI", "mpi"),
            self.define("PTRIANGLE_PREFIX", "pt-" if self.spec.satisfies("+prefix") else ""),
        ]
