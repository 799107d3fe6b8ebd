#!/usr/bin/env python3
"""Checks that a floor of rastrum/ includes only the floors that it may stand on.

usage: check_includes.py ROOT

The floors and why they lie so are in docs/architecture.md. Two rules: a file of rastrum/ includes
files of the project as <rastrum/...>, and only from the floors listed for its own.
Prints one line per violation; exits with 1 where there are any.
"""
import pathlib
import re
import sys

MAY_INCLUDE = {
    "core": set(),
    "parallel": {"core"},
    "scene": {"core", "parallel"},
    "raster": {"core", "parallel", "scene"},
    "transparency": {"core", "parallel", "scene", "raster"},
    "terrain": {"core", "parallel", "scene"},
    # Files in, images out: what draws them is none of its business, so a reader can be used alone.
    "io": {"core", "parallel", "scene"},
    # `family` until the rows leave the registry: then nothing of the renderer includes it.
    "render": {"core", "parallel", "scene", "raster", "transparency", "terrain", "io", "family"},
    "family": {"core", "parallel", "scene", "raster", "transparency", "terrain", "render"},
    # The library of device code, opened by its file's name: nothing includes it.
    "cuda": {"core", "parallel", "render", "terrain", "family"},
}
ENDINGS = {".hpp", ".cpp", ".h", ".inl", ".cu", ".cuh"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def violations_of_line(root, file, floor, line):
    """Yields what is wrong with one line of a file under rastrum/<floor>/."""
    match = INCLUDE.match(line)
    if not match:
        return
    quote, path = match.groups()
    if quote == '"':
        inside = any((base / path).is_file() for base in (file.parent, root))
        if path.startswith("rastrum/") or inside:
            yield f'"{path}" must be written <rastrum/...>'
        return
    if not path.startswith("rastrum/"):
        if (root / path).is_file():
            yield f"the library may not include <{path}>"
        return
    target = path.split("/")[1]
    if target != floor and target not in MAY_INCLUDE[floor]:
        yield f"{floor} may not include {target} (<{path}>)"


def violations(root):
    """Yields 'file:line: message' for the whole tree."""
    for file in sorted((root / "rastrum").rglob("*")):
        if file.suffix not in ENDINGS:
            continue
        relative = file.relative_to(root)
        floor = relative.parts[1]
        if floor not in MAY_INCLUDE:
            yield f"{relative}:1: '{floor}' is no floor of rastrum/ (tools/check_includes.py)"
            continue
        text = file.read_text(encoding="utf-8", errors="replace")
        for number, line in enumerate(text.splitlines(), 1):
            for message in violations_of_line(root, file, floor, line):
                yield f"{relative}:{number}: {message}"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    found = list(violations(pathlib.Path(sys.argv[1]).resolve()))
    for line in found:
        print(line)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
