# SPDX-License-Identifier: BSD-3-Clause
# Sphinx's settings for the site, which `./dev site` builds (tools/site.py).
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
_version = (ROOT / "include" / "rastrum" / "version.hpp").read_text(encoding="utf-8")

project = "Rastrum"
author = "The Rastrum authors"
copyright = author
version = release = ".".join(re.findall(r"define RASTRUM_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", _version))

extensions = ["myst_parser"]
root_doc = "index"
myst_heading_anchors = 6  # the anchors that GitHub gives to headings, which the pages' links name
suppress_warnings = [
    "myst.header",  # some pages skip a level
    "misc.highlighting_failure",  # some code leaves things out
]
highlight_language = "text"
python_maximum_signature_line_length = 80
cpp_maximum_signature_line_length = 80
c_maximum_signature_line_length = 80
smartquotes = False  # options begin with two hyphens
add_module_names = False
toc_object_entries_show_parents = "hide"

html_theme = "pydata_sphinx_theme"
html_title = "Rastrum"
html_static_path = ["_static"]
html_css_files = ["rastrum.css"]
html_search_scorer = str(ROOT / "docs" / "site" / "scorer.js")
html_copy_source = False
html_show_sourcelink = False
html_sidebars = {"index": [], "gallery": []}  # which have no pages beside them
html_theme_options = {
    "header_links_before_dropdown": 6,
    "navigation_depth": 2,
    "show_toc_level": 1,
    "navbar_align": "left",
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
}
