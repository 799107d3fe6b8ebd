# SPDX-License-Identifier: BSD-3-Clause
"""`./dev gpu` with tools that only log their arguments: its refusals, and what it runs in which order."""
import re
import shutil
import subprocess
import unittest

from tree import ROOT, Tree, run

PLAIN_TOOLS = ["awk", "bash", "cat", "dirname", "env", "grep", "head", "mktemp", "nproc", "rm", "sed", "tee"]
PROGRAMS = ["cuda_device_test", "cuda_rasterizer_on_device", "cuda_terrain_on_device"]
SANITIZERS = ["memcheck", "racecheck", "synccheck", "initcheck"]
SANITIZED = ROOT / "tests/cuda/sanitized.txt"


class DevGpu(Tree):
    def setUp(self):
        super().setUp()
        self.log = self.root / "log"
        self.log.touch()
        shutil.copy(ROOT / "dev", self.root)
        (self.root / "tests/cuda").mkdir(parents=True)
        shutil.copy(SANITIZED, self.root / "tests/cuda")
        (self.root / "bin").mkdir()
        for tool in PLAIN_TOOLS:
            (self.root / "bin" / tool).symlink_to(shutil.which(tool))

    def fake(self, name, does="", folder="bin"):
        """A tool that writes down its arguments."""
        self.write_script(f"{folder}/{name}", f'echo "{name} $*" >> "{self.log}"\n{does}\n')

    def fake_machine(self):
        for tool in ("nvcc", "nvidia-smi", "compute-sanitizer", "cmake", "ctest"):
            if not (self.root / "bin" / tool).exists():
                self.fake(tool)
        self.fake("rastrum", folder="build/cuda/apps/rastrum")

    def dev_gpu(self, *arguments):
        return run(self.root / "dev", "gpu", *arguments, env={"PATH": str(self.root / "bin")},
                   stdin=subprocess.DEVNULL, timeout=60)

    def failure(self, phase):
        """Returns the message if that phase fails."""
        self.fake_machine()
        code, output = self.dev_gpu()
        self.assertEqual(code, 1)
        self.assertRegex(output, rf"FAILED +\d+ s  {phase}")
        return output

    def calls(self, tool):
        return [line for line in self.log.read_text().splitlines() if line.split()[0] == tool]

    def test_says_what_is_missing_and_builds_nothing(self):
        self.fake("cmake")
        self.assert_says(self.dev_gpu(), "a GPU: there is no nvidia-smi")
        self.assertEqual(self.calls("cmake"), [])

    def test_a_driver_without_a_gpu(self):
        self.fake_machine()
        self.fake("nvidia-smi", "exit 9")
        self.assert_says(self.dev_gpu(), "this machine lacks\n  a GPU: the NVIDIA driver finds none")
        self.assertEqual(self.calls("cmake"), [])

    def test_runs_all_phases(self):
        self.fake_machine()
        self.assert_says(self.dev_gpu("--quick"), "7 passed, 0 failed", code=0)
        self.assertIn("rastrum_gpu_tests", self.calls("cmake")[-1])
        self.assertEqual(self.calls("rastrum"), ["rastrum bench cuda --out out/gpu --quick"])
        sanitized = [re.search(r"--tool (\w+) .*/(\w+) --gtest_filter=", call).groups()
                     for call in self.calls("compute-sanitizer")]
        self.assertEqual(sanitized, [(tool, program) for tool in SANITIZERS for program in PROGRAMS])

    def test_goes_on_after_a_failure_and_counts_it(self):
        self.fake("compute-sanitizer", '[[ "$*" != *racecheck* ]]')
        self.assertIn("6 passed, 1 failed", self.failure("compute-sanitizer, racecheck"))
        self.assertEqual(len(self.calls("rastrum")), 1)

    def test_a_failure_of_one_program_is_one_of_its_tool(self):
        self.fake("compute-sanitizer", '[[ "$*" != *memcheck*cuda_device_test* ]]')
        self.failure("compute-sanitizer, memcheck")
        self.assertEqual(len(self.calls("compute-sanitizer")), len(SANITIZERS) * len(PROGRAMS))

    def test_skipped_tests_are_no_success(self):
        self.fake("ctest", 'echo "1/4 Test #1: cuda.words_on_a_device ...***Skipped 0.01 sec"')
        self.failure("tests on the device")

    def test_the_sanitized_tests_exist(self):
        lists = re.findall(r"^(cuda_\w+) (\S+)$", SANITIZED.read_text(), re.MULTILINE)
        self.assertEqual([program for program, _ in lists], PROGRAMS)
        sources = "".join(file.read_text() for folder in ("cuda", "raster", "terrain", "transparency")
                          for file in (ROOT / "tests" / folder).rglob("*.cpp"))
        tests = {f"{suite}.{name}" for suite, name in re.findall(r"TEST(?:_F|_P)?\((\w+), (\w+)\)", sources)}
        for _, filters in lists:
            for name in filters.split(":"):
                self.assertIn(re.sub(r"^\w+/|/[\d*]+$", "", name), tests)


if __name__ == "__main__":
    unittest.main()
