"""tools/gpu_part.sh with programs that only say what they are: what fails, hangs or finds no device is named."""
import os
import pathlib
import shutil
import subprocess
import unittest

from tree import Tree

ROOT = pathlib.Path(__file__).resolve().parents[2]
PARTS = ["words", "rasterizer", "terrain", "bench", "memcheck", "racecheck", "synccheck", "initcheck"]
PROGRAMS = ["cuda_device_test", "cuda_rasterizer_on_device", "cuda_terrain_on_device", "rastrum"]


class GpuPart(Tree):
    def setUp(self):
        super().setUp()
        (self.root / "bin").mkdir()
        (self.root / "tools").mkdir()
        shutil.copy(ROOT / "tools/gpu_part.sh", self.root)
        shutil.copy(ROOT / "tests/cuda/sanitized.txt", self.root)
        for program in PROGRAMS:
            self.program(program, "")
        self.program("compute-sanitizer", "", "tools")
        self.out = self.root / "out"

    def program(self, name, does, folder="bin"):
        file = self.root / folder / name
        file.write_text(f"#!/bin/bash\necho {name} $*\n{does}\n")
        file.chmod(0o755)

    def part(self, *arguments, **environment):
        run = subprocess.run([self.root / "gpu_part.sh", *arguments], text=True, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, timeout=60,
                             env={**os.environ, "PATH": f"{self.root}/tools:{os.environ['PATH']}", **environment})
        return run.returncode, run.stdout

    def results(self):
        """Without the seconds."""
        return [line.rsplit(" after ", 1)[0] for line in (self.out / "results").read_text().splitlines()]

    def test_lists_its_parts(self):
        self.assertEqual(self.part(), (0, "\n".join(PARTS) + "\n"))

    def test_all_run_in_order(self):
        code, output = self.part("all", self.out)
        self.assertEqual(code, 0, output)
        self.assertEqual(self.results(), [f"{part}: passed" for part in PARTS])
        self.assertIn(f"rastrum bench cuda --quick --out {self.out}", (self.out / "bench.log").read_text())
        self.assertEqual((self.out / "racecheck.log").read_text().count("--tool racecheck --error-exitcode 1"), 3)
        self.assertEqual((self.out / "initcheck.log").read_text().count("--error-exitcode 0"), 3)

    def test_what_fails_stops_no_other(self):
        self.program("cuda_rasterizer_on_device", "exit 3")
        code, output = self.part("all", self.out)
        self.assertEqual(code, 1)
        self.assertEqual(self.results()[:3], ["words: passed", "rasterizer: FAILED: exit status 3", "terrain: passed"])
        self.assertIn("rasterizer: FAILED: exit status 3", output)
        # Another run begins anew.
        self.program("cuda_rasterizer_on_device", "")
        self.assertEqual(self.part("all", self.out)[0], 0)
        self.assertEqual(len(self.results()), len(PARTS))

    def test_skipped_for_want_of_a_device_is_no_success(self):
        self.program("cuda_device_test", "echo 'no device: there is no driver'")
        code, output = self.part("words", self.out)
        self.assertEqual(code, 1)
        self.assertIn("ERROR: tests found no device that they could use", output)
        self.assertEqual(self.results(), ["words: FAILED: exit status 1"])

    def test_what_hangs_is_ended(self):
        self.program("cuda_terrain_on_device", "sleep 50")
        code, _ = self.part("terrain", self.out, RASTRUM_PART_S="1")
        self.assertEqual(code, 124)
        self.assertEqual(self.results(), ["terrain: FAILED: not done within 1 s"])

    def test_all_share_their_time(self):
        self.program("cuda_device_test", "sleep 50")
        code, _ = self.part("all", self.out, RASTRUM_ALL_S="1")
        self.assertEqual(code, 1)
        self.assertEqual(self.results()[0], "words: FAILED: not done within 1 s")
        self.assertEqual(self.results()[-1], "initcheck: FAILED: no time was left")

    def test_without_sanitizers(self):
        (self.root / "tools/compute-sanitizer").unlink()
        if shutil.which("compute-sanitizer"):
            self.skipTest("compute-sanitizer is here")
        self.assertIn("this machine has no compute-sanitizer", self.part("memcheck", self.out)[1])

    def test_no_such_part(self):
        code, output = self.part("speed", self.out)
        self.assertEqual(code, 2)
        self.assertIn("no part speed", output)


if __name__ == "__main__":
    unittest.main()
