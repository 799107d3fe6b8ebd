#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks two rules of plain words, in pages, in comments, and in the strings that programs say.

usage: check_words.py ROOT

No sentence begins with a bare "Of", "Who", "What" or "Those", unless it is a question. No line is longer than 160
characters, except rows of Markdown tables and lines that one link or one word fills. Code and headings are not
checked. The pages are *.md of the root, of docs/, docs/site/ and docs/decisions/, and the READMEs of papers/. The
comments are those of C++ sources. The strings are those of the library, the programs, the papers and the Python
package, its docstrings among them.
Prints one line per violation; exits with 1 if there are any.
"""
import ast
import re

import checks

LONGEST = 160
ONE_LINK = re.compile(r"!?\[[^\]]*\]\([^)]*\)$")
SOURCES = ("include", "rastrum", "papers", "apps", "bench", "examples", "fuzz", "python/src", "tests")
SPEAKING = ("include", "rastrum", "papers", "apps", "python/src")  # sources whose strings people read
SUFFIXES = (".hpp", ".cpp", ".h", ".c", ".inl", ".cu", ".cuh")
HEADING = re.compile(r"^\*\*What (?:we do|else was possible|follows)\.\*\*(?: |$)")
BARE = re.compile(r"(?:^|(?<=[.!?:…])\s|(?<=[.!?][)*\"”])\s)[(*_\"“]*(Of|Who|What|Those)\b")
COMMENT = re.compile(r"^(?P<code>.*?)(?P<mark>///<|///|//)(?P<text>.*)$")
# Comments and characters are matched so that quotes inside of them begin no string.
STRING = re.compile(r"""//[^\n]*|(?<!\w)'(?:[^'\\\n]|\\.)*'|R"(?P<end>\w*)\((?P<raw>.*?)\)(?P=end)"|"(?P<text>(?:[^"\\\n]|\\.)*)\"""", re.DOTALL)


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


def string_blocks(lines):
    """The same for the string literals of a source. Literals side by side are one text; a new line in it begins a block."""
    source, block, end = "\n".join(lines), [], 0
    for match in STRING.finditer(source):
        said = match["text"] if match["raw"] is None else match["raw"]
        if said is None:
            continue
        if source[end:match.start()].strip():
            yield block
            block = []
        end = match.end()
        number = source.count("\n", 0, match.start()) + 1
        for i, part in enumerate(re.split(r"\\n|\n", said)):
            if i > 0:
                yield block
                block = []
            block.append((number, part.strip()))
    yield block


def python_blocks(lines):
    """The same for the strings of a Python source: a block for each paragraph."""
    for node in ast.walk(ast.parse("\n".join(lines))):
        if not isinstance(node, ast.Constant) or not isinstance(node.value, str):
            continue
        block = []
        for number, line in enumerate(node.value.splitlines(), node.lineno):
            if line.strip():
                block.append((number, line.strip()))
            else:
                yield block
                block = []
        yield block


def blocks_of(file, name, lines):
    """All prose of a file, as blocks."""
    if file.suffix == ".md":
        yield from page_blocks(lines)
    elif file.suffix == ".py":
        yield from python_blocks(lines)
    else:
        yield from comment_blocks(lines)
        if any(name.is_relative_to(folder) for folder in SPEAKING):
            yield from string_blocks(lines)


def violations(root):
    """Yields 'file:line: text' for the whole tree."""
    pages = [*sorted(root.glob("*.md")), *sorted((root / "docs").glob("*.md")), *sorted((root / "docs/site").glob("*.md")),
             *sorted((root / "docs/decisions").glob("*.md")), *sorted((root / "papers").glob("**/README.md"))]
    sources = (file for folder in SOURCES for file in sorted((root / folder).rglob("*")) if file.suffix in SUFFIXES)
    for file in [*pages, *sources, *sorted((root / "python/rastrum").rglob("*.py"))]:
        lines = file.read_text(encoding="utf-8").splitlines()
        name = file.relative_to(root)
        for number, line in enumerate(lines, 1):
            if len(line) > LONGEST and not line.startswith("|") and not ONE_LINK.match(line) and " " in line[:LONGEST].strip():
                yield f"{name}:{number}: {len(line)} characters: {line[:60]}…"
        for block in blocks_of(file, name, lines):
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
