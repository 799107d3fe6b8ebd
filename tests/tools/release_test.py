# SPDX-License-Identifier: BSD-3-Clause
"""All places that state the release's version agree."""
import re
import unittest

from tree import ROOT


class Release(unittest.TestCase):
    def test_version_of_the_citation(self):
        header = (ROOT / "include" / "rastrum" / "version.hpp").read_text(encoding="utf-8")
        numbers = re.findall(r"RASTRUM_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", header)
        citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
        self.assertEqual(re.search(r"^version: (.*)$", citation, re.MULTILINE).group(1), ".".join(numbers))


if __name__ == "__main__":
    unittest.main()
