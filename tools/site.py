#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the sources of the site for Sphinx, and checks the built site; `./dev site` runs these in turn.

usage: site.py source FOLDER   the pages, a page for each public header, module and linked file
       site.py check FOLDER    a built site's links and anchors; nothing may load from elsewhere
       site.py navigation      each page and each public header has its place in docs/site/*.md

The pages stay in place in the repository. In the site, README.md is the first page with the pages of docs/ beside it,
and a folder's README.md is its index. docs/site/ arranges the pages. A link to another file leads to a page that shows
it, and a link to a public header to its interface page. `source` needs docs/site/requirements.txt and Doxygen's XML;
the others need only Python.
"""
import os
import pathlib
import re
import shutil
import sys

import docs
import site_cpp
import site_links

ROOT = docs.ROOT
SITE = "docs/site"
LEFT_OUT = {
    "docs/decisions/0000-template.md",
    "python/README.md",  # PyPI's page of the package, which repeats the guide
}
# Pages that list their folder, so that docs/site/ need not name its pages.
INSIDE = {"decisions/index": "[0-9]*", "log/index": "*", "papers/index": "*/index"}
# Pages that show a live picture above their second heading, if `./dev release wasm` has made the package, and what it shows.
PACKAGE = "build/packages/wasm/package"
LIVE = {"docs/browser.md": "shape=teapot", "docs/gallery.md": "shape=torus_knot&shader=normal"}
FRAME = """```{{raw}} html
<iframe src="live/index.html?{}" title="Rastrum in this browser" style="width: 100%; height: 62rem; border: 0"></iframe>
```

"""
TOCTREE = re.compile(r"^```\{toctree\}\n(.*?)^```", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"^(```+).*?^\1|`[^`\n]+`", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)#\s]*)(#[^)\s]*)?([^)]*)\)")
LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".c": "c", ".h": "c", ".f90": "fortran", ".py": "python", ".sh": "sh",
             ".cff": "yaml", ".yml": "yaml", ".txt": "text", ".cmake": "cmake"}


def docname(path):
    """Returns the name in the site, without ending, of a page with this path in the repository."""
    if path == "README.md":
        return "index"
    if path.startswith(f"{SITE}/"):
        return f"{pathlib.PurePath(path).stem}/index"
    name = path.removeprefix("docs/").removesuffix(".md")
    return re.sub(r"README$", "index", name)


def pages():
    """Returns {path in the repository: name in the site}."""
    return {path: docname(path) for path in docs.all_pages() if not path.startswith(SITE) and path not in LEFT_OUT}


def arranging_pages():
    """The same for docs/site/*.md, which are only in the site. A folder's README.md takes precedence over them."""
    paths = [file.relative_to(ROOT).as_posix() for file in sorted((ROOT / SITE).glob("*.md")) if file.name != "index.md"]
    return {path: name for path in paths if (name := docname(path)) not in pages().values()}


def header_name(path):
    """Returns the name in the site of a public header's page."""
    return "cpp_api/" + pathlib.PurePath(path).name.removesuffix(".hpp").replace(".", "_")


def headers():
    """Returns {path: name in the site} of the public headers."""
    files = [ROOT / "include" / "rastrum.h", *sorted((ROOT / "include" / "rastrum").glob("*.hpp"))]
    return {file.relative_to(ROOT).as_posix(): header_name(file.name) for file in files}


class Source:
    """The folder that Sphinx reads."""

    def __init__(self, folder):
        self.folder = folder
        self.names = {**pages(), **arranging_pages(), **headers(), "docs/decisions": "decisions/index"}
        self.files = set()  # linked files that are not pages

    def write(self, name, text):
        file = self.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def target(self, path):
        """Returns where a link to this path of the repository leads, from the top of the site."""
        if path in self.names:
            return f"/{self.names[path]}.md"
        if path.endswith((".png", ".svg", ".jpg", ".ipynb")):
            name = path.removeprefix("docs/")
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / path, self.folder / name)
            return f"/{name}"
        self.files.add(path)
        return f"/files/{path}.md"

    def linked(self, page, text):
        """Returns the text with its links turned into the site's."""
        def turned(match):
            to, anchor, rest = match.groups()
            if not to or "://" in to or to.startswith("mailto:"):
                return match.group()
            path = os.path.normpath(ROOT / page / ".." / to)
            return f"]({self.target(os.path.relpath(path, ROOT))}{anchor or ''}{rest})"

        # Code has no links, whatever it looks like.
        hidden = CODE.sub(lambda code: code.group().replace("](", "\0"), text)
        return LINK.sub(turned, hidden).replace("\0", "](")

    def write_pages(self):
        for path, name in {**pages(), **arranging_pages()}.items():
            text = self.linked(path, (ROOT / path).read_text(encoding="utf-8"))
            if path == "README.md":
                text += "\n" + (ROOT / SITE / "index.md").read_text(encoding="utf-8")
            if path in LIVE and (ROOT / PACKAGE).is_dir():
                text = text.replace("\n## ", "\n" + FRAME.format(LIVE[path]) + "## ", 1)
            if inside := INSIDE.get(name):
                text += f"\n```{{toctree}}\n:maxdepth: 1\n:glob:\n\n{inside}\n```\n"
            self.write(f"{name}.md", text)

    def write_headers(self, interface):
        for path, name in headers().items():
            text = (ROOT / path).read_text(encoding="utf-8")
            shown = path.removeprefix("include/")
            about = f"{introduction(text)}\n\n```cpp\n#include <{shown}>\n```\n\n{interface.page(path, text)}"
            self.write(f"{name}.md", f"# {shown}\n\n{with_pages_linked(about)}")

    def write_files(self):
        """Writes pages of linked files, and of linked folders with all their files."""
        waiting, seen = list(self.files), set()
        while waiting:
            path = waiting.pop()
            if path in seen:
                continue
            seen.add(path)
            at = ROOT / path
            head = f"---\norphan: true\nnosearch: true\n---\n# {path}\n\n"
            if at.is_dir():
                inside = sorted(file.relative_to(ROOT).as_posix() for file in at.rglob("*")
                                if file.is_file() and file.suffix in LANGUAGES)
                waiting += inside
                self.write(f"files/{path}.md", head + "".join(f"- [{file}](/files/{file}.md)\n" for file in inside))
            else:
                text = at.read_text(encoding="utf-8")
                self.write(f"files/{path}.md", f"{head}`````{LANGUAGES.get(at.suffix, 'text')}\n{text.rstrip()}\n`````\n")


def introduction(text):
    """Returns the comment at the top of a header, without marks. A line of one word and a full stop begins a paragraph."""
    comment = re.match(r"(?:// SPDX-.*\n)?((?://.*\n)*)", text).group(1)
    return re.sub(r"^(\w+\.) ", r"\n**\1** ", re.sub(r"^// ?", "", comment, flags=re.MULTILINE), flags=re.MULTILINE)


def with_pages_linked(text):
    """Returns the text with links for the pages that it names, as comments do."""
    known = pages()
    return re.sub(r"\bdocs/[\w/\\]+\.md\b", lambda named: f"[{named.group()}](/{known[path]}.md)" if (
        path := named.group().replace("\\", "")) in known else named.group(), text)


def navigation():
    """Yields what lacks a place in docs/site/*.md, and places whose page is missing."""
    named = set()
    for path, name in {**arranging_pages(), f"{SITE}/index.md": "index"}.items():
        for block in TOCTREE.findall((ROOT / path).read_text(encoding="utf-8")):
            for line in block.splitlines():
                if line and not line.startswith(":"):
                    entry = re.sub(r".* <(.*)>$", r"\1", line)
                    named.add((path, os.path.normpath(pathlib.PurePath(name).parent / entry)))
    entries = {entry for _, entry in named}
    inside = ("decisions/", "log/", "papers/")
    for path, name in {**pages(), **headers()}.items():
        if name != "index" and name not in entries and not name.startswith(inside):
            yield f"{path}: no page of {SITE}/ names it: a line {name!r} where it belongs"
    there = {*pages().values(), *headers().values(), *arranging_pages().values()}
    for path, entry in sorted(named):
        if "*" not in entry and entry not in there and not entry.startswith("python_api/"):
            yield f"{path}: {entry} is not there"


def make(folder):
    import site_python  # needs griffe
    source = Source(folder)
    source.write_pages()
    source.write_headers(site_cpp.Interface(folder.parent / "doxygen" / "xml"))
    for name, text in site_python.pages(ROOT / "python").items():
        source.write(f"python_api/{name}.md", with_pages_linked(text))
    source.write_files()


def main(arguments):
    if arguments[:1] == ["source"] and len(arguments) == 2:
        make(pathlib.Path(arguments[1]).resolve())
        return 0
    if arguments[:1] == ["check"] and len(arguments) == 2:
        wrong = list(site_links.violations(pathlib.Path(arguments[1]).resolve()))
    elif arguments == ["navigation"]:
        wrong = list(navigation())
    else:
        print(__doc__, file=sys.stderr)
        return 2
    for line in wrong:
        print(line, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
