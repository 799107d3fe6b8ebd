#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Says whether the sources for nvcc have changed since they were last compiled.

usage: cuda_sources.py changed|record ROOT

All .cu files of the project and what they include, without comments, have one digest. `record` writes it into
tests/cuda/compiled.txt after nvcc has compiled them (`./dev cuda` does both). `changed` prints a line and exits with 1
if the digest differs. So CI compiles for devices, which takes minutes, only if a change needs it.
"""
import hashlib
import pathlib
import re
import sys

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]', re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*")
FOLDERS = ("rastrum", "papers", "bench", "tests")
BUILD = ("cmake/RastrumCuda.cmake", "rastrum/cuda/CMakeLists.txt")
NOT_NVCCS = ("rastrum/parallel/cuda/system_cpu.cuh",)  # the half of system.cuh that nvcc does not compile
RECORD = pathlib.Path("tests/cuda/compiled.txt")


def device_files(root):
    """All .cu files of the project."""
    return sorted(file for folder in FOLDERS for file in (root / folder).rglob("*.cu"))


def closure(root, files):
    """Returns the files and every file of the project that nvcc includes for them, directly or not."""
    waiting, found = list(files), set()
    left_out = {(root / file).resolve() for file in NOT_NVCCS}
    while waiting:
        file = waiting.pop().resolve()
        if file in found or file in left_out:
            continue
        found.add(file)
        for name in INCLUDE.findall(file.read_text(encoding="utf-8")):
            waiting += [p for p in (file.parent / name, root / name, root / "include" / name,
                                  root / "papers" / "include" / name) if p.is_file()]
    return sorted(found)


def digest(root, files):
    """Returns the hexadecimal SHA-256 of the files' names and texts, without comments."""
    total = hashlib.sha256()
    for file in files:
        text = COMMENT.sub("", file.read_text(encoding="utf-8"))
        lines = [line.strip() for line in text.splitlines() if line.strip()]
        total.update(f"{file.relative_to(root.resolve())}\n".encode())
        total.update("\n".join(lines).encode())
    return total.hexdigest()


def main(arguments):
    if len(arguments) != 2 or arguments[0] not in ("changed", "record"):
        print(__doc__.split("\n\n")[1], file=sys.stderr)
        return 2
    root = pathlib.Path(arguments[1])
    build = {(root / file).resolve() for file in BUILD}
    now = digest(root, sorted(build.union(closure(root, device_files(root)))))
    if arguments[0] == "record":
        (root / RECORD).write_text(now + "\n", encoding="utf-8")
        return 0
    known = (root / RECORD).read_text(encoding="utf-8").strip() if (root / RECORD).is_file() else ""
    if known == now:
        print("what nvcc compiles is what it last compiled")
        return 0
    print("what nvcc compiles has changed since it was last compiled (`./dev cuda` compiles it)")
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
