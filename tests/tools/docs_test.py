# SPDX-License-Identifier: BSD-3-Clause
"""tools/docs.py runs the commands of the documentation and compares their pictures."""
import shutil
import sys
import unittest

from tree import ROOT, Tree, run

# A program that "draws" its first argument into the file after -o, and one that compares numbers.
PROGRAM = """[[ "$1" != fail ]] || { echo "no such thing" >&2; exit 1; }
while (($#)); do [[ "$1" != -o ]] || file="$2"; [[ "$1" != draw ]] || what="$2"; shift; done
[[ -z "${file:-}" ]] || printf %s "$what" >"$file"
"""
COMPARE = """a="$(<"$1")" b="$(<"$2")"
echo $((a > b ? a - b : b - a))
"""


class Docs(Tree):
    def setUp(self):
        super().setUp()
        (self.root / "tools").mkdir()
        for file in (ROOT / "tools").glob("docs*.py"):
            shutil.copy(file, self.root / "tools")
        self.images = self.root / "docs" / "images"
        self.images.mkdir(parents=True)
        (self.root / "dev").write_text("cmd_test() {\n}\n")
        self.write_script("build/apps/rastrum/rastrum", PROGRAM)
        self.write_script("build/tests/docs/picture_difference", COMPARE)

    def page(self, text, **pictures):
        (self.root / "docs" / "a.md").write_text(text)
        for name, content in pictures.items():
            (self.images / f"{name}.png").write_text(content)

    def docs(self, *arguments):
        return run(sys.executable, self.root / "tools" / "docs.py", *arguments)

    def check(self, command="check"):
        return self.docs(command, "--build", str(self.root / "build"), "docs/a.md")

    SHOWN = "![A](images/a.png)\n\n```sh\nrastrum draw 100 \\\n  -o a.png\n```\n"

    def test_the_picture_of_the_command(self):
        self.page(self.SHOWN, a="100")
        self.assertEqual(self.check(), (0, ""))
        self.page(self.SHOWN, a="101")
        self.assertEqual(self.check(), (0, ""))

    def test_an_old_picture_is_named_and_accepted(self):
        self.page(self.SHOWN, a="102")
        self.assert_says(self.check(), "docs/a.md: a.png differs by 2/255")
        self.assertEqual(self.check("accept"), (0, "accepted docs/images/a.png\n"))
        self.assertEqual((self.images / "a.png").read_text(), "100")

    def test_a_picture_of_no_command(self):
        self.page("![A](images/a.png)\n", a="1")
        self.assert_says(self.check(), "no command of the page draws a.png")

    def test_magnified_differences_may_differ_more(self):
        self.page(self.SHOWN.replace("a.png", "a_difference.png"), a_difference="116")
        self.assertEqual(self.check()[0], 0)
        self.page(self.SHOWN.replace("a.png", "a_difference.png"), a_difference="117")
        self.assertEqual(self.check()[0], 1)

    def test_what_fails_is_named_with_its_line(self):
        self.page("Text.\n\n```sh\nrastrum draw 1 -o b.png\nrastrum fail loudly\nrastrum draw 2\n```\n")
        self.assert_says(self.check(), "docs/a.md:4: the block does not run",
                         "no such thing\nfailed: rastrum fail loudly")

    def test_commands_outside_of_blocks_are_refused(self):
        self.page("Type\n\n    rastrum draw 1 -o b.png\n")
        self.assert_says(self.check(), "docs/a.md:3: a command outside")

    def test_other_languages_and_stand_ins(self):
        self.page("```cpp\nint main() {\n```\n```sh\ntest -s dragon.ply && test -s alps.png\n"
                  "srun -n 4 rastrum draw 3 -o c.png && test -s c.png\n./dev test\n```\n")
        self.assertEqual(self.check(), (0, ""))
        self.page("```sh\n./dev nonsense\n```\n")
        self.assertEqual(self.check()[0], 1)

    def test_blocks_of_cpp_are_compiled(self):
        self.write("tests/docs/pages.hpp", "extern int known;\n")
        self.write("README.md", "```cpp\nint f() {\n  return known;\n}\n```\n")
        self.page("```cpp\n#include <vector>\nstd::vector<int> v{known};\n```\n\n```cpp\nint v = known;\n```\n")
        self.assertEqual(self.docs("compile", "c++"), (0, ""))
        self.page("Text\n\n```cpp\nint v = unknown;\n```\n")
        self.assert_says(self.docs("compile", "c++"), "docs/a.md:4:")
        self.page("```cpp\nrastrum::mpi::render(comm);\n```\n")
        self.assertEqual(self.docs("compile", "c++", "-nostdinc"), (0, ""))  # so there is no mpi.h
        self.assertEqual(self.docs("compile")[0], 2)

    def test_links_and_pictures_left_over(self):
        (self.root / "README.md").write_text("[here](docs/a.md) [there](docs/b.md)\n")
        self.page("![A](images/a.png)\n", a="1", b="2")
        self.assertEqual(self.docs("links"), (1, "README.md: docs/b.md is not there\n"
                                 "docs/images/b.png: no page shows it\n"))

    def test_headings_and_pages_that_sources_name(self):
        (self.root / "README.md").write_text("[here](docs/a.md#what-it-is-and-why) [b](docs/a.md#b)\n")
        self.page("## What it is, and `why`\n[up](#what-it-is-and-why) [down](#down)\n")
        (self.root / "rastrum").mkdir()
        (self.root / "rastrum" / "x.hpp").write_text("// docs/a.md, docs/log/gone.md\n")
        self.assertEqual(self.docs("links"), (1, "README.md: docs/a.md#b is no heading there\n"
                                 "docs/a.md: #down is no heading there\n"
                                 "rastrum/x.hpp: docs/log/gone.md is not there\n"))


if __name__ == "__main__":
    unittest.main()
