# SPDX-License-Identifier: BSD-3-Clause
"""Temporary trees for tests, and the project's tools run on them."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(*command, **options):
    """Returns the exit status and the output."""
    done = subprocess.run(command, capture_output=True, text=True, **options)
    return done.returncode, done.stdout + done.stderr


def run_tool(name, *arguments):
    return run(sys.executable, ROOT / "tools" / name, *arguments)


class Tree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        return file

    def write_script(self, path, text):
        self.write(path, "#!/usr/bin/env bash\n" + text).chmod(0o755)

    def assert_says(self, run, *texts, code=1):
        self.assertEqual(run[0], code, run[1])
        for text in texts:
            self.assertIn(text, run[1])


class CheckedTree(Tree):
    """Checks that TOOL passes the project and the tree, or prints one line."""
    TOOL = ""

    def check(self):
        return run_tool(self.TOOL, self.root)

    def assert_caught(self, place, words):
        code, output = self.check()
        self.assertEqual(code, 1, output)
        self.assertEqual(len(output.splitlines()), 1, output)
        self.assertIn(place, output)
        self.assertIn(words, output)

    def assert_project_passes(self):
        self.assertEqual(run_tool(self.TOOL, ROOT), (0, ""))
