# SPDX-License-Identifier: BSD-3-Clause
"""Checks that papers/break_rows.py fits the sources, without its half hour of builds."""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "papers"))
sys.dont_write_bytecode = True
import break_rows  # noqa: E402


def rows_of(table, kind):
    """The names in a table of rows, in C++."""
    text = (ROOT / table).read_text()
    return set(re.findall(kind + r'\{\s*"(\w+)"', text))


class BreakRows(unittest.TestCase):
    def test_each_text_is_found_once_and_changed(self):
        for b in break_rows.BREAKS:
            source = (ROOT / b.file).read_text()
            self.assertEqual(source.count(b.text), 1, f"{b.name}: {b.text}")
            self.assertNotEqual(b.text, b.broken, b.name)

    def test_each_row_is_broken(self):
        coverages = rows_of("papers/table/coverages.cpp", "CoverageRow")
        visibilities = rows_of("papers/table/visibilities.cpp", "Visibility")
        self.assertEqual(set(break_rows.COVERAGES), coverages)
        self.assertEqual(set(break_rows.VISIBILITIES), visibilities)
        everywhere = {f"{c}_{v}" for c in coverages for v in visibilities}

        def broken(is_alone):
            return set().union(*(b.expected_points() for b in break_rows.BREAKS if is_alone(b)))

        self.assertEqual(broken(lambda b: len(b.coverages) == 1), everywhere)
        self.assertEqual(broken(lambda b: len(b.visibilities) == 1), everywhere)

    def test_names_are_unique(self):
        names = [b.name for b in break_rows.BREAKS]
        self.assertEqual(len(names), len(set(names)))

    def test_cases_are_told_apart_by_row(self):
        for case, row in (("Coverages/EverySample.IsEnumeratedOnce/scanline", "scanline"),
                          ("Tiled.ScratchStaysBelowThePapersForABunny", "tiled"),
                          ("TileMask.OfLinesAndPoints", "binned"),
                          ("Binned.QueuesGrow", "binned"),
                          ("Layers/Counted.SortedWritesEveryFragmentOnce/2", "sorted"),
                          ("All/Methods.KeepTheMaximumOfEachPixel/tuple", "tuple"),
                          ("Order.MortonIsTheInterleavedOne", "Order.MortonIsTheInterleavedOne")):
            self.assertEqual(break_rows.row_of(case), row)

    def test_points_are_described(self):
        everywhere = {f"{c}_atomic" for c in break_rows.COVERAGES}
        self.assertEqual(break_rows.describe(everywhere), "all × atomic")
        self.assertEqual(break_rows.describe({"tiled_atomic", "hybrid_search"}),
                         "hybrid_search, tiled_atomic")
        self.assertEqual(break_rows.describe(set()), "none")


if __name__ == "__main__":
    unittest.main()
