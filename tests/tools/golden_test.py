# SPDX-License-Identifier: BSD-3-Clause
"""tools/golden.py lists failed golden pictures, flickers them on a page, and accepts the new ones."""
import shutil
import sys
import unittest

from tree import ROOT, Tree, run


class Golden(Tree):
    def setUp(self):
        super().setUp()
        (self.root / "tools").mkdir()
        shutil.copy(ROOT / "tools" / "golden.py", self.root / "tools")

    def add_failure(self, build, name, **pictures):
        failures = self.root / "build" / build / "golden-failures"
        failures.mkdir(parents=True, exist_ok=True)
        for kind, content in pictures.items():
            (failures / f"{name}.{kind}.png").write_bytes(content)

    def golden(self, *arguments):
        return run(sys.executable, self.root / "tools" / "golden.py", *arguments)

    def accepted(self, name):
        file = self.root / "tests" / "golden" / f"{name}.png"
        return file.read_bytes() if file.exists() else None

    def test_nothing_failed(self):
        self.assertEqual(self.golden(), (0, "no golden picture failed (run ./dev test first)\n"))

    def test_lists_and_writes_a_page(self):
        self.add_failure("ci", "teapot", expected=b"old", actual=b"new", diff=b"diff")
        self.assert_says(self.golden(), "teapot (ci)", code=0)
        page = (self.root / "build" / "golden.html").read_text()
        for kind in ("expected", "actual", "diff"):
            self.assertIn(f"teapot.{kind}.png", page)

    def test_accepts_what_is_named(self):
        self.add_failure("ci", "teapot", expected=b"old", actual=b"new")
        self.add_failure("ci", "knot", actual=b"first")
        self.assertEqual(self.golden("accept", "knot")[0], 0)
        self.assertEqual(self.accepted("knot"), b"first")
        self.assertIsNone(self.accepted("teapot"))
        self.assertEqual(self.golden("accept")[0], 0)
        self.assertEqual(self.accepted("teapot"), b"new")
        self.assertIn("no golden picture failed", self.golden()[1])

    def test_accepts_digests(self):
        for name, digest in (("b", "22"), ("a", "11"), ("b", "33")):
            self.write(f"build/ci/golden-failures/terrain/{name}.actual.sha256", digest + "\n")
            self.assertIn(f"terrain/{name} (ci)", self.golden()[1])
            self.assertEqual(self.golden("accept")[0], 0)
        self.assertEqual((self.root / "tests" / "golden" / "hashes.txt").read_text(),
                         "11  terrain/a\n33  terrain/b\n")

    def test_refuses_a_name_that_did_not_fail(self):
        self.add_failure("ci", "teapot", actual=b"new")
        self.assertEqual(self.golden("accept", "taepot")[0], 1)
        self.assertIsNone(self.accepted("teapot"))

    def test_refuses_two_builds_that_disagree(self):
        self.add_failure("ci", "teapot", actual=b"one")
        self.add_failure("asan", "teapot", actual=b"another")
        self.assertEqual(self.golden("accept")[0], 1)
        self.assertIsNone(self.accepted("teapot"))


if __name__ == "__main__":
    unittest.main()
