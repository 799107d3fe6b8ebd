#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks two rules of plain words, in the pages and in the comments of C++ sources.

usage: check_words.py ROOT

No sentence begins with a bare "Of", "Who", "What" or "Those", unless it is a question. No line is longer than 160
characters, except rows of Markdown tables and lines that one link or one word fills. Code and headings are not
checked. The pages are *.md of the root, of docs/, docs/site/ and docs/decisions/, and the READMEs of papers/.
Prints one line per violation; exits with 1 if there are any.
"""
import re

import checks

LONGEST = 160
ONE_LINK = re.compile(r"!?\[[^\]]*\]\([^)]*\)$")
SOURCES = ("include", "rastrum", "papers", "apps", "bench", "examples", "fuzz", "python/src", "tests")
SUFFIXES = (".hpp", ".cpp", ".h", ".c", ".inl", ".cu", ".cuh")
HEADING = re.compile(r"^\*\*What (?:we do|else was possible|follows)\.\*\*(?: |$)")
BARE = re.compile(r"(?:^|(?<=[.!?:…])\s|(?<=[.!?][)*\"”])\s)[(*_\"“]*(Of|Who|What|Those)\b")
COMMENT = re.compile(r"^(?P<code>.*?)(?P<mark>///<|///|//)(?P<text>.*)$")


def page_blocks(lines):
    """Yields the prose of a page: a list of (line number, text) for each paragraph or cell."""
    block, in_code = [], False
    for number, line in enumerate(lines, 1):
        fence = line.lstrip().startswith("```")
        in_code ^= fence
        text = re.sub(r"`[^`]*`", "`code`", line).strip()
        starts = re.match(r"[-*+] |\d+\. |#|\||>|$", text)
        if fence or in_code or starts:
            yield block
            block = []
        if fence or in_code or text.startswith("#"):
            continue
        if text.startswith("|"):
            yield from ([(number, cell.strip())] for cell in text.split("|"))
        elif text:
            text = re.sub(r"^(?:[-*+] |\d+\. |> )", "", text)
            block.append((number, text if block else HEADING.sub("", text)))
    yield block


def comment_blocks(lines):
    """The same for the comments of a source."""
    block, last = [], None
    for number, line in enumerate(lines, 1):
        if "SPDX-License-Identifier" in line:
            continue
        match = COMMENT.match(line)
        mark = match["mark"] if match and not match["code"].strip() else None
        if mark is None or mark != last or not match["text"].strip():
            yield block
            block = []
        if match and match["text"].strip():
            block.append((number, match["text"].strip()))
        last = mark
    yield block


def violations(root):
    """Yields 'file:line: text' for the whole tree."""
    pages = [*sorted(root.glob("*.md")), *sorted((root / "docs").glob("*.md")), *sorted((root / "docs/site").glob("*.md")),
             *sorted((root / "docs/decisions").glob("*.md")), *sorted((root / "papers").glob("**/README.md"))]
    sources = (file for folder in SOURCES for file in sorted((root / folder).rglob("*")) if file.suffix in SUFFIXES)
    for file in [*pages, *sources]:
        lines = file.read_text(encoding="utf-8").splitlines()
        name = file.relative_to(root)
        for number, line in enumerate(lines, 1):
            if len(line) > LONGEST and not line.startswith("|") and not ONE_LINK.match(line) and " " in line[:LONGEST].strip():
                yield f"{name}:{number}: {len(line)} characters: {line[:60]}…"
        for block in (page_blocks if file.suffix == ".md" else comment_blocks)(lines):
            prose = " ".join(text for _, text in block)
            for match in BARE.finditer(prose):
                end = re.search(r"[.!?](?=\W*(?:\s|$))|$", prose[match.end():])
                if end.group() == "?":
                    continue
                at = match.start(1)
                for number, text in block:
                    if at <= len(text):
                        break
                    at -= len(text) + 1
                yield f"{name}:{number}: {prose[match.start(1):][:70]}"


if __name__ == "__main__":
    checks.main(__doc__, violations)
