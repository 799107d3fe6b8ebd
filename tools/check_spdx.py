#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that each source file begins with its licence, or adds the line.

usage: check_spdx.py ROOT
       check_spdx.py --add ROOT

The line is the comment "SPDX-License-Identifier: BSD-3-Clause", the first one, or the second after "#!". Sources are
C++, C, CUDA, Fortran, Python and Bash. CMake's files have none, because the digest of what nvcc compiles counts their
comments. Tables made of others' data (.inc) name their own licence.
Prints one line per violation; exits with 1 if there are any.
"""
import pathlib
import sys

import checks

FOLDERS = ("include", "rastrum", "papers", "apps", "bench", "examples", "fuzz", "python", "tests", "tools", "docs/site")
MARKS = {**dict.fromkeys((".hpp", ".cpp", ".h", ".c", ".inl", ".cu", ".cuh"), "//"), ".f90": "!",
         **dict.fromkeys((".py", ".pyi", ".sh"), "#")}
LINE = "SPDX-License-Identifier: BSD-3-Clause"


def sources(root):
    """Returns [(file, its licence line)]."""
    scripts = [root / "dev", root / ".ci" / "run"]
    found = [(file, MARKS[file.suffix]) for folder in FOLDERS for file in sorted((root / folder).rglob("*")) if file.suffix in MARKS]
    return [(file, f"{mark} {LINE}\n") for file, mark in [*found, *((file, "#") for file in scripts if file.is_file())]]


def parts(text):
    """Returns ("#!…" line or "", the rest)."""
    end = text.find("\n") + 1 if text.startswith("#!") else 0
    return text[:end], text[end:]


def violations(root):
    """Yields 'file:1: message' for the whole tree."""
    for file, line in sources(root):
        if not parts(file.read_text(encoding="utf-8"))[1].startswith(line):
            yield f"{file.relative_to(root)}:1: does not begin with '{line.strip()}'"


def add(root):
    for file, line in sources(root):
        script, rest = parts(file.read_text(encoding="utf-8"))
        if not rest.startswith(line):
            file.write_text(script + line + rest, encoding="utf-8")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--add"] and len(sys.argv) == 3:
        add(pathlib.Path(sys.argv[2]).resolve())
    else:
        checks.main(__doc__, violations)
