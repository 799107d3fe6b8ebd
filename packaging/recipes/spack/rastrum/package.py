# SPDX-License-Identifier: BSD-3-Clause
# Untried (../../README.md).
from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Rastrum(CMakePackage):
    """Software rendering of meshes and terrains, exact and without OpenGL, GPU or display."""

    homepage = "https://github.com/OWNER/rastrum"
    url = "https://github.com/OWNER/rastrum/archive/refs/tags/v0.1.0.tar.gz"
    git = "https://github.com/OWNER/rastrum.git"

    license("BSD-3-Clause")

    version("main", branch="main")
    version("0.1.0", sha256="0000000000000000000000000000000000000000000000000000000000000000")

    variant("exr", default=True, description="Read and write EXR")
    variant("formulas", default=True, description="Terrains that are formulas")
    variant("mpi", default=True, description="Render by ranks of MPI")
    variant("program", default=True, description="Build the program rastrum")
    variant("shared", default=False, description="Build librastrum.so in place of the static libraries")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("highway")
    depends_on("jpeg")
    depends_on("libdeflate")
    depends_on("libpng")
    depends_on("nlohmann-json")
    depends_on("tbb")
    depends_on("zlib-api")
    depends_on("cli11", type="build", when="+program")
    depends_on("mpi", when="+mpi")
    depends_on("muparser", when="+formulas")
    depends_on("openexr@3:", when="+exr")

    # Spack's "draco" is another program.
    def cmake_args(self):
        without = [name for name, variant in (("MPI", "mpi"), ("muparser", "formulas"), ("OpenEXR", "exr"))
                   if not self.spec.satisfies(f"+{variant}")]
        return [
            self.define_from_variant("BUILD_SHARED_LIBS", "shared"),
            self.define_from_variant("RASTRUM_BUILD_APPS", "program"),
            self.define("RASTRUM_TBB", True),
            self.define("RASTRUM_WINDOW", False),
            self.define("RASTRUM_BUILD_TESTS", False),
            self.define("RASTRUM_BUILD_EXAMPLES", False),
            self.define("RASTRUM_BUILD_BENCH", False),
            *(self.define(f"CMAKE_DISABLE_FIND_PACKAGE_{name}", True) for name in (*without, "draco", "GDAL", "meshoptimizer")),
        ]
