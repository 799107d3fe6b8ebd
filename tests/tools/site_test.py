# SPDX-License-Identifier: BSD-3-Clause
"""tools/site.py: each page has its place in the site, its links work, and headers become pages."""
import shutil
import sys
import unittest
import xml.etree.ElementTree as ElementTree

from tree import ROOT, Tree, run, run_tool

sys.path.insert(0, str(ROOT / "tools"))
import site_cpp  # noqa: E402


class Navigation(Tree):
    def setUp(self):
        super().setUp()
        (self.root / "tools").mkdir()
        for name in ("docs.py", "docs_files.py", "site.py", "site_cpp.py", "site_links.py"):
            shutil.copy(ROOT / "tools" / name, self.root / "tools")
        self.write("README.md", "# A\n")
        self.write("docs/a.md", "# A\n")
        self.write("docs/log/b.md", "# B\n")
        self.write("include/rastrum.h", "")
        self.write("include/rastrum/mesh.hpp", "")
        self.write("docs/site/index.md", "```{toctree}\nGuides <guides/index>\ncpp/index\n```\n")
        self.write("docs/site/cpp.md", "```{toctree}\n../cpp_api/mesh\n../cpp_api/rastrum_h\n```\n")
        self.write("docs/site/guides.md", "```{toctree}\n:caption: Begin\n\n../a\n```\n")

    def navigation(self):
        return run(sys.executable, self.root / "tools" / "site.py", "navigation")

    def test_project_passes(self):
        self.assertEqual(run_tool("site.py", "navigation"), (0, ""))

    def test_what_has_its_place_passes(self):
        self.assertEqual(self.navigation(), (0, ""))

    def test_pages_and_headers_without_a_place(self):
        self.write("docs/c.md", "# C\n")
        self.write("include/rastrum/scene.hpp", "")
        self.assert_says(self.navigation(), "docs/c.md: no page of docs/site/ names it",
                         "include/rastrum/scene.hpp: no page of docs/site/ names it")

    def test_a_place_of_no_page(self):
        (self.root / "docs/a.md").unlink()
        self.assert_says(self.navigation(), "docs/site/guides.md: a is not there")


class Links(Tree):
    def check(self, **pages):
        for name, body in pages.items():
            self.write(f"{name}.html", f"<html><body>{body}</body></html>")
        return run_tool("site.py", "check", self.root)

    def test_links_that_lead_somewhere(self):
        self.write("a.css", "x { background: url(data:image/png;base64,AA) }")
        self.assertEqual(self.check(index='<link href="a.css"><a href="b.html#x">b</a> <a href="https://example.org">e</a>',
                                    b='<p id="x"><a href="#x">x</a> <a href="index.html">i</a>'), (0, ""))

    def test_broken_links(self):
        self.assert_says(self.check(index='<a href="b.html#y">b</a><a href="c.html">c</a>', b=""),
                         "index.html: b.html#y has no such anchor", "index.html: c.html is not there")

    def test_what_is_loaded_from_elsewhere(self):
        self.write("a.css", "@font-face { src: url('https://example.org/a.woff') }")
        self.assert_says(self.check(index='<script src="//example.org/a.js"></script>'),
                         "index.html: loads //example.org/a.js", "a.css: loads https://example.org/a.woff")


class Header(unittest.TestCase):
    def test_a_function(self):
        made = site_cpp.function(ElementTree.fromstring(
            '<memberdef kind="function" id="namespacerastrum_1a" static="no"><type>const <ref>Mesh</ref> &amp;</type>'
            "<name>draw</name><argsstring>(int n=3)</argsstring></memberdef>"), "cpp", 5, "Draws *one*.", "draw")
        self.assertEqual(made, "`````{cpp:function} const Mesh & draw(int n=3)\n\nDraws *one*.\n`````\n\n")

    def test_comments_as_markdown(self):
        para = ElementTree.fromstring("<para>a_b of <computeroutput>x[i]</computeroutput>, 2 * 3 </para>")
        self.assertEqual(site_cpp.markdown(para), "a\\_b of `x[i]`, 2 \\* 3")
        self.assertEqual(site_cpp.remark_of("// Lines from\n// meshes.\n"), "## Lines from meshes\n\n")


if __name__ == "__main__":
    unittest.main()
