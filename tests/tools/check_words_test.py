# SPDX-License-Identifier: BSD-3-Clause
"""tools/check_words.py passes the project and catches each kind of violation."""
import unittest

from tree import CheckedTree


class CheckWords(CheckedTree):
    TOOL = "check_words.py"

    def setUp(self):
        super().setUp()
        for page in ("README.md", "CHANGELOG.md", "docs/scale.md", "rastrum/mesh.hpp", "python/rastrum/_view.py"):
            self.write(page, "")

    def test_project_passes(self):
        self.assert_project_passes()

    def test_what_is_no_prose_passes(self):
        self.write("README.md", "# What moves\n\nWhat is a tile? It is 8 × 8 pixels.\n\n```sh\nx\nWhat no\n" +
                   "```\nA cell of `x. What y` and\n\n| long row " + "of words " * 20 + "|\n")
        self.write("rastrum/mesh.hpp", 'int x;  // of a mesh\nconst char* s = "a part of it. What is it?";\nchar c = \'"\';\n')
        self.write("tests/mesh.cpp", 'const char* s = "It is. What else";\n')
        self.write("python/rastrum/_view.py", '# What a comment says.\nx = "a part. Whose? What?"\n')
        self.write("docs/log/README.md", "What was tried.\n")
        self.write("docs/decisions/0002-a.md", "**What we do.** It is so.\n\n**What follows.**\n- One.\n")
        self.assertEqual(self.check(), (0, ""))

    def test_sentences_of_pages(self):
        for text, line in (("Fine.\n\nWhat is drawn stays.\n", 3), ("It is so. Of all\nit is one.\n", 1),
                           ("It is\nso.\nWho knows waits.\n", 3), ("- one\n- **Those** are two.\n", 2),
                           ("| a | It is. What else |\n", 1), ("> What a quote says.\n", 1)):
            self.write("docs/scale.md", text)
            self.assert_caught(f"docs/scale.md:{line}: ", "")

    def test_sentences_of_decisions(self):
        for text, line in (("**What we do.** Fine.\n\nWho knows waits.\n", 3), ("**What we do.** What is it.\n", 1),
                           ("**What goes** is gone.\n", 1)):
            self.write("docs/decisions/0002-a.md", text)
            self.assert_caught(f"docs/decisions/0002-a.md:{line}: ", "")

    def test_comments_of_sources(self):
        for text, line in (("/// Draws.\n/// What is left stays.\n", 2), ("int x;  ///< Of a mesh\n", 1),
                           ("int a;\n// Fine so\n// far. Who asks is told.\n", 3),
                           ("/// One.\n///\n/// Of two\n", 3), ("// SPDX-License-Identifier: X\n// Who draws.\n", 2)):
            for source in ("rastrum/mesh.hpp", "apps/rastrum/main.cpp"):
                self.write(source, text)
                self.assert_caught(f"{source}:{line}: ", "")
                self.write(source, "")

    def test_strings_of_sources(self):
        for text, line in (('say("Of all");\n', 1), ('x = 1\'000;\nsay("It is "\n    "so. Who "\n    "knows");\n', 3),
                           ('say("Fine.\\nWhat no");\n', 1), ('say(\'"\', "Those");\n', 1), ('// "\nsay("What");\n', 2),
                           ('say(R"(It is. Of all)");\n', 1)):
            for source in ("rastrum/mesh.hpp", "apps/rastrum/main.cpp", "python/src/module.cpp"):
                self.write(source, text)
                self.assert_caught(f"{source}:{line}: ", "")
                self.write(source, "")

    def test_strings_of_python(self):
        for text, line in (('"""Fine.\n\nWhat no.\n"""\n', 3), ('def f():\n    """It is. Of all."""\n', 2),
                           ('x = 1\nraise Error(f"{x}: no. Those are.")\n', 2), ('x = ("It is so. "\n     "Who knows")\n', 1)):
            self.write("python/rastrum/_view.py", text)
            self.assert_caught(f"python/rastrum/_view.py:{line}: ", "")

    def test_long_line(self):
        self.write("README.md", f"![{'A word ' * 30}](a.png)\n")
        self.assertEqual(self.check(), (0, ""))
        self.write("CHANGELOG.md", "- short\n- " + "word " * 40 + "\n")
        self.assert_caught("CHANGELOG.md:2: ", "202 characters")


if __name__ == "__main__":
    unittest.main()
