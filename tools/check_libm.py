#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that no code that decides a pixel calls functions whose rounding depends on the libm.

usage: check_libm.py ROOT

Versions of a libm differ in the last bits of sines, powers and the like, and so would pictures.
rastrum/core/elementary.hpp has the same functions with the same bits everywhere (decision 0030). Functions that C and
IEEE define exactly are allowed: sqrt, fabs, floor, fmod, ldexp, nearbyint and so on.
Looks at include/, papers/, rastrum/ and apps/, but for the exceptions here; comments and strings do not count.
Prints one line per call; exits with 1 if there are any.
"""
import re

import checks

FUNCTIONS = """sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 expm1 log
log2 log10 log1p pow cbrt hypot fma erf erfc tgamma lgamma sincos rsqrt""".split()
# Folders or files, and why they may call them.
EXCEPTIONS = {
    "papers/models/": "what is predicted of other machines is no picture",
    "apps/rastrum/window/": "what a hand moves, or the clock, is another picture each time",
}
ENDINGS = {".hpp", ".cpp", ".h", ".inl", ".cu", ".cuh"}
NAMES = "|".join(FUNCTIONS)
# std::sin, called or named; sin(…) of the global namespace, unless it is a member or a definition.
CALL = re.compile(rf"\bstd::(?:{NAMES}|lerp)[fl]?\b"
                  rf"|(?<![\w.>:])(?:::\s*)?(?:{NAMES})[fl]?\s*\(")
DEFINITION = re.compile(r"\b(?:double|float|auto|void|F)\s*$")
HEADER = re.compile(r"^\s*#\s*include\s*<(math\.h|tgmath\.h)>")
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)


def calls(text):
    """Yields (line, what) for each call of a source."""
    code = NOT_CODE.sub(lambda m: "\n" * m.group().count("\n"), text)
    for number, line in enumerate(code.splitlines(), 1):
        if match := HEADER.match(line):
            yield number, f"<{match.group(1)}> (include <cmath>)"
        for match in CALL.finditer(line):
            if not DEFINITION.search(line[:match.start()]):
                yield number, match.group().rstrip("( ")


def violations(root):
    """Yields 'file:line: message' for the whole tree."""
    for folder in ("include", "papers", "rastrum", "apps"):
        for file in sorted((root / folder).rglob("*")):
            name = file.relative_to(root).as_posix()
            if file.suffix not in ENDINGS or any(name.startswith(e) for e in EXCEPTIONS):
                continue
            for number, what in calls(file.read_text(encoding="utf-8", errors="replace")):
                yield (f"{name}:{number}: {what} is rounded by each libm as it likes; take "
                       "rastrum/core/elementary.hpp's, or √ for lengths (tools/check_libm.py)")


if __name__ == "__main__":
    checks.main(__doc__, violations)
