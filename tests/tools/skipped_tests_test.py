# SPDX-License-Identifier: BSD-3-Clause
"""tools/skipped_tests.py says how many tests CTest skipped, why, and what would run them."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "tools" / "skipped_tests.py"


def line_of(**tests):
    """Returns the tool's line for a run of these tests, each of which prints its text."""
    with tempfile.TemporaryDirectory() as folder:
        script = "\n".join(f'add_test({name} "${{CMAKE_COMMAND}}" -E echo "{text}")\n'
                           f'set_tests_properties({name} PROPERTIES SKIP_REGULAR_EXPRESSION "SKIPPED")'
                           for name, text in tests.items())
        (pathlib.Path(folder) / "CMakeLists.txt").write_text(
            f"cmake_minimum_required(VERSION 3.25)\nproject(Tests NONE)\nenable_testing()\n{script}\n")
        quietly = {"cwd": folder, "check": True, "capture_output": True}
        subprocess.run(["cmake", "-G", "Ninja", "."], **quietly)
        subprocess.run(["ctest", "--output-junit", "tests.xml"], **quietly)
        return subprocess.run([sys.executable, SCRIPT, pathlib.Path(folder) / "tests.xml"], check=True,
                              capture_output=True, text=True).stdout


class SkippedTests(unittest.TestCase):
    def test_nothing_skipped(self):
        self.assertEqual(line_of(passes="fine"), "")

    def test_counts_by_remedy(self):
        line = line_of(passes="fine", bunny="SKIPPED ../shared/data/bunny.obj is not there",
                       cow="SKIPPED cow.obj is not here", device="SKIPPED no device", python="3 passed, 5 skipped in 2 s")
        self.assertRegex(line, r"^8 tests were skipped: [^\n]*\n$")
        self.assertIn("2 want meshes that are not the project's own (RASTRUM_SHARED", line)
        self.assertIn("1 want an NVIDIA GPU (./dev gpu)", line)
        self.assertIn("5 are Python's", line)


if __name__ == "__main__":
    unittest.main()
