# SPDX-License-Identifier: BSD-3-Clause
"""The showcase's entries, and its page."""
import argparse
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import showcase  # noqa: E402
import showcase_entries  # noqa: E402


class Showcase(unittest.TestCase):
    def test_names_are_unique_and_files_there(self):
        names = [e.name for e in showcase_entries.ENTRIES]
        self.assertEqual(len(names), len(set(names)))
        self.assertGreaterEqual(len(names), 30)
        data = ROOT.parent / "shared" / "data"
        if not data.is_dir():
            self.skipTest("there is no shared/data")
        for entry in showcase_entries.ENTRIES:
            for file in entry.files + [entry.peer_file] * bool(entry.peer_file):
                if file.startswith("DATA/"):
                    self.assertTrue((data / file.removeprefix("DATA/")).exists(), f"{entry.name}: {file}")

    def test_a_page_has_its_pictures(self):
        entry = showcase_entries.Entry("a", "A & B", "render x --background '#fff'")
        picture = showcase.Picture("a.png", "small/a.png", "rastrum render x > y", 0.5)
        page = showcase.as_html([(entry, picture, {"f3d": picture})])
        self.assertIn("A &amp; B", page)
        self.assertIn("x &gt; y", page)
        self.assertEqual(page.count("small/a.png"), 2)
        self.assertIn("```sh\nrastrum render x > y\n```", showcase.as_markdown([(entry, picture, {})]))

    def test_without_its_program_it_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            options = argparse.Namespace(build=pathlib.Path(folder), data=pathlib.Path(folder), out=pathlib.Path(folder),
                                         no_peers=True, new_peers=False)
            with self.assertRaises(SystemExit) as ended:
                showcase.Maker(options).ours(showcase_entries.Entry("a", "A", "render builtin:teapot"))
            self.assertIn("rastrum render builtin:teapot", str(ended.exception))

    def test_help(self):
        done = subprocess.run([sys.executable, ROOT / "tools" / "showcase.py", "--help"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0)
        self.assertIn("showcase", done.stdout)


if __name__ == "__main__":
    unittest.main()
