"""tools/cuda_sources.py sees what nvcc compiles change, and nothing else."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "tools" / "cuda_sources.py"


def run(command, root):
    done = subprocess.run([sys.executable, SCRIPT, command, root], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


class CudaSources(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("cmake/RastrumCuda.cmake", "set(flags --fmad=false)\n")
        self.write("rastrum/cuda/CMakeLists.txt", "add_library(rastrum_cuda MODULE)\n")
        self.write("rastrum/core/vec.hpp", "struct Vec3;  // three\n")
        self.write("rastrum/core/other.hpp", "struct Other;\n")
        self.write("rastrum/raster/draw.cuh", '#include <rastrum/core/vec.hpp>\n')
        self.write("rastrum/raster/draw.cu", '#include "draw.cuh"\n#include <cstdint>\n')
        self.write("tests/cuda/compiled.txt", "")
        self.assertEqual(run("record", self.root), (0, ""))

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def test_nothing_changed(self):
        self.assertEqual(run("changed", self.root)[0], 0)

    def test_never_recorded(self):
        self.write("tests/cuda/compiled.txt", "")
        self.assertEqual(run("changed", self.root)[0], 1)

    def test_an_included_header_counts(self):
        self.write("rastrum/core/vec.hpp", "struct Vec4;\n")
        code, output = run("changed", self.root)
        self.assertEqual(code, 1)
        self.assertIn("has changed", output)

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
        code, output = run("recrod", self.root)
        self.assertEqual(code, 2)
        self.assertIn("usage", output)


if __name__ == "__main__":
    unittest.main()
