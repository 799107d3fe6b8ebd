# SPDX-License-Identifier: BSD-3-Clause
"""tools/check_includes.py passes the project and catches each kind of violation."""
import unittest

from tree import CheckedTree

# The violation, its file, the file's text, the reported line, and the message.
WRONG = [
    ("upward include", "rastrum/core/bad.hpp", "// why\n#  include <rastrum/scene/mesh.hpp>\n",
     ":2", "core may not include scene"),
    ("io does not draw", "rastrum/io/bad.cpp", "#include <rastrum/raster/rules/make_piece.hpp>\n",
     ":1", "io may not include raster"),
    ("rooms are apart", "rastrum/terrain/bad.cpp", "#include <rastrum/raster/rules/make_piece.hpp>\n",
     ":1", "terrain may not include raster"),
    ("unknown room", "rastrum/raster/attic/bad.hpp", "#include <rastrum/raster/rules/piece.hpp>\n",
     ":1", "'attic' is no room"),
    ("the page shows the rooms as they are", "docs/frames.md", "no picture",
     ":1", "its picture of the rooms"),
    ("subfolders belong to their floor", "rastrum/scene/shapes/bad.cpp", "#include <rastrum/io/io.hpp>\n",
     ":1", "scene may not include io"),
    ("relative include", "rastrum/core/bad.hpp", '#include "vec.hpp"\n',
     ":1", "must be written <rastrum/...>"),
    ("unknown public header", "include/rastrum/more.hpp", "",
     ":1", "does not know"),
    ("programs include public headers", "examples/bad.cpp", "#include <rastrum/raster/frame/driver.hpp>\n",
     ":1", "no public header"),
    ("the C header is C's", "include/rastrum.h", "#include <stddef.h>\n#include <rastrum/vec.hpp>\n",
     ":2", "<rastrum/vec.hpp> is none of the headers of C"),
    ("nobody includes the C header", "rastrum/render/bad.cpp", "#include <rastrum.h>\n",
     ":1", "render may not include <rastrum.h>"),
    ("unknown floor", "rastrum/utils/a.hpp", "",
     "", "is no floor"),
]


class CheckIncludes(CheckedTree):
    TOOL = "check_includes.py"

    def setUp(self):
        super().setUp()
        self.write("rastrum/core/vec.hpp", "#pragma once\n#include <cmath>\n")

    def test_project_passes(self):
        self.assert_project_passes()

    def test_each_wrong_file(self):
        for name, path, text, line, words in WRONG:
            file = self.write(path, text)
            with self.subTest(name):
                self.assert_caught(path + line, words)
            file.unlink()

    def test_downward_includes_pass(self):
        self.write("rastrum/raster/a.cpp",
                   '#include <rastrum/core/vec.hpp>\n#include "hwy/highway.h"\n')
        self.write("rastrum/transparency/a.hpp", "#include <rastrum/raster/a.hpp>\n")
        self.write("apps/rastrum/main.cpp", '#include "commands.hpp"\n')
        self.assertEqual(self.check(), (0, ""))

    def test_a_room_includes_rooms_before_it(self):
        self.write("rastrum/raster/bin/good.cpp", "#include <rastrum/raster/rules/piece.hpp>\n")
        self.assertEqual(self.check(), (0, ""))
        self.write("rastrum/raster/rules/bad.hpp", "#include <rastrum/raster/bin/groups.hpp>\n")
        self.assert_caught("rastrum/raster/rules/bad.hpp:1", "rules may not include bin, which comes after it")

    def test_a_command_line_walks_through_its_rooms(self):
        for name in ("commands.hpp", "parse/output.hpp", "job/inputs.hpp", "window/viewer.hpp"):
            self.write(f"apps/rastrum/{name}", "")
        self.write("apps/rastrum/job/good.cpp", '#include "inputs.hpp"\n#include "parse/output.hpp"\n')
        self.write("apps/rastrum/main.cpp", '#include "commands.hpp"\n#include "job/inputs.hpp"\n')
        self.assertEqual(self.check(), (0, ""))
        for path in ("job/inputs.hpp", "commands.hpp", "window/viewer.hpp"):
            self.write("apps/rastrum/parse/bad.hpp", f'#include "{path}"\n')
            self.assert_caught("apps/rastrum/parse/bad.hpp:1", f"parse may not include {path}")

    def test_modules_form_no_circle(self):
        self.write("python/rastrum/_a.py", "from ._b import b\nfrom . import _rastrum\n")
        self.write("python/rastrum/_b.py", "try:\n    import scipy\nexcept ImportError:\n    pass\n")
        self.assertEqual(self.check(), (0, ""))
        self.write("python/rastrum/_c.py", "from . import _a\n")
        self.write("python/rastrum/_b.py", "from . import _c\n")
        self.assert_caught("python/rastrum/_", "imports itself through other modules")

    def test_own_modules_are_imported_at_the_top(self):
        self.write("python/rastrum/_a.py", "")
        self.write("python/rastrum/_b.py", "import os\ndef f():\n    from . import _a\n")
        self.assert_caught("python/rastrum/_b.py:3", "inside of a function")

    def test_library_does_not_include_programs(self):
        self.write("apps/rastrum/options.hpp", "")
        self.write("rastrum/render/bad.cpp", "#include <apps/rastrum/options.hpp>\n")
        self.assert_caught("rastrum/render/bad.cpp:1", "may not include <apps/rastrum/options.hpp>")

    def test_public_headers_belong_to_floors(self):
        self.write("include/rastrum/vec.hpp", "#include <cmath>\n#include <rastrum/config.hpp>\n")
        self.write("rastrum/scene/a.hpp", "#include <rastrum/vec.hpp>\n")
        self.write("apps/rastrum/main.cpp", "#include <rastrum/render.hpp>\n")
        self.assertEqual(self.check(), (0, ""))
        self.write("rastrum/scene/bad.hpp", "#include <rastrum/render.hpp>\n")
        self.assert_caught("rastrum/scene/bad.hpp:1", "scene may not include render")

    def test_public_headers_include_what_is_installed(self):
        for bad in ("rastrum/core/vec.hpp", "tbb/task.h"):
            self.write("include/rastrum/vec.hpp", f"#include <cmath>\n#include <{bad}>\n")
            self.assert_caught("include/rastrum/vec.hpp:2", f"may not include <{bad}>")

    def test_product_does_not_include_the_papers(self):
        self.write("papers/paper1/bins.hpp", "")
        self.write("rastrum/raster/bin/bad.hpp", "#include <papers/paper1/bins.hpp>\n")
        self.assert_caught("rastrum/raster/bin/bad.hpp:1", "the library may not include <papers/paper1/bins.hpp>")

    def test_papers_stand_on_earlier_ones(self):
        self.write("papers/paper2/good.cpp", "#include <papers/paper1/bins.hpp>\n#include <rastrum/raster/rules/piece.hpp>\n")
        self.assertEqual(self.check(), (0, ""))
        self.write("papers/paper1/bad.hpp", "#include <papers/table/row.hpp>\n")
        self.assert_caught("papers/paper1/bad.hpp:1", "paper1 may not include table, which comes after it")

    def test_simd_headers_stand_alone(self):
        guard = "RASTRUM_CORE_A_INL_HPP"
        header = (f"#if defined({guard}) == defined(HWY_TARGET_TOGGLE)\n#ifdef {guard}\n#undef {guard}\n#else\n"
                  f"#define {guard}\n#endif\n#include <rastrum/core/vec.hpp>\nHWY_BEFORE_NAMESPACE();\n"
                  "#include <rastrum/core/a.inl>\nHWY_AFTER_NAMESPACE();\n#endif\n")
        self.write("rastrum/core/a.inl", "struct A;\n")
        self.write("rastrum/core/a-inl.hpp", header)
        self.assertEqual(self.check(), (0, ""))
        for good, bad, words in ((guard, "RASTRUM_A_INL_HPP", f"guard {guard}"), ("#undef", "#define", "guard"),
                                 ("HWY_BEFORE_NAMESPACE();\n", "", "no namespace of an instruction set"),
                                 ("a.inl", "vec.hpp", "<rastrum/core/vec.hpp> is included inside a namespace")):
            self.write("rastrum/core/a-inl.hpp", header.replace(good, bad))
            self.assert_caught("rastrum/core/a-inl.hpp", words)
        self.write("rastrum/core/a-inl.hpp", header)
        self.write("rastrum/core/a.inl", "#include <rastrum/core/vec.hpp>\n")
        self.assert_caught("rastrum/core/a.inl:1", "inside a namespace")


if __name__ == "__main__":
    unittest.main()
