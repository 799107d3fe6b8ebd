"""`./dev gpu` with tools that only say what they were asked for: it refuses, and what it runs in which order."""
import pathlib
import re
import shutil
import subprocess
import unittest

from tree import Tree

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
PLAIN_TOOLS = ["awk", "bash", "cat", "dirname", "env", "grep", "head", "mktemp", "nproc", "rm", "sed", "tee"]
PROGRAMS = ["cuda_device_test", "cuda_rasterizer_on_device", "cuda_terrain_on_device"]
SANITIZERS = ["memcheck", "racecheck", "synccheck", "initcheck"]
SANITIZED = REPOSITORY / "tests/cuda/sanitized.txt"


class DevGpu(Tree):
    def setUp(self):
        super().setUp()
        self.log = self.root / "log"
        self.log.touch()
        shutil.copy(REPOSITORY / "dev", self.root)
        (self.root / "tests/cuda").mkdir(parents=True)
        shutil.copy(SANITIZED, self.root / "tests/cuda")
        self.bin = self.root / "bin"
        self.bin.mkdir()
        for tool in PLAIN_TOOLS:
            (self.bin / tool).symlink_to(shutil.which(tool))

    def fake(self, name, does="", folder=None):
        """A tool that writes down its arguments."""
        file = (folder or self.bin) / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f'#!/bin/bash\necho "{name} $*" >> "{self.log}"\n{does}\n')
        file.chmod(0o755)

    def fake_machine(self):
        for tool in ("nvcc", "nvidia-smi", "compute-sanitizer", "cmake", "ctest"):
            self.fake(tool)
        self.fake("rastrum", folder=self.root / "build/cuda/apps/rastrum")

    def dev_gpu(self, *arguments):
        run = subprocess.run([str(self.root / "dev"), "gpu", *arguments], capture_output=True, text=True,
                             env={"PATH": str(self.bin)}, stdin=subprocess.DEVNULL, timeout=60)
        return run.returncode, run.stdout + run.stderr

    def calls(self, tool):
        return [line for line in self.log.read_text().splitlines() if line.split()[0] == tool]

    def test_says_what_is_missing_and_builds_nothing(self):
        self.fake("cmake")
        code, output = self.dev_gpu()
        self.assertEqual(code, 1)
        self.assertIn("a GPU: there is no nvidia-smi", output)
        self.assertEqual(self.calls("cmake"), [])

    def test_a_driver_without_a_gpu(self):
        self.fake_machine()
        self.fake("nvidia-smi", "exit 9")
        code, output = self.dev_gpu()
        self.assertEqual(code, 1)
        self.assertIn("this machine lacks\n  a GPU: the NVIDIA driver finds none", output)
        self.assertEqual(self.calls("cmake"), [])

    def test_runs_all_phases(self):
        self.fake_machine()
        code, output = self.dev_gpu("--quick")
        self.assertEqual(code, 0, output)
        self.assertIn("7 passed, 0 failed", output)
        self.assertIn("rastrum_gpu_tests", self.calls("cmake")[-1])
        self.assertEqual(self.calls("rastrum"), ["rastrum bench cuda --out out/gpu --quick"])
        sanitized = [re.search(r"--tool (\w+) .*/(\w+) --gtest_filter=", call).groups()
                     for call in self.calls("compute-sanitizer")]
        self.assertEqual(sanitized, [(tool, program) for tool in SANITIZERS for program in PROGRAMS])

    def test_goes_on_after_a_failure_and_counts_it(self):
        self.fake_machine()
        self.fake("compute-sanitizer", '[[ "$*" != *racecheck* ]]')
        code, output = self.dev_gpu()
        self.assertEqual(code, 1)
        self.assertRegex(output, r"FAILED +\d+ s  compute-sanitizer, racecheck")
        self.assertIn("6 passed, 1 failed", output)
        self.assertEqual(len(self.calls("rastrum")), 1)

    def test_a_failure_of_one_program_is_one_of_its_tool(self):
        self.fake_machine()
        self.fake("compute-sanitizer", '[[ "$*" != *memcheck*cuda_device_test* ]]')
        code, output = self.dev_gpu()
        self.assertEqual(code, 1)
        self.assertRegex(output, r"FAILED +\d+ s  compute-sanitizer, memcheck")
        self.assertEqual(len(self.calls("compute-sanitizer")), len(SANITIZERS) * len(PROGRAMS))

    def test_skipped_tests_are_no_success(self):
        self.fake_machine()
        self.fake("ctest", 'echo "1/4 Test #1: cuda.words_on_a_device ...***Skipped 0.01 sec"')
        code, output = self.dev_gpu()
        self.assertEqual(code, 1)
        self.assertRegex(output, r"FAILED +\d+ s  tests on the device")

    def test_the_sanitized_tests_exist(self):
        lists = re.findall(r"^(cuda_\w+) (\S+)$", SANITIZED.read_text(), re.MULTILINE)
        self.assertEqual([program for program, _ in lists], PROGRAMS)
        sources = "".join(file.read_text() for folder in ("cuda", "raster", "terrain", "transparency")
                          for file in (REPOSITORY / "tests" / folder).rglob("*.cpp"))
        tests = {f"{suite}.{name}" for suite, name in re.findall(r"TEST(?:_F|_P)?\((\w+), (\w+)\)", sources)}
        for _, filters in lists:
            for name in filters.split(":"):
                self.assertIn(re.sub(r"^\w+/|/[\d*]+$", "", name), tests)


if __name__ == "__main__":
    unittest.main()
