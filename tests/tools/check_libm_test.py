# SPDX-License-Identifier: BSD-3-Clause
"""tools/check_libm.py passes the project and catches calls of a libm."""
import unittest

from tree import CheckedTree


class CheckLibm(CheckedTree):
    TOOL = "check_libm.py"

    def test_project_passes(self):
        self.assert_project_passes()

    def test_calls_are_caught(self):
        for call in ("y = std::sin(x);", "return powf(x, 2);", "auto f = std::exp;", "y = ::tan (x);",
                     "a = std::hypot(x, y);", "y = 1 - cosf(x);", "#include <math.h>"):
            self.write("rastrum/scene/a.cpp", f"// why\n{call}\n")
            self.assert_caught("rastrum/scene/a.cpp:2:", "")

    def test_what_is_exact_or_no_call_passes(self):
        for good in ("y = std::sqrt(x) + std::fmod(x, 3) + std::ldexp(x, 2);", "// std::sin(x)",
                     '/* tan(x)\n*/ text = "40*sin(x)";', "y = elementary::sin(x);",
                     "double sinh(double x) {", "y = t.cos * sin;", "y = f.log(x) + g->exp(x);",
                     "y = max_exp(x);"):
            self.write("rastrum/scene/a.cpp", good)
            self.assertEqual(self.check(), (0, ""), good)

    def test_exceptions(self):
        self.write("apps/rastrum/window/a.cpp", "y = std::sin(x);")
        self.write("examples/a.cpp", "y = std::sin(x);")
        self.assertEqual(self.check(), (0, ""))


if __name__ == "__main__":
    unittest.main()
