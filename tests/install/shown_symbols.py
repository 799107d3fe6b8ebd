# SPDX-License-Identifier: BSD-3-Clause
"""Checks that librastrum.so exports what the public headers declare: prints each other symbol, and each missing function of
rastrum.h, and fails if there is any. The linker finds missing C++ symbols.

A class must be defined in a header, because one that is only declared (`struct Impl;`) is internal. Functions are looked up
by name. This is enough, because only public headers declare functions with RASTRUM_API.

usage: shown_symbols.py LIBRARY SOURCE_DIR"""
import pathlib
import re
import subprocess
import sys


def entity(symbol):
    """Returns the qualified name in a demangled symbol, with template arguments, without return type and parameters."""
    symbol = re.sub(r"^(vtable|VTT|typeinfo|typeinfo name|guard variable|non-virtual thunk) (for|to) ", "", symbol)
    symbol = re.sub(r"::operator\W.*|\[abi:\w+\]", "", symbol)
    depth, start = 0, 0
    for at, letter in enumerate(symbol):
        depth += {"<": 1, ">": -1}.get(letter, 0)
        if depth == 0 and letter == " ":
            start = at + 1
        elif depth == 0 and letter == "(":
            return symbol[start:at]
    return symbol


def main():
    library, root = sys.argv[1], pathlib.Path(sys.argv[2])
    wrong = [f"{path} says RASTRUM_API, and is no public header" for path in (root / "rastrum").rglob("*.[hc]pp")
             if "include" not in path.parts and re.search(r"RASTRUM_API rastrum \{.*\n(?!class \w+;.*\n\})", path.read_text())]
    headers = "\n".join(path.read_text() for path in (root / "include").rglob("*.h*"))
    headers = re.sub(r"//.*", "", headers)
    words = set(re.findall(r"\w+", headers))
    scopes = set(re.findall(r"(?:class|struct|union) (?:\w+ )*?(\w+)(?:<[^;{}]*>)?(?: final)?(?: : [^;{}]*)? ?\{", headers))
    for names in re.findall(r"namespace (?:RASTRUM_API )?([\w:]+) \{", headers):
        scopes.update(names.split("::"))

    def is_declared(name):
        *around, last = re.sub(r"<.*", "", name).split("::")
        return last.lstrip("~") in words and scopes.issuperset(around) and ("~" in last or last not in forward)

    forward = set(re.findall(r"(?:class|struct) (?:\w+ )*?(\w+);", headers)) - scopes
    shown = subprocess.run(["nm", "-D", "--defined-only", "-C", library], check=True, capture_output=True, text=True).stdout
    wrong += [f"{name} is not shown" for name in re.findall(r"\b(rastrum_\w+)\(", headers) if f" {name}@" not in shown]
    for line in shown.splitlines():
        kind, symbol = line.split(" ", 2)[1:]
        name = entity(re.sub(r"@.*", "", symbol))
        ours = re.findall(r"rastrum\w*(?:::~?\w+)*", name)
        if kind != "A" and (not name.startswith("rastrum") or not all(map(is_declared, ours))):
            wrong.append(symbol)
    print("\n".join(wrong))
    sys.exit(bool(wrong))


main()
