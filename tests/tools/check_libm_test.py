"""tools/check_libm.py passes the project and catches calls of a libm."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "tools" / "check_libm.py"


def check(text, path="rastrum/scene/a.cpp"):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / path
        file.parent.mkdir(parents=True)
        file.write_text(text)
        run = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True)
    return run.returncode, run.stdout


class CheckLibm(unittest.TestCase):
    def test_project_passes(self):
        run = subprocess.run([sys.executable, SCRIPT, ROOT], capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stdout), (0, ""))

    def test_calls_are_caught(self):
        for call in ("y = std::sin(x);", "return powf(x, 2);", "auto f = std::exp;", "y = ::tan (x);",
                     "a = std::hypot(x, y);", "y = 1 - cosf(x);", "#include <math.h>"):
            code, output = check(f"// why\n{call}\n")
            self.assertEqual((code, len(output.splitlines())), (1, 1), call + output)
            self.assertIn("rastrum/scene/a.cpp:2:", output)

    def test_what_is_exact_or_no_call_passes(self):
        for good in ("y = std::sqrt(x) + std::fmod(x, 3) + std::ldexp(x, 2);", "// std::sin(x)",
                     '/* tan(x)\n*/ text = "40*sin(x)";', "y = elementary::sin(x);",
                     "double sinh(double x) {", "y = t.cos * sin;", "y = f.log(x) + g->exp(x);",
                     "y = max_exp(x);"):
            self.assertEqual(check(good), (0, ""), good)

    def test_exceptions(self):
        self.assertEqual(check("y = std::sin(x);", "apps/rastrum/window/a.cpp"), (0, ""))
        self.assertEqual(check("y = std::sin(x);", "examples/a.cpp"), (0, ""))


if __name__ == "__main__":
    unittest.main()
