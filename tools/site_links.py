# SPDX-License-Identifier: BSD-3-Clause
"""Checks a built site: links lead to existing pages and anchors, and nothing loads from elsewhere."""
import html.parser
import re
import urllib.parse

# What a browser loads to show a page; a reader's links are not among it.
LOADS = {"script": "src", "img": "src", "link": "href", "source": "src", "iframe": "src", "video": "src"}
URL = re.compile(r"url\(\s*['\"]?([^'\")]+)")


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.anchors, self.links, self.loads = set(), set(), set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors.update(given[name] for name in ("id", "name") if given.get(name))
        if tag == "a" and given.get("href"):
            self.links.add(given["href"])
        relation = given.get("rel", "")
        if tag in LOADS and given.get(LOADS[tag]) and relation not in ("canonical", "author", "license"):
            self.loads.add(given[LOADS[tag]])


def violations(folder):
    """Yields what is wrong, a line each."""
    pages = {file: Page(file.read_text(encoding="utf-8")) for file in sorted(folder.rglob("*.html"))
             if "_static" not in file.parts}
    if folder / "index.html" not in pages:
        yield f"{folder}: there is no index.html"
    for file, page in pages.items():
        name = file.relative_to(folder)
        for load in sorted(page.loads):
            if is_elsewhere(load):
                yield f"{name}: loads {load}"
        for link in sorted(page.links | page.loads):
            if is_elsewhere(link):
                continue
            path, anchor = urllib.parse.urldefrag(link)
            path = urllib.parse.unquote(path.partition("?")[0])
            to = (file.parent / path).resolve() if path else file
            if to.is_dir():
                to = to / "index.html"
            if not to.is_relative_to(folder) or not to.exists():
                yield f"{name}: {link} is not there"
            elif anchor and to in pages and urllib.parse.unquote(anchor) not in pages[to].anchors:
                yield f"{name}: {link} has no such anchor"
    for file in sorted(folder.rglob("*.css")):
        for url in URL.findall(file.read_text(encoding="utf-8")):
            path = urllib.parse.unquote(re.split(r"[?#]", url)[0])
            if url.startswith("data:") or not path:
                continue
            if is_elsewhere(url):
                yield f"{file.relative_to(folder)}: loads {url}"
            elif not (file.parent / path).exists():
                yield f"{file.relative_to(folder)}: {url} is not there"


def is_elsewhere(link):
    return bool(re.match(r"[a-z][a-z+.-]*:|//", link)) and not link.startswith("data:")
