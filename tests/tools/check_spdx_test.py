# SPDX-License-Identifier: BSD-3-Clause
"""tools/check_spdx.py finds sources without their licence, and adds it."""
import unittest

from tree import CheckedTree, run_tool


class CheckSpdx(CheckedTree):
    TOOL = "check_spdx.py"

    def test_project_passes(self):
        self.assert_project_passes()

    def test_sources_without_the_line(self):
        self.write("rastrum/a.hpp", "// A header.\n")
        self.assert_caught("rastrum/a.hpp:1: ", "// SPDX-License-Identifier: BSD-3-Clause")

    def test_what_is_added_passes_and_is_added_once(self):
        for path, text in (("rastrum/a.hpp", "// A.\n"), ("tools/b.py", "#!/usr/bin/env python3\nx = 1\n"), ("examples/c.f90", "end\n")):
            self.write(path, text)
        for _ in range(2):
            self.assertEqual(run_tool(self.TOOL, "--add", self.root), (0, ""))
        self.assertEqual(self.check(), (0, ""))
        self.assertEqual((self.root / "rastrum/a.hpp").read_text(), "// SPDX-License-Identifier: BSD-3-Clause\n// A.\n")
        self.assertEqual((self.root / "tools/b.py").read_text(),
                         "#!/usr/bin/env python3\n# SPDX-License-Identifier: BSD-3-Clause\nx = 1\n")
        self.assertEqual((self.root / "examples/c.f90").read_text(), "! SPDX-License-Identifier: BSD-3-Clause\nend\n")


if __name__ == "__main__":
    unittest.main()
