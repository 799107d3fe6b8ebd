# SPDX-License-Identifier: BSD-3-Clause
"""tools/cuda_sources.py reports changes of what nvcc compiles, and nothing else."""
import unittest

from tree import Tree, run_tool


def run(command, root):
    return run_tool("cuda_sources.py", command, root)


class CudaSources(Tree):
    def setUp(self):
        super().setUp()
        self.write("cmake/RastrumCuda.cmake", "set(flags --fmad=false)\n")
        self.write("rastrum/cuda/CMakeLists.txt", "add_library(rastrum_cuda MODULE)\n")
        self.write("rastrum/core/vec.hpp", "struct Vec3;  // three\n")
        self.write("rastrum/core/other.hpp", "struct Other;\n")
        self.write("rastrum/raster/draw.cuh", '#include <rastrum/core/vec.hpp>\n')
        self.write("rastrum/raster/draw.cu", '#include "draw.cuh"\n#include <cstdint>\n')
        self.write("tests/cuda/compiled.txt", "")
        self.assertEqual(run("record", self.root), (0, ""))

    def test_nothing_changed(self):
        self.assertEqual(run("changed", self.root)[0], 0)

    def test_never_recorded(self):
        self.write("tests/cuda/compiled.txt", "")
        self.assertEqual(run("changed", self.root)[0], 1)

    def test_an_included_header_counts(self):
        self.write("rastrum/core/vec.hpp", "struct Vec4;\n")
        self.assert_says(run("changed", self.root), "has changed")

    def test_flags_and_new_files_count(self):
        self.write("cmake/RastrumCuda.cmake", "set(flags)\n")
        self.assertEqual(run("changed", self.root)[0], 1)
        run("record", self.root)
        self.write("tests/cuda/more.cu", "")
        self.assertEqual(run("changed", self.root)[0], 1)

    def test_the_half_for_the_cpu_does_not(self):
        self.write("rastrum/raster/draw.cu", '#include <rastrum/parallel/cuda/system_cpu.cuh>\n')
        self.write("rastrum/parallel/cuda/system_cpu.cuh", '#include "stream.hpp"\n')
        self.write("rastrum/parallel/cuda/stream.hpp", "struct Stream;\n")
        run("record", self.root)
        self.write("rastrum/parallel/cuda/system_cpu.cuh", '#include "stream.hpp"\nstruct Other;\n')
        self.write("rastrum/parallel/cuda/stream.hpp", "struct Changed;\n")
        self.assertEqual(run("changed", self.root)[0], 0)

    def test_comments_and_other_headers_do_not(self):
        self.write("rastrum/core/vec.hpp", "// of floats\nstruct Vec3;\n")
        self.write("rastrum/core/other.hpp", "struct Changed;\n")
        self.assertEqual(run("changed", self.root)[0], 0)

    def test_says_how_it_is_used(self):
        self.assert_says(run("recrod", self.root), "usage", code=2)


if __name__ == "__main__":
    unittest.main()
