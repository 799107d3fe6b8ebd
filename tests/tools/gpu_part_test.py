# SPDX-License-Identifier: BSD-3-Clause
"""tools/gpu_part.sh with programs that only say who they are: it names what fails, hangs or finds no device."""
import os
import shutil
import subprocess
import unittest

from tree import ROOT, Tree, run

PARTS = ["words", "rasterizer", "terrain", "bench", "memcheck", "racecheck", "synccheck", "initcheck"]
PROGRAMS = ["cuda_device_test", "cuda_rasterizer_on_device", "cuda_terrain_on_device", "rastrum"]


class GpuPart(Tree):
    def setUp(self):
        super().setUp()
        shutil.copy(ROOT / "tools/gpu_part.sh", self.root)
        shutil.copy(ROOT / "tests/cuda/sanitized.txt", self.root)
        for program in PROGRAMS:
            self.program(program, "")
        self.program("compute-sanitizer", "", "tools")
        self.out = self.root / "out"

    def program(self, name, does, folder="bin"):
        self.write_script(f"{folder}/{name}", f"echo {name} $*\n{does}\n")

    def part(self, *arguments, **environment):
        return run(self.root / "gpu_part.sh", *arguments, stdin=subprocess.DEVNULL, timeout=60,
                   env={**os.environ, "PATH": f"{self.root}/tools:{os.environ['PATH']}", **environment})

    def results(self):
        """Returns the results without the seconds."""
        return [line.rsplit(" after ", 1)[0] for line in (self.out / "results").read_text().splitlines()]

    def test_lists_its_parts(self):
        self.assertEqual(self.part(), (0, "\n".join(PARTS) + "\n"))

    def test_all_run_in_order(self):
        self.assert_says(self.part("all", self.out), code=0)
        self.assertEqual(self.results(), [f"{part}: passed" for part in PARTS])
        self.assertIn(f"rastrum bench cuda --quick --out {self.out}", (self.out / "bench.log").read_text())
        self.assertEqual((self.out / "racecheck.log").read_text().count("--tool racecheck --error-exitcode 1"), 3)
        self.assertEqual((self.out / "initcheck.log").read_text().count("--error-exitcode 0"), 3)

    def test_what_fails_stops_no_other(self):
        self.program("cuda_rasterizer_on_device", "exit 3")
        self.assert_says(self.part("all", self.out), "rasterizer: FAILED: exit status 3")
        self.assertEqual(self.results()[:3], ["words: passed", "rasterizer: FAILED: exit status 3", "terrain: passed"])
        # Another run starts afresh.
        self.program("cuda_rasterizer_on_device", "")
        self.assertEqual(self.part("all", self.out)[0], 0)
        self.assertEqual(len(self.results()), len(PARTS))

    def test_skipped_for_want_of_a_device_is_no_success(self):
        self.program("cuda_device_test", "echo 'no device: there is no driver'")
        self.assert_says(self.part("words", self.out), "ERROR: tests found no device that they could use")
        self.assertEqual(self.results(), ["words: FAILED: exit status 1"])

    def test_what_hangs_is_ended(self):
        self.program("cuda_terrain_on_device", "sleep 50")
        self.assert_says(self.part("terrain", self.out, RASTRUM_PART_S="1"), code=124)
        self.assertEqual(self.results(), ["terrain: FAILED: not done within 1 s"])

    def test_all_share_their_time(self):
        self.program("cuda_device_test", "sleep 50")
        self.assert_says(self.part("all", self.out, RASTRUM_ALL_S="1"))
        self.assertEqual(self.results()[0], "words: FAILED: not done within 1 s")
        self.assertEqual(self.results()[-1], "initcheck: FAILED: no time was left")

    def test_without_sanitizers(self):
        (self.root / "tools/compute-sanitizer").unlink()
        if shutil.which("compute-sanitizer"):
            self.skipTest("compute-sanitizer is here")
        self.assertIn("this machine has no compute-sanitizer", self.part("memcheck", self.out)[1])

    def test_no_such_part(self):
        self.assert_says(self.part("speed", self.out), "no part speed", code=2)


if __name__ == "__main__":
    unittest.main()
